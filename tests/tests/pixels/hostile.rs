//! Invalid and extreme inputs: a clear error or a correct image.

use crate::stage::{camera, cube_on_floor, gpu, light, sun, sun_direction, view};
use glam::DVec3;
use shadowgraph::Pipeline;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Light, LightKind, Projection, Scene};
use shadowgraph::shadows::{
    AtlasTiles, NONE, PCF, RAYTRACED, ShadowSettings, TechniqueKind, UnshadowedReason,
};
use shadowgraph::{Gpu, RenderConfig, RenderedFrame, Renderer, ViewOptions};

fn eye() -> Camera {
    camera(DVec3::new(2.0, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0))
}

fn options() -> ViewOptions {
    view(eye(), 20.0)
}

fn lit_by(lights: Vec<Light>) -> Scene {
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.set_lights(lights);
    scene
}

fn spot(position_world: DVec3, direction: DVec3) -> Light {
    let (range, inner_angle, outer_angle) = (Some(20.0), 0.3, 0.5);
    light(LightKind::Spot { position_world, direction, range, inner_angle, outer_angle }, 2000.0)
}

/// A renderer for each technique and pipeline.
struct Renderers(Vec<Renderer>);

impl Renderers {
    fn new(gpu: &Gpu) -> Self {
        let configs: [RenderConfig; 5] = [
            lit_by_technique(PCF),
            Pipeline::screen_shadows().into(),
            Pipeline::minimal().into(),
            lit_by_technique(RAYTRACED),
            lit_by_technique(NONE),
        ];
        let renderer =
            |config| Renderer::with_config(gpu, lit_by(Vec::new()), &eye(), Aov::Color, config).unwrap();
        Self(configs.map(renderer).into())
    }

    fn draw(&mut self, gpu: &Gpu, lights: &[Light], options: &ViewOptions) -> Vec<RenderedFrame> {
        let draw = |renderer: &mut Renderer| {
            renderer.scene_mut().set_lights(lights.to_vec());
            renderer.draw(gpu, options).unwrap()
        };
        self.0.iter_mut().map(draw).collect()
    }
}

/// Returns the pipeline that others build on, with a technique.
fn lit_by_technique(kind: TechniqueKind) -> RenderConfig {
    RenderConfig { pipeline: Pipeline::minimal_lit(), ..kind.into() }
}

/// Counts the pixels that differ by more than a quarter of white.
fn different(a: &RenderedFrame, b: &RenderedFrame) -> usize {
    let pixels = a.image.rgba8.chunks_exact(4).zip(b.image.rgba8.chunks_exact(4));
    pixels.filter(|(a, b)| (0..3).any(|i| a[i].abs_diff(b[i]) > 64)).count()
}

/// Asserts that all but the last are close to ray tracing, which is the last but one.
fn agree(drawn: &[RenderedFrame]) {
    let [others @ .., truth, _] = drawn else { panic!("five images") };
    for other in others {
        let wrong = different(other, truth);
        assert!(wrong < 600, "{wrong} of 57,600 pixels");
    }
}

#[test]
fn a_scene_without_lights_renders_without_shadow_maps() {
    let Some(gpu) = gpu() else { return };
    let drawn = Renderers::new(gpu).draw(gpu, &[], &options());
    assert!(drawn.iter().all(|drawn| drawn.unshadowed.is_empty()));
    assert!(drawn.iter().all(|other| other.image == drawn[0].image));
    assert!(drawn[0].image.rgba8.chunks_exact(4).any(|rgba| rgba[0] > 20), "there is ambient light");
}

#[test]
fn lights_at_the_camera_show_no_shadow() {
    let Some(gpu) = gpu() else { return };
    let at = eye().position_world();
    let point = light(LightKind::Point { position_world: at, range: Some(30.0) }, 2000.0);
    let mut renderers = Renderers::new(gpu);
    for light in [spot(at, eye().forward_world()), point] {
        let drawn = renderers.draw(gpu, &[light], &options());
        agree(&drawn);
        // From the position of the light no shadow is visible.
        assert!(different(&drawn[0], &drawn[4]) < 600);
        assert!(drawn[0].unshadowed.is_empty());
    }
}

#[test]
fn seventeen_spot_lights_share_the_atlas_and_with_even_tiles_the_last_is_reported_as_unshadowed() {
    let Some(gpu) = gpu() else { return };
    let around = |i: u32| {
        let angle = f64::from(i) * std::f64::consts::TAU / 17.0;
        let position = DVec3::new(angle.cos() * 4.0, 4.0, angle.sin() * 4.0);
        Light { intensity: 300.0, ..spot(position, -position.normalize()) }
    };
    let lights: Vec<Light> = (0..17).map(around).collect();
    let mut options = options();
    let by_importance = Renderers::new(gpu).draw(gpu, &lights, &options);
    agree(&by_importance);
    assert!(by_importance[0].unshadowed.is_empty());
    options.shadows.atlas.tiles = AtlasTiles::Even;
    let config = lit_by_technique(PCF);
    let mut renderer = Renderer::with_config(gpu, lit_by(lights), &eye(), Aov::Color, config).unwrap();
    let even = renderer.draw(gpu, &options).unwrap();
    let reasons: Vec<_> = even.unshadowed.iter().map(|light| light.reason).collect();
    assert_eq!(reasons, [UnshadowedReason::AtlasFull]);
    assert!(different(&even, &by_importance[3]) < 2000);
}

#[test]
fn invalid_lights_contribute_nothing() {
    let Some(gpu) = gpu() else { return };
    let good = sun(sun_direction(40.0, 60.0));
    let mut renderers = Renderers::new(gpu);
    let alone = renderers.draw(gpu, std::slice::from_ref(&good), &options());
    let point = |range| LightKind::Point { position_world: DVec3::Y * 3.0, range };
    let broken = [
        sun(DVec3::ZERO),
        sun(DVec3::NAN),
        spot(DVec3::Y * 3.0, DVec3::ZERO),
        spot(DVec3::NAN, DVec3::NEG_Y),
        light(point(Some(f64::NAN)), 500.0),
        light(point(Some(0.0)), 500.0),
        light(point(Some(-1.0)), 500.0),
        light(point(Some(9.0)), f32::NAN),
    ];
    for (index, broken) in broken.into_iter().enumerate() {
        let together = renderers.draw(gpu, &[broken, good.clone()], &options());
        for (alone, together) in alone.iter().zip(&together) {
            assert!(
                alone.image == together.image,
                "light {index}: {} pixels differ",
                different(alone, together)
            );
        }
        assert_eq!(together[0].unshadowed.len(), 1, "light {index}");
    }
}

#[test]
fn invalid_cameras_and_image_sizes_are_errors_that_name_the_field() {
    let Some(gpu) = gpu() else { return };
    let perspective = |near, far| Projection::Perspective { fov_y: 0.9, near, far: Some(far) };
    for technique in [PCF, RAYTRACED, NONE] {
        let scene = lit_by(vec![sun(DVec3::NEG_Y)]);
        let mut renderer = Renderer::with_config(gpu, scene, &eye(), Aov::Color, technique).unwrap();
        let good = renderer.draw(gpu, &options()).unwrap().image;
        let mut refused = |options: &ViewOptions, part: &str| {
            let error = renderer.draw(gpu, options).unwrap_err().to_string();
            assert!(error.contains(part) && error.lines().count() == 1, "{error}");
        };
        for (near, far) in [(5.0, 5.0), (5.0, 1.0), (1.0, f64::NAN)] {
            let camera = Camera { projection: perspective(near, far), ..eye() };
            refused(&ViewOptions { camera, ..options() }, "beyond its near plane");
        }
        let mut lost = options();
        lost.camera.world_from_view.translation = DVec3::NAN;
        refused(&lost, "transform");
        refused(&ViewOptions { size_px: [0, 0], ..options() }, "aspect ratio");
        refused(&ViewOptions { size_px: [64, 0], ..options() }, "aspect ratio");
        refused(&ViewOptions { size_px: [1 << 20, 64], ..options() }, "max_texture_dimension_2d");
        // The next frame renders as before.
        assert!(renderer.draw(gpu, &options()).unwrap().image == good);
    }
}

#[test]
fn settings_out_of_range_are_errors_that_name_the_field_and_the_next_frame_renders() {
    let Some(gpu) = gpu() else { return };
    let scene = lit_by(vec![sun(DVec3::NEG_Y)]);
    let mut renderer = Renderer::new(gpu, scene, &eye(), Aov::Color).unwrap();
    let good = renderer.draw(gpu, &options()).unwrap().image;
    let mut wrong = [(); 4].map(|()| ShadowSettings::default());
    wrong[0].cascades.map_size_px = 0;
    wrong[1].atlas.map_size_px = 0;
    wrong[2].distance_m = f32::NAN;
    wrong[3].bias.slope = f32::INFINITY;
    let fields = ["cascades.map_size_px", "atlas.map_size_px", "distance_m", "bias.slope"];
    for (field, shadows) in fields.into_iter().zip(wrong) {
        let options = ViewOptions { shadows, ..options() };
        let error = renderer.draw(gpu, &options).unwrap_err().to_string();
        assert!(error.contains(field) && error.contains("allowed"), "{error}");
        assert!(renderer.draw(gpu, &self::options()).unwrap().image == good);
    }
}
