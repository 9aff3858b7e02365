//! Cascades: number, splits, selection, blending.

use super::{Greys, count, cube_view, different, greys, greys_with, pillar_view, pillars, plan, wrong};
use crate::stage::{camera, cube_on_floor, gpu, light, sun, sun_direction};
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Light, LightKind, Scene};
use shadowgraph::shadows::{
    CascadeBlend, CascadeFitting, CascadeSelection, CullSettings, EVSM, LightRef, LightShadows, MAP_ATLAS,
    MAP_CASCADES, PCF, PCSS, RAYTRACED, SDSM, ShadowSettings, SplitScheme,
};
use shadowgraph::{Gpu, RenderedImage, Renderer, ViewOptions};

fn pillars_in_sun() -> Scene {
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    scene
}

#[test]
fn row_12_none_one_two_three_and_four_cascades() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    let wrong = [0, 1, 2, 3, 4, 8].map(|number| {
        let options = pillar_view(|settings| {
            settings.cascades.count = number;
            settings.cascades.map_size_px = 512;
            settings.atlas.map_size_px = 256;
        });
        let planned = plan(&scene, &options);
        let map = if number == 0 { MAP_ATLAS } else { MAP_CASCADES };
        assert_eq!((planned.lights[0].map, planned.lights[0].view_count), (map, number.max(1)));
        wrong(gpu, &scene, 0, &options)
    });
    // More cascades are closer to the reference; zero means one tile of the smaller atlas.
    assert!(wrong[4] * 3 < wrong[1] && wrong[1] < wrong[0], "{wrong:?}");
}

#[test]
fn row_12_points_outside_all_cascade_spheres_are_lit() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    // The slices end at 12 m: surfaces beyond the last sphere have no shadow, though the shadow distance is 60 m.
    let dark = |select| {
        let options = pillar_view(|settings| {
            settings.cascades.select = select;
            settings.distance_m = 14.0;
        });
        let planned = plan(&scene, &options);
        let nothing = planned.views.get(4).map(|view| view.map_from_world == glam::Mat4::ZERO);
        let greys = greys(gpu, &scene, 0, &options);
        (
            nothing,
            count(&greys[..greys.len() / 3].to_vec(), |grey| grey < 255),
            count(&greys, |grey| grey == 0),
        )
    };
    for select in [CascadeSelection::Sphere, CascadeSelection::Depth] {
        let (nothing, far, all) = dark(select);
        assert_eq!((nothing, far), (Some(true), 0), "{select:?}");
        assert!(all > 1000);
    }
    assert_eq!(dark(CascadeSelection::Map).0, None, "the edges of the map are its limit");
}

/// Counts the colours of cascades that more than `pixels` pixels of an image have.
pub(super) fn colours(gpu: &Gpu, scene: Scene, options: &ViewOptions, pixels: usize) -> usize {
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Cascade).unwrap();
    let image: RenderedImage = renderer.draw(gpu, options).unwrap().image;
    // Colours are shaded: they differ in the strongest channel and in the ratios of the others.
    let hue = |rgba: &[u8]| {
        let most = f32::from(*rgba[..3].iter().max().unwrap());
        [0, 1, 2].map(|i| (f32::from(rgba[i]) / most * 8.0).round() as u8)
    };
    let mut hues = std::collections::BTreeMap::<_, usize>::new();
    for rgba in image.rgba8.chunks_exact(4).filter(|rgba| rgba[3] == 255) {
        *hues.entry(hue(rgba)).or_default() += 1;
    }
    // White has no cascade; a few pixels of other colours are where shadows fade.
    hues.remove(&[8, 8, 8]);
    hues.values().filter(|found| **found > pixels).count()
}

#[test]
fn row_13_cascades_are_shown_in_colour() {
    let Some(gpu) = gpu() else { return };
    let [two, four] = [2, 4].map(|cascades| {
        let options = pillar_view(|settings| {
            settings.cascades.count = cascades;
            settings.fade_fraction = 0.001;
        });
        colours(gpu, pillars_in_sun(), &options, 100)
    });
    assert_eq!((two, four), (2, 4));
}

fn suns(number: u32) -> Vec<Light> {
    (0..number)
        .map(|i| {
            let direction = sun_direction(45.0, 70.0 + 90.0 * f64::from(i));
            light(LightKind::Directional { direction }, 4000.0 - i as f32)
        })
        .collect()
}

#[test]
fn row_13_the_cascades_of_the_most_important_light_are_shown() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars_in_sun();
    // Brighter, but vertical.
    scene.insert_light(Light { intensity: 50_000.0, ..sun(DVec3::NEG_Y) });
    let camera = pillar_view(|_| ()).camera;
    let mut renderer = Renderer::new(gpu, scene, &camera, Aov::Cascade).unwrap();
    let mut cascades = |own: Vec<LightShadows>| {
        let options = pillar_view(|settings| settings.lights = own);
        renderer.draw(gpu, &options).unwrap().image.rgba8
    };
    let of = |light| LightShadows::new(LightRef::Index(light));
    let brightest = cascades(Vec::new());
    assert!(cascades(vec![LightShadows { importance: 100.0, ..of(1) }]) == brightest);
    let first = cascades(vec![LightShadows { importance: 100.0, ..of(0) }]);
    assert!(first != brightest);
    let only = cascades(vec![LightShadows { casts: false, ..of(1) }]);
    let differ = first.chunks_exact(4).zip(only.chunks_exact(4)).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "the first light is shown either way");
}

#[test]
fn row_16_four_directional_lights_share_sixteen_tiles() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.set_lights(suns(5));
    let with = |lights| cube_view(|settings| settings.cascades.lights = lights);
    let (one, four) = (plan(&scene, &with(1)), plan(&scene, &with(4)));
    let tiles = |plan: &shadowgraph::shadows::ShadowPlan| {
        (plan.cascades.as_ref().unwrap().tiles.len(), plan.atlas.as_ref().unwrap().tiles.len())
    };
    assert_eq!((tiles(&one), tiles(&four)), ((4, 4), (16, 1)));
    for light in 0..5 {
        let wrong = wrong(gpu, &scene, light, &with(4));
        assert!(wrong < 300, "light {light}: {wrong}");
    }
}

#[test]
fn row_18_the_last_cascade_fades_at_its_edge() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    for select in [CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth] {
        let shadows = |edge_fade| {
            let options = pillar_view(|settings| {
                settings.cascades.select = select;
                settings.cascades.edge_fade = edge_fade;
                settings.cascades.split = SplitScheme::Metres(vec![6.0, 8.0]);
                settings.cascades.count = 3;
                settings.distance_m = 25.0;
                settings.fade_fraction = 0.001;
            });
            greys(gpu, &scene, 0, &options)
        };
        let (cut, faded) = (shadows(0.0), shadows(0.8));
        let lighter = cut.iter().zip(&faded).filter(|(a, b)| b > a).count();
        // Variants of the shader round differently.
        let differ = |(a, b): (&Option<u8>, &Option<u8>)| a.unwrap_or(0).abs_diff(b.unwrap_or(0)) > 1;
        let darker = cut.iter().zip(&faded).filter(|&(a, b)| b < a && differ((a, b))).count();
        assert!(lighter > 50 && darker == 0, "{select:?}: {lighter} {darker}");
        // Near the camera nothing changes.
        let near = cut.len() * 3 / 4;
        assert!(!cut[near..].iter().zip(&faded[near..]).any(differ));
    }
}

#[test]
fn row_54_the_edge_of_the_last_cascade_shows_only_from_another_camera() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(24);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let inside = pillar_view(|_| ()).camera;
    // Sees what is beyond the distance at which the other camera's shadows end.
    let beyond = camera(DVec3::new(0.3, 3.5, -17.0), DVec3::new(0.0, 0.5, -28.0));
    let image = |camera: &Camera, edge_fade: f32| {
        let mut options = ViewOptions { camera: camera.clone(), ..pillar_view(|_| ()) };
        options.shadows.cascades.edge_fade = edge_fade;
        options.shadows.distance_m = 14.0;
        options.shadows.cull = CullSettings { unseen: false, covered: false };
        let mut renderer = Renderer::new(gpu, scene.clone(), camera, Aov::Visibility(0)).unwrap();
        renderer.set_shadow_camera(Some(inside.clone()));
        renderer.draw(gpu, &options).unwrap().image.rgba8
    };
    let changed = |camera| {
        let images = [0.0, 0.1].map(|edge_fade| image(camera, edge_fade));
        images[0].chunks_exact(4).zip(images[1].chunks_exact(4)).filter(|(cut, faded)| cut != faded).count()
    };
    let (own, other) = (changed(&inside), changed(&beyond));
    assert!(own == 0 && other > 100, "{own} pixels of the cascades' camera, {other} of the other");
}

/// Returns settings in which the border of two cascades is clearly visible: cascades of very
/// different texel sizes.
fn blend_settings(blend: CascadeBlend, select: CascadeSelection) -> impl FnOnce(&mut ShadowSettings) {
    move |settings| {
        settings.cascades.count = 2;
        settings.cascades.split = SplitScheme::Metres(vec![14.0]);
        settings.cascades.map_size_px = 1024;
        settings.cascades.select = select;
        settings.cascades.blend = blend;
    }
}

#[test]
fn row_22_cascades_blend_hard_softly_or_by_dithering() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    for select in [CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth] {
        let draw = |blend| -> Greys { greys(gpu, &scene, 0, &pillar_view(blend_settings(blend, select))) };
        let hard = draw(CascadeBlend::Hard);
        let soft = draw(CascadeBlend::Soft(0.4));
        let dithered = draw(CascadeBlend::Dither(0.4));
        // Blending changes pixels where cascades meet, and dithering selects one of the two.
        let (mixed, taken) = (different(&hard, &soft, 4), different(&soft, &dithered, 4));
        assert!(mixed > 20 && taken > 20, "{select:?}: {mixed} {taken}");
        // Their means are equal.
        let mean =
            |greys: &Greys| greys.iter().flatten().map(|g| f64::from(*g)).sum::<f64>() / greys.len() as f64;
        assert!(
            (mean(&soft) - mean(&dithered)).abs() < 0.3,
            "{select:?}: {} {}",
            mean(&soft),
            mean(&dithered)
        );
    }
}

#[test]
fn row_26_a_fixed_factor_and_eight_slices() {
    let scene = pillars_in_sun();
    let options = pillar_view(|settings| {
        settings.distance_m = 60.0;
        settings.cascades.split = SplitScheme::Factor(3.0);
    });
    let planned = plan(&scene, &options);
    let ends: Vec<f32> = planned.views.iter().map(|view| view.end_m).collect();
    assert!(ends.windows(2).all(|pair| (pair[1] / pair[0] - 3.0).abs() < 1e-3), "{ends:?}");
    let eight = plan(&scene, &pillar_view(|settings| settings.cascades.count = 8));
    assert_eq!(eight.views.len(), 8);
    assert_eq!(eight.cascades.unwrap().tiles[0].rect.width, 4096 / 3);
    let mut nine = ShadowSettings::default();
    nine.cascades.count = 9;
    assert!(nine.validate().is_err());
}

#[test]
fn row_27_a_tight_fit_has_finer_texels_that_change_as_the_camera_turns() {
    let scene = pillars_in_sun();
    let texels = |fit, turn: f64| {
        let mut options = pillar_view(|settings| settings.cascades.fit = fit);
        let eye = DVec3::new(0.3, 2.5, 5.0);
        options.camera = crate::stage::camera(eye, eye + DVec3::new(turn, -0.1, -1.0));
        plan(&scene, &options).views.iter().map(|view| view.texel_world).collect::<Vec<_>>()
    };
    let (stable, tight) = (texels(CascadeFitting::Stable, 0.0), texels(CascadeFitting::Tight, 0.0));
    assert!(stable.iter().zip(&tight).all(|(stable, tight)| tight < stable), "{stable:?} {tight:?}");
    assert_eq!(stable, texels(CascadeFitting::Stable, 0.7));
    assert_ne!(tight, texels(CascadeFitting::Tight, 0.7));
    let Some(gpu) = gpu() else { return };
    let wrong = [CascadeFitting::Stable, CascadeFitting::Tight]
        .map(|fit| wrong(gpu, &scene, 0, &pillar_view(|settings| settings.cascades.fit = fit)));
    assert!(wrong[1] < 250, "{wrong:?}");
}

#[test]
fn row_47_a_tight_fit_is_as_wide_and_as_high_as_the_view() {
    let scene = pillars_in_sun();
    let options = |fit| {
        pillar_view(|settings| {
            settings.cascades.fit = fit;
            settings.cascades.map_size_px = 512;
        })
    };
    let area = |fit| {
        let views = plan(&scene, &options(fit)).views;
        views
            .iter()
            .map(|view| view.texel_world.powi(2) * view.texel_scale.element_product())
            .collect::<Vec<_>>()
    };
    let (stable, tight) = (area(CascadeFitting::Stable), area(CascadeFitting::Tight));
    assert!(stable.iter().zip(&tight).all(|(stable, tight)| 2.0 * tight < *stable), "{stable:?} {tight:?}");
    let views = plan(&scene, &options(CascadeFitting::Tight)).views;
    assert!(views.iter().all(|view| view.texel_scale.max_element() == 1.0));
    assert!(views.iter().all(|view| view.texel_scale.min_element() < 0.8));
    let Some(gpu) = gpu() else { return };
    for technique in [PCF, PCSS, EVSM, SDSM] {
        let wrong = [CascadeFitting::Stable, CascadeFitting::Tight].map(|fit| {
            let truth = greys_with(gpu, &scene, 0, &options(fit), RAYTRACED);
            different(&greys_with(gpu, &scene, 0, &options(fit), technique), &truth, 127)
        });
        let [stable, tight] = wrong;
        assert!(tight < 150 && tight <= stable, "{technique:?} {wrong:?}");
    }
}

#[test]
fn row_27_slices_overlap() {
    let scene = pillars_in_sun();
    let radius = |overlap| {
        let options = pillar_view(|settings| {
            settings.cascades.overlap = overlap;
            settings.cascades.fit = CascadeFitting::Tight;
        });
        plan(&scene, &options).views.iter().map(|view| view.radius).collect::<Vec<_>>()
    };
    let (apart, overlapping) = (radius(0.0), radius(0.5));
    assert_eq!(apart[0], overlapping[0]);
    // The last one covers the whole view.
    assert!(apart[1..3].iter().zip(&overlapping[1..3]).all(|(a, b)| a < b), "{apart:?} {overlapping:?}");
}

#[test]
fn row_28_slices_move_from_frame_to_frame() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    let first = pillar_view(|_| ());
    let mut renderer = Renderer::new(gpu, scene, &first.camera, Aov::Cascade).unwrap();
    let mut seen = Vec::new();
    for ends in [vec![6.0, 12.0, 30.0], vec![10.0, 20.0, 40.0], vec![6.0, 12.0, 30.0]] {
        let options = pillar_view(|settings| settings.cascades.split = SplitScheme::Metres(ends));
        seen.push(renderer.draw(gpu, &options).unwrap().image.rgba8);
    }
    assert!(seen[0] != seen[1] && seen[0] == seen[2]);
}

#[test]
fn row_30_selection_by_depth_and_by_sphere_are_as_right_as_by_map() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    let wrong = [CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth]
        .map(|select| wrong(gpu, &scene, 0, &pillar_view(|settings| settings.cascades.select = select)));
    assert!(wrong.iter().all(|wrong| *wrong < 400), "{wrong:?}");
}

#[test]
fn row_55_selection_without_branches_gives_the_same_image() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    for count in [1, 4, 8] {
        let [loops, branch_free] = [false, true].map(|branch_free| {
            let options = pillar_view(|settings| {
                settings.cascades.count = count;
                settings.cascades.select = CascadeSelection::Depth;
                settings.cascades.branch_free = branch_free;
            });
            assert_eq!(plan(&scene, &options).lights[0].branch_free, u32::from(branch_free));
            greys(gpu, &scene, 0, &options)
        });
        assert!(loops == branch_free, "{count} cascades");
    }
}
