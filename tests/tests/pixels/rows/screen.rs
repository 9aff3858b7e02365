//! Screen-space shadows.

use super::{Greys, count, cube_view, different, greys, pillar_view, pillars};
use crate::stage::{SIZE_PX, cube_on_floor, draw_with, gpu, nth_mesh, sun, sun_direction, view};
use glam::DVec3;
use shadowgraph::Pipeline;
use shadowgraph::core::{Contents, Format, Frame, TextureDesc};
use shadowgraph::options::Aov;
use shadowgraph::scene::{AlphaMode, Scene};
use shadowgraph::shadows::{
    CascadeSelection, Pcf, RAYTRACED, RaytracedSettings, ScreenSettings, ScreenShadows, ShadowFilter,
    ShadowInputs, ShadowTechnique, SurfaceBuffers, Technique, add_shadows,
};
use shadowgraph::{Gpu, RenderedImage, Renderer, ViewOptions, wgpu};
use shadowgraph_samples::test_scenes::stained_glass;

fn render(gpu: &Gpu, scene: &Scene, aov: Aov, options: &ViewOptions, pipeline: Pipeline) -> RenderedImage {
    draw_with(gpu, scene, aov, options, pipeline).image
}

fn screen_greys(gpu: &Gpu, scene: &Scene, light: u32, options: &ViewOptions) -> Greys {
    let image = render(gpu, scene, Aov::Visibility(light), options, Pipeline::screen_shadows());
    image.rgba8.chunks_exact(4).map(|rgba| (rgba[3] == 255).then_some(rgba[0])).collect()
}

fn pillars_in_sun() -> Scene {
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    scene.insert_light(super::spot(DVec3::new(0.0, 4.0, -2.0), DVec3::new(0.5, 0.0, -6.0), 0.7));
    scene
}

#[test]
fn row_15_three_pipelines_render_the_same_image() {
    let Some(gpu) = gpu() else { return };
    let (scene, options) = (pillars_in_sun(), pillar_view(|_| ()));
    let [forward, screen, minimal] =
        [Pipeline::minimal_lit(), Pipeline::screen_shadows(), Pipeline::minimal()]
            .map(|pipeline| render(gpu, &scene, Aov::Color, &options, pipeline).rgba8);
    let differ = |a: &[u8], b: &[u8]| a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 3).count();
    let pixels = (SIZE_PX[0] * SIZE_PX[1]) as usize;
    assert_eq!(differ(&forward, &minimal), 0);
    assert!(differ(&forward, &screen) < pixels / 500, "{}", differ(&forward, &screen));
}

#[test]
fn row_29_screen_space_shadows_match_per_pixel_shadows() {
    let Some(gpu) = gpu() else { return };
    let (scene, options) = (pillars_in_sun(), pillar_view(|_| ()));
    for light in 0..2 {
        let (per_pixel, screen_space) =
            (greys(gpu, &scene, light, &options), screen_greys(gpu, &scene, light, &options));
        let differ = different(&per_pixel, &screen_space, 8);
        assert!(differ < per_pixel.len() / 1000, "light {light}: {differ}");
        assert!(count(&screen_space, |grey| grey < 255) > 20, "light {light}");
    }
}

#[test]
fn row_34_screen_space_shadows_are_those_of_each_pixel() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    let options = pillar_view(|settings| settings.cascades.select = CascadeSelection::Depth);
    let (per_pixel, screen_space) = (greys(gpu, &scene, 0, &options), screen_greys(gpu, &scene, 0, &options));
    assert!(different(&per_pixel, &screen_space, 8) < per_pixel.len() / 1000);
    let other = screen_greys(gpu, &scene, 0, &pillar_view(|_| ()));
    assert!(different(&other, &screen_space, 8) > 0, "another cascade is read somewhere");
}

#[test]
fn row_35_blur_widens_nearby_edges_and_stops_at_other_surfaces() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(sun_direction(40.0, 130.0)));
    let draw = |blur_m, plane_threshold| {
        let options = cube_view(|settings| {
            settings.cascades.filter = ShadowFilter::Tent2;
            let own = ScreenSettings { blur_m, plane_threshold, ..ScreenSettings::default() };
            settings.techniques.set(&own).unwrap();
        });
        screen_greys(gpu, &scene, 0, &options)
    };
    let between = |greys: &Greys| count(greys, |grey| (3..253).contains(&grey));
    let (sharp, blurred) = (draw(0.0, 0.01), draw(0.15, 0.01));
    assert!(between(&blurred) > 3 * between(&sharp), "{} {}", between(&sharp), between(&blurred));
    // Without the threshold, the dark floor behind the cube's lit edges bleeds into them.
    let careless = draw(0.15, 1.0);
    let lit = sharp.iter().map(|grey| *grey == Some(255)).collect::<Vec<_>>();
    let darkened = |greys: &Greys| {
        greys.iter().zip(&lit).filter(|(grey, lit)| **lit && grey.is_some_and(|grey| grey < 230)).count()
    };
    assert!(darkened(&careless) > darkened(&blurred), "{} {}", darkened(&careless), darkened(&blurred));
    // Farther away the same radius is fewer pixels.
    let mut far = cube_view(|settings| {
        settings.cascades.filter = ShadowFilter::Tent2;
        settings.techniques.set(&ScreenSettings { blur_m: 0.15, ..ScreenSettings::default() }).unwrap();
        settings.distance_m = 90.0;
    });
    far.camera = crate::stage::camera(DVec3::new(10.0, 15.0, 20.0), DVec3::new(0.0, 0.3, 0.0));
    let share = |greys: &Greys| between(greys) as f64 / count(greys, |grey| grey < 253) as f64;
    let near = cube_view(|settings| {
        settings.cascades.filter = ShadowFilter::Tent2;
        let own = ScreenSettings { blur_m: 1.0, blur_max_px: 32.0, ..ScreenSettings::default() };
        settings.techniques.set(&own).unwrap();
    });
    let widths = [&near, &far].map(|options| between(&screen_greys(gpu, &scene, 0, options)));
    assert!(widths[1] * 4 < widths[0], "{widths:?} {}", share(&blurred));
}

/// A frame with screen-space shadows that is not drawn.
struct Prepared {
    /// Whether it is lit by the mask alone.
    is_mask_only: bool,
    /// The WGSL of the technique.
    text: String,
    /// The number of layers of the mask.
    layers: u32,
}

/// Prepares a frame of the pillars.
fn prepare_pillars(has_blended: bool, lights: usize) -> Prepared {
    let mut scene = pillars_in_sun();
    let spot = scene.lights()[1].clone();
    for _ in 2..lights {
        scene.insert_light(spot.clone());
    }
    assert_eq!(scene.lights().len(), lights);
    prepare(scene, &pillar_view(|_| ()), has_blended)
}

fn prepare(scene: Scene, options: &ViewOptions, has_blended: bool) -> Prepared {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let screen_shadows = ScreenShadows::new(&device, Box::new(Pcf::new(&device))).unwrap();
    let renderer = Renderer::new(&Gpu::noop().unwrap(), scene, &options.camera, Aov::Color).unwrap();
    let inputs = ShadowInputs {
        view: 0,
        camera: &options.camera,
        aspect: 1.5,
        lights: renderer.scene().lights(),
        casters: renderer.casters(),
        origin_world: DVec3::ZERO,
        settings: &options.shadows,
    };
    let mut frame = Frame::new();
    let mut surfaces = frame.create_texture("surfaces", TextureDesc::d2(64, 64, Format::Rgba32Float));
    frame.render_pass("surfaces").color(&mut surfaces, Contents::clear_color([0.0; 4]));
    let buffers = SurfaceBuffers {
        size_px: [64, 64],
        view: frame.upload_buffer("view", vec![0; 272]),
        lights: frame.upload_buffer("lights", vec![0; 64]),
        surfaces,
        has_blended,
        ground_height: None,
    };
    let outputs = add_shadows(&screen_shadows, &mut frame, &inputs, Some(&buffers)).unwrap();
    let modules = screen_shadows.modules(outputs.variant);
    let mask = frame.texture_desc(&outputs.mask.unwrap()).unwrap();
    Prepared {
        is_mask_only: outputs.variant == screen_shadows.variant_count() - 1,
        text: modules.iter().map(|module| module.source.as_ref()).collect(),
        layers: mask.size.depth_or_array_layers,
    }
}

#[test]
fn row_36_the_lit_pass_reads_one_texel_of_the_mask_and_no_cascades() {
    let Prepared { is_mask_only, text, .. } = prepare_pillars(false, 2);
    assert!(is_mask_only && text.contains("shadow_mask"), "{text}");
    assert!(!text.contains("light_view") && !text.contains("cascade_map"), "{text}");
    // Where the mask is not enough, the WGSL of the other technique is included.
    for Prepared { is_mask_only, text, .. } in [prepare_pillars(true, 2), prepare_pillars(false, 17)] {
        assert!(!is_mask_only && text.contains("shadow_mask") && text.contains("light_view"), "{text}");
    }
}

#[test]
fn row_36_blended_geometry_receives_shadows() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    let glass = shadowgraph::scene::Material { alpha: AlphaMode::Blend, ..crate::stage::material() };
    let (floor, glass) = (nth_mesh(&scene, 0), scene.insert_material(glass).unwrap());
    // A blended sheet just above the floor: the cube's shadow falls on it.
    crate::stage::add_instance(&mut scene, floor, glass, DVec3::new(0.0, 0.02, 0.0));
    scene.insert_light(sun(sun_direction(40.0, 130.0)));
    let options = cube_view(|_| ());
    let [forward, screen] = [Pipeline::minimal_lit(), Pipeline::screen_shadows()]
        .map(|pipeline| render(gpu, &scene, Aov::Color, &options, pipeline).rgba8);
    let differ = forward.iter().zip(&screen).filter(|(a, b)| a.abs_diff(**b) > 3).count();
    assert!(differ < forward.len() / 1000, "{differ}");
}

#[test]
fn row_52_four_lights_share_a_layer_of_the_mask_but_those_behind_glass() {
    for (lights, layers) in [(2, 1), (4, 1), (5, 2), (8, 2), (17, 4)] {
        assert_eq!(prepare_pillars(false, lights).layers, layers, "{lights} lights");
    }
    // The sun and the lamp shine through glass; the others stand away from it.
    let mut scene = stained_glass();
    let options = ViewOptions { size_px: SIZE_PX, ..view(scene.cameras[0].clone(), 60.0) };
    assert_eq!(scene.lights().len(), 2);
    for x in [-8.0, -6.0, 6.0] {
        let mut lamp = super::spot(DVec3::new(x, 2.0, 9.0), DVec3::new(x, 0.0, 9.0), 0.5);
        lamp.intensity = 900.0;
        scene.insert_light(lamp);
    }
    assert_eq!(prepare(scene.clone(), &options, false).layers, 3);
    let Some(gpu) = gpu() else { return };
    let [per_pixel, screen] = [Pipeline::minimal_lit(), Pipeline::screen_shadows()]
        .map(|pipeline| render(gpu, &scene, Aov::Color, &options, pipeline).rgba8);
    let differ = per_pixel.iter().zip(&screen).filter(|(a, b)| a.abs_diff(**b) > 4).count();
    assert!(differ < per_pixel.len() / 500, "{differ}");
}

#[test]
fn row_52_a_light_has_the_same_shadows_alone_in_a_layer_and_with_three_others() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(4);
    for x in [-1.5, -0.5, 0.5, 1.5] {
        scene.insert_light(super::spot(DVec3::new(x, 3.0, 1.0 - x), DVec3::new(-x, 0.0, -4.0), 0.7));
    }
    let lights = scene.lights().to_vec();
    let options = pillar_view(|settings| {
        let rays = RaytracedSettings { rays: 4, light_radius_m: 0.2, ..RaytracedSettings::default() };
        settings.techniques.set(&rays).unwrap();
    });
    let technique = Technique::from(RAYTRACED).with_contact();
    for (index, light) in (0..).zip(&lights) {
        let together = draw_with(gpu, &scene, Aov::Visibility(index), &options, technique).image;
        let mut single = scene.clone();
        single.set_lights([light.clone()]);
        let alone = draw_with(gpu, &single, Aov::Visibility(0), &options, technique).image;
        assert!(together == alone, "light {index}");
        let shadowed = alone.rgba8.chunks_exact(4).filter(|rgba| rgba[3] == 255 && rgba[0] < 200).count();
        assert!(shadowed > 50, "light {index}: {shadowed}");
    }
}

#[test]
fn row_52_a_wide_blur_has_no_grain() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(sun_direction(40.0, 130.0)));
    let options = cube_view(|settings| {
        let own = ScreenSettings { blur_m: 1.0, blur_max_px: 32.0, ..ScreenSettings::default() };
        settings.techniques.set(&own).unwrap();
    });
    let greys = screen_greys(gpu, &scene, 0, &options);
    // In a smooth image, a pixel is the mean of its neighbours in the row.
    let mut grain: Vec<f64> = greys
        .windows(3)
        .filter_map(|row| match row {
            [Some(left), Some(grey), Some(right)] if (20..235).contains(grey) => {
                Some((f64::from(*grey) - 0.5 * (f64::from(*left) + f64::from(*right))).abs())
            }
            _ => None,
        })
        .collect();
    grain.sort_by(f64::total_cmp);
    let [median, upper] = [0.5, 0.9].map(|part| grain[(part * grain.len() as f64) as usize]);
    println!("median {median}, 90 % below {upper} of 255 in {} pixels", grain.len());
    assert!(grain.len() > 1000 && median <= 1.0, "{median} of 255 in {} pixels", grain.len());
}
