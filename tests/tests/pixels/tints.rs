//! Coloured shadows: tint maps compared with rays through the same glass.

use glam::{DVec3, Vec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::gpu::{DepthTarget, GpuScene};
use shadowgraph::scene::{CasterMode, Scene, linear_from_srgb};
use shadowgraph::shadows::{
    EVSM, MSM, NONE, PCF, PCSS, Pcf, RAYTRACED, SDSM, ShadowFilter, Technique, VIRTUAL, VirtualSettings,
};
use shadowgraph::{Gpu, Renderer, SceneCasters, ViewOptions};
use shadowgraph_samples::test_scenes::stained_glass;

use crate::maps::draw_map;
use crate::stage::{draw_with, gpu, hard, view};

/// Returns the scene with one of its lights, 0 the sun or 1 the spot light, and a view from its camera.
fn lit_by(light: usize) -> (Scene, ViewOptions) {
    let mut scene = stained_glass();
    scene.set_lights([scene.lights()[light].clone()]);
    let options = ViewOptions { size_px: [640, 360], ..view(scene.cameras[0].clone(), 60.0) };
    (scene, options)
}

/// Returns the screen mask of the only light: its visibility at each pixel's surface that faces it.
fn mask(gpu: &Gpu, scene: &Scene, options: &ViewOptions, technique: Technique) -> Vec<Vec3> {
    let aov = Aov::Texture("shadow mask".into());
    let mut renderer = Renderer::with_config(gpu, scene.clone(), &options.camera, aov, technique).unwrap();
    let image = renderer.draw(gpu, options).unwrap().image;
    let color =
        |rgba: &[u8]| Vec3::from([rgba[0], rgba[1], rgba[2]].map(|byte| linear_from_srgb(byte) as f32));
    let faces = facing(gpu, scene, options);
    let colors = image.rgba8.chunks_exact(4).map(color).zip(faces);
    colors.filter(|(_, faces)| *faces).map(|(color, _)| color).collect()
}

/// Returns which pixels show surfaces that face the light; the others do not count.
fn facing(gpu: &Gpu, scene: &Scene, options: &ViewOptions) -> Vec<bool> {
    let image = draw_with(gpu, scene, Aov::Visibility(0), options, NONE).image;
    image.rgba8.chunks_exact(4).map(|rgba| rgba[3] == 255).collect()
}

/// Returns the fraction of the pixels in which a colour differs by more than `by`.
fn differing(a: &[Vec3], b: &[Vec3], by: f32) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.filter(|(a, b)| (**a - **b).abs().max_element() > by).count() as f64 / a.len() as f64
}

/// Returns the fraction of the pixels whose visibility differs between colours.
fn coloured(mask: &[Vec3]) -> f64 {
    let is_coloured = |color: &&Vec3| color.max_element() - color.min_element() > 0.04;
    mask.iter().filter(is_coloured).count() as f64 / mask.len() as f64
}

#[test]
fn maps_and_rays_agree_on_the_colours_behind_stained_glass() {
    let Some(gpu) = gpu() else { return };
    for light in [0, 1] {
        let (scene, mut options) = lit_by(light);
        options.shadows.cascades.filter = ShadowFilter::Tent2;
        options.shadows.atlas.filter = ShadowFilter::Tent2;
        // As rays do, compare at the centres of pixels, in narrow texels.
        options.shadows.supersample = false;
        let own =
            VirtualSettings { level_bias: -1.0, filter: ShadowFilter::Tent2, ..VirtualSettings::default() };
        options.shadows.techniques.set(&own).unwrap();
        let truth = mask(gpu, &scene, &hard(&options), RAYTRACED.into());
        let coloured = coloured(&truth);
        assert!(coloured > 0.04, "light {light}: {coloured}");
        for kind in [PCF, VIRTUAL] {
            let maps = mask(gpu, &scene, &options, Technique::from(kind).with_screen());
            let part = differing(&maps, &truth, 0.02);
            println!("light {light}, {}: {:.3} % differ", kind.name, 100.0 * part);
            assert!(part < 0.01, "light {light}, {}: {part}", kind.name);
        }
    }
}

#[test]
fn every_map_technique_tints_light_with_and_without_contact_shadows() {
    let Some(gpu) = gpu() else { return };
    let (scene, mut options) = lit_by(0);
    options.shadows.cascades.map_size_px = 2048;
    let truth = mask(gpu, &scene, &hard(&options), RAYTRACED.into());
    let techniques = [PCSS, EVSM, MSM, SDSM, VIRTUAL].map(|kind| Technique::from(kind).with_screen());
    for technique in techniques.into_iter().chain([Technique::from(PCF).with_screen().with_contact()]) {
        let mask = mask(gpu, &scene, &options, technique);
        let part = differing(&mask, &truth, 0.1);
        println!("{}: {:.2} % differ by a tenth", technique.name(), 100.0 * part);
        assert!(part < 0.03, "{}: {part}", technique.name());
    }
}

#[test]
fn materials_that_cast_no_tint_leave_light_uncoloured() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, options) = lit_by(0);
    let pcf = Technique::from(PCF).with_screen();
    assert!(coloured(&mask(gpu, &scene, &options, pcf)) > 0.04);
    for mode in [CasterMode::On, CasterMode::Off] {
        let materials: Vec<_> = scene.materials().map(|(key, _)| key).collect();
        for key in materials {
            scene.edit_material(key, |material| material.casts = Some(mode)).unwrap();
        }
        assert_eq!(coloured(&mask(gpu, &scene, &options, pcf)), 0.0, "{mode:?}");
    }
}

#[test]
fn cached_tints_equal_tints_rendered_every_frame() {
    let Some(gpu) = gpu() else { return };
    let (scene, mut options) = lit_by(0);
    options.shadows.cascades.map_size_px = 1024;
    options.shadows.atlas.map_size_px = 1024;
    let lights = stained_glass().lights().to_vec();
    let draw = |cache| {
        let mut options = options.clone();
        (options.shadows.cascades.cache, options.shadows.atlas.cache) = (cache, cache);
        let mut renderer = Renderer::new(gpu, scene.clone(), &options.camera, Aov::Color).unwrap();
        // Both lights, both again, and only the sun while the camera moves.
        [(2, 0.0), (2, 0.0), (1, 0.3), (1, 0.3)].map(|(count, step)| {
            renderer.scene_mut().set_lights(lights[..count].to_vec());
            options.camera.world_from_view.translation = scene.cameras[0].position_world() + DVec3::X * step;
            let drawn = renderer.draw(gpu, &options).unwrap();
            let passes = drawn.plan.order().iter().map(|&pass| drawn.plan.pass_path(pass).to_string());
            (drawn.image, passes.filter(|path| path.contains(" tints/")).count())
        })
    };
    let (kept, uncached) = (draw(true), draw(false));
    for ((kept, _), (uncached, passes)) in kept.iter().zip(&uncached) {
        assert!(kept == uncached && *passes > 0);
    }
    assert!(kept[0].1 > 0);
    assert_eq!([kept[1].1, kept[3].1], [0, 0]);
}

#[test]
fn tints_in_front_of_the_near_plane_match_the_hardware_clamp() {
    let Some(gpu) = gpu() else { return };
    if !gpu.device.features().contains(shadowgraph::wgpu::Features::DEPTH_CLIP_CONTROL) {
        return shadowgraph_tests::skip(
            "depth_clip_control",
            "the adapter has no DEPTH_CLIP_CONTROL to compare with",
        );
    }
    let (scene, mut options) = lit_by(0);
    // So short that the window is outside of the first cascade.
    options.shadows.distance_m = 12.0;
    options.shadows.cascades.map_size_px = 1024;
    let upload = || GpuScene::new(&gpu.device, &gpu.queue, &scene, DVec3::ZERO).unwrap();
    let maps = [false, true].map(|emulate_clamp| {
        let target = DepthTarget { clamp_near: true, emulate_clamp, ..DepthTarget::default() };
        let casters = SceneCasters::with_target(&gpu.device, upload(), &target).unwrap();
        let (technique, camera) = (Pcf::new(&gpu.device), &scene.cameras[0]);
        let settings = &options.shadows;
        let map = draw_map(gpu, &technique, &casters, scene.lights(), camera, settings, "cascade tints");
        map.depth.iter().map(|texel| texel.to_bits()).collect::<Vec<_>>()
    });
    let tinted = maps[0].iter().filter(|texel| **texel != u32::MAX).count();
    let differ = maps[0].iter().zip(&maps[1]).filter(|(a, b)| a != b).count();
    assert!(tinted > 1000, "{tinted}");
    assert!(differ <= maps[0].len() / 10_000, "{differ} of {} texels differ", maps[0].len());
}
