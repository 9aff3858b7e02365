//! Images of each output of the program.

use crate::stage::{camera, cube_on_floor, draw, gpu, nth_instance, sun, view};
use glam::DVec3;
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::pipelines::Parameters;
use shadowgraph::scene::Scene;
use shadowgraph::{Error, Pipeline, Registry, RenderConfig, RenderedImage, Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;
use std::collections::HashSet;

fn cube() -> (Scene, ViewOptions) {
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(DVec3::new(0.4, -1.0, 0.3).normalize()));
    (scene, view(camera(DVec3::new(2.5, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0)), 30.0))
}

fn cube_image(aov: Aov) -> Option<RenderedImage> {
    let (scene, options) = cube();
    Some(draw(gpu()?, scene, aov, &options).image)
}

/// Pixels of the image: sky and the top of the cube.
const SKY: (u32, u32) = (2, 2);
const TOP: (u32, u32) = (160, 72);

#[test]
fn visibility_has_no_alpha_where_nothing_is_drawn_or_the_surface_faces_away() {
    let Some(image) = cube_image(Aov::Visibility(0)) else { return };
    assert_eq!(image.pixel(SKY.0, SKY.1).unwrap()[3], 0);
    assert_eq!(image.pixel(TOP.0, TOP.1).unwrap(), [255; 4]);
    let greys: HashSet<_> = image.rgba8.chunks_exact(4).filter(|p| p[3] == 255).map(|p| p[0]).collect();
    assert!(greys.contains(&0) && greys.contains(&255) && greys.len() > 10, "a filtered edge: {greys:?}");
    assert!(image.rgba8.chunks_exact(4).all(|p| p[3] == 0 || (p[3] == 255 && p[0] == p[1] && p[1] == p[2])));
}

#[test]
fn normals_are_in_world_space() {
    let Some(image) = cube_image(Aov::Normal) else { return };
    // 0 becomes 127.5, which GPUs round up or down.
    let Some([x @ 127..=128, 255, z @ 127..=128, _]) = image.pixel(TOP.0, TOP.1) else {
        panic!("{:?}", image.pixel(TOP.0, TOP.1));
    };
    assert_eq!(x, z);
}

#[test]
fn depth_is_white_near_dark_far_and_black_in_the_background() {
    let Some(image) = cube_image(Aov::Depth) else { return };
    let grey = |(x, y): (u32, u32)| image.pixel(x, y).unwrap()[0];
    assert_eq!(grey(SKY), 0);
    let (near, far) = (grey((160, 175)), grey((160, 20)));
    assert!(near > grey(TOP) && grey(TOP) > far && far > 0, "{near} {far}");
}

#[test]
fn each_cascade_has_its_own_colour() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(DVec3::new(0.4, -1.0, 0.3).normalize()));
    let options = view(camera(DVec3::new(0.0, 1.0, 18.0), DVec3::ZERO), 40.0);
    let image = draw(gpu, scene, Aov::Cascade, &options).image;
    let hue = |p: &[u8]| (p[0] > p[1], p[1] > p[2], p[0] > p[2]);
    let hues: HashSet<_> = image.rgba8.chunks_exact(4).filter(|p| p[0] != p[1]).map(hue).collect();
    assert!(hues.len() >= 3, "{hues:?}");
}

#[test]
fn the_atlas_output_shows_both_maps_and_runs_only_their_passes() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let options = view(scene.cameras[0].clone(), 60.0);
    let drawn = draw(gpu, scene, Aov::Atlas, &options);
    let paths: Vec<_> = drawn.plan.order().iter().map(|&id| drawn.plan.pass_path(id)).collect();
    let runs = |path: &str| paths.iter().any(|own| own == path);
    // Each tile is a separate pass.
    for map in ["shadows/cascades/cascade 0", "shadows/cascades/cascade 3", "shadows/atlas/light 1"] {
        assert!(runs(map), "{map}: {paths:?}");
    }
    assert!(!runs("lighting/forward"), "{paths:?}");
    let greys = |range: std::ops::Range<u32>| -> HashSet<_> {
        range
            .flat_map(|x| (0..180).map(move |y| (x, y)))
            .map(|(x, y)| drawn.image.pixel(x, y).unwrap()[0])
            .collect()
    };
    assert!(greys(0..160).len() > 20 && greys(160..320).len() > 20, "each map has casters");
}

#[test]
fn any_texture_of_the_graph_can_be_shown_and_the_error_for_an_unknown_one_lists_them() {
    let Some(gpu) = gpu() else { return };
    let (scene, options) = cube();
    let lit = draw(gpu, scene, Aov::Texture("lit".into()), &options).image;
    assert_ne!(lit.pixel(TOP.0, TOP.1), lit.pixel(SKY.0, SKY.1));
    for (name, hint) in
        [("visibilty:0", "did you mean `visibility:0`?"), ("?", "expected one of: color, visibility:0, ")]
    {
        let (scene, options) = cube();
        let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Texture(name.into())).unwrap();
        let error = renderer.draw(gpu, &options).unwrap_err();
        assert!(matches!(error, Error::UnknownTexture { .. }), "{error}");
        assert!(error.to_string().contains(hint), "{error}");
    }
}

#[test]
fn integer_textures_are_refused_and_single_channel_textures_are_grey() {
    let Some(gpu) = gpu() else { return };
    let draw = |name: &str, pipeline: Pipeline| {
        let (scene, options) = cube();
        let aov = Aov::Texture(name.into());
        let mut renderer =
            Renderer::with_config(gpu, scene, &options.camera, aov, RenderConfig::from(pipeline)).unwrap();
        renderer.draw(gpu, &options).map(|drawn| drawn.image)
    };
    let error = draw("normals", Pipeline::deferred()).unwrap_err().to_string();
    assert!(
        error.starts_with("texture `normals` (Rg32Uint): integer textures cannot be displayed"),
        "{error}"
    );
    let everything = shadowgraph_tests::repository().join("docs/everything.ron");
    let Registry { nodes, techniques } = Registry::built_in();
    let parameters = Parameters(vec![("ssao".into(), true.into())]);
    let pipeline = Pipeline::load(&everything, &nodes, &techniques, &parameters).unwrap();
    let occlusion = draw("occlusion", pipeline).unwrap();
    assert!(occlusion.rgba8.chunks(4).all(|texel| texel[0] == texel[1] && texel[1] == texel[2]));
}

#[test]
fn the_visibility_of_a_missing_light_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let (scene, options) = cube();
    let error = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(3)).err().unwrap().to_string();
    assert_eq!(error, "unknown light 3; the scene has one light, 0");
}

#[test]
fn rendering_a_view_twice_gives_equal_images_and_plans() {
    let Some(gpu) = gpu() else { return };
    let (scene, mut options) = cube();
    options.shadows = options.shadows.without_cache();
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Color).unwrap();
    let (first, second) = (renderer.draw(gpu, &options).unwrap(), renderer.draw(gpu, &options).unwrap());
    assert_eq!(first.image, second.image);
    assert_eq!(first.plan, second.plan);
}

#[test]
fn shadows_fade_out_at_the_shadow_distance() {
    let Some(gpu) = gpu() else { return };
    // A roof over the whole floor, which is dark up to the shadow distance and lit beyond it.
    let mut scene = cube_on_floor(DVec3::ZERO);
    let roof = glam::DAffine3::from_scale_rotation_translation(
        DVec3::new(60.0, 1.0, 60.0),
        glam::DQuat::IDENTITY,
        DVec3::new(0.0, 8.0, 0.0),
    );
    scene.move_instance(nth_instance(&scene, 1), roof).unwrap();
    scene.insert_light(sun(DVec3::NEG_Y));
    let options = view(camera(DVec3::new(0.0, 5.0, 18.0), DVec3::ZERO), 16.0);
    let image = draw(gpu, scene, Aov::Visibility(0), &options).image;
    let column: Vec<u8> =
        (0..180).rev().map(|y| image.pixel(160, y).unwrap()).filter(|p| p[3] == 255).map(|p| p[0]).collect();
    assert_eq!((column[0], *column.last().unwrap()), (0, 255), "{column:?}");
    let between = column.iter().filter(|grey| (1..255).contains(*grey)).count();
    assert!(between >= 3, "{column:?}");
    assert!(column.windows(2).all(|pair| pair[1] >= pair[0]), "{column:?}");
}

#[test]
fn the_automatic_shadow_distance_covers_the_visible_scene() {
    let (scene, options) = cube();
    let distance = options.with_shadow_distance(ShadowDistance::Auto, &scene).shadows.distance_m;
    // The far corner of the floor is about 32 m from the camera.
    assert!((20.0..40.0).contains(&distance), "{distance}");
}
