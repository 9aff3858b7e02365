//! Every technique and pipeline with every mix of lights and every kind of caster: a contact sheet of small images.
//!
//! This is the longest test of its program. Tests start in the order of their names; at the end of it this one would run alone.

use crate::stage::{camera, gpu, hard, light, sun, view};
use glam::{DAffine3, DVec3, Vec3, Vec4};
use image::{Rgba, RgbaImage};
use shadowgraph::Pipeline;
use shadowgraph::options::Aov;
use shadowgraph::scene::{
    AlphaMode, CasterMode, Image, Instance, Light, LightKind, Material, Mesh, Scene, TextureRef, Vertex,
};
use shadowgraph::shadows::{EVSM, NONE, PCF, PCSS, RAYTRACED, Technique, Techniques, VIRTUAL};
use shadowgraph::{Gpu, RenderConfig, RenderedImage, Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;

const CELL_PX: [u32; 2] = [240, 120];
const GAP_PX: u32 = 4;
const MIXES: [&str; 5] = ["sun", "spots", "points", "several suns", "no light"];

/// Returns the configurations to compare, the reference first: all techniques, the other pipelines, and techniques with
/// modifiers.
fn configs() -> Vec<(String, RenderConfig)> {
    let mut configs: Vec<(String, RenderConfig)> = vec![("truth".into(), RAYTRACED.into())];
    configs.extend(Techniques::built_in().kinds().iter().map(|&kind| (kind.name.into(), kind.into())));
    configs.extend([
        ("pcf, minimal".into(), Pipeline::minimal().into()),
        ("pcf, screen_shadows".into(), Pipeline::screen_shadows().into()),
        ("pcf, 4 samples".into(), RenderConfig { samples: 4, ..RenderConfig::default() }),
    ]);
    let on_top = [
        Technique::from(PCF).with_contact(),
        Technique::from(PCSS).with_screen(),
        Technique::from(EVSM).with_contact(),
        Technique::from(RAYTRACED).with_contact(),
    ];
    configs.extend(on_top.map(|technique| (technique.name(), technique.into())));
    for (_, config) in &mut configs {
        // Images without exposure of their brightness are comparable.
        if config.pipeline == Pipeline::default() {
            config.pipeline = Pipeline::minimal_lit();
        }
    }
    configs
}

#[test]
fn every_technique_and_pipeline_renders_every_mix_of_lights_and_casters() {
    let Some(gpu) = gpu() else { return };
    let mut sheet = Sheet::new();
    let mut truth = Vec::new();
    let mut wrong = Vec::new();
    for (row, (name, config)) in configs().into_iter().enumerate() {
        let images = images(gpu, config.clone(), CELL_PX, row == 0);
        if row == 0 {
            truth.clone_from(&images);
        }
        for (column, (image, truth)) in images.iter().zip(&truth).enumerate() {
            sheet.paste(image, column, row);
            let (darker, lighter) = differing(image, truth);
            // Without shadows the image is too bright.
            let wrong_part = if config.technique() == NONE { darker } else { darker + lighter };
            let line = format!("{name}, {}: {darker:.4} darker, {lighter:.4} lighter", MIXES[column]);
            println!("{line}");
            let has_shadows = MIXES[column] != "no light";
            let shows_none = config.technique() == NONE && has_shadows && lighter < 0.05;
            // Without the colours of translucent casters.
            let allowed = if config.technique().name() == VIRTUAL.name { 0.04 } else { 0.03 };
            if wrong_part > allowed || shows_none {
                wrong.push(line);
            }
        }
    }
    let dir = shadowgraph_tests::images().unwrap_or_else(|| env!("CARGO_TARGET_TMPDIR").into());
    let file = dir.join("contact_sheet.png");
    sheet.0.save(&file).unwrap();
    println!("wrote {}", file.display());
    if let Some(dir) = shadowgraph_tests::images() {
        let under_spots = images(gpu, PCF.into(), [640, 320], false).swap_remove(1);
        RgbaImage::from_raw(640, 320, under_spots.rgba8).unwrap().save(dir.join("panels.png")).unwrap();
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Renders an image for each mix of lights.
fn images(gpu: &Gpu, config: RenderConfig, size_px: [u32; 2], is_truth: bool) -> Vec<RenderedImage> {
    let mut scene = demo_scene();
    add_panels(&mut scene);
    let camera = camera(DVec3::new(-4.8, 4.2, 15.0), DVec3::new(-5.3, 0.2, 9.4));
    let options = ViewOptions { size_px, ..view(camera, 80.0) };
    let mut options = if is_truth { hard(&options) } else { options };
    options.shadows.cascades.map_size_px = 1024;
    let own = scene.lights().to_vec();
    let mut renderer = Renderer::with_config(gpu, scene, &options.camera, Aov::Color, config).unwrap();
    let mut render = |mix: &&str| {
        renderer.scene_mut().set_lights(lights(mix, &own));
        renderer.draw(gpu, &options).unwrap().image
    };
    MIXES.iter().map(&mut render).collect()
}

/// Returns the lights of a mix; `own` are the demo scene's, the sun first.
fn lights(mix: &str, own: &[Light]) -> Vec<Light> {
    let [warm, cool] = [Vec3::new(1.0, 0.8, 0.6), Vec3::new(0.6, 0.8, 1.0)];
    let sun_of = |x: f64, z: f64, color| Light { color, ..sun(DVec3::new(x, -0.8, z).normalize()) };
    let point = |x, z, color| {
        let kind = LightKind::Point { position_world: DVec3::new(x, 3.0, z), range: Some(20.0) };
        Light { color, ..light(kind, 500.0) }
    };
    let spot = |x, z, color| {
        let position_world = DVec3::new(x, 4.0, z);
        let direction = (DVec3::new(-5.7, 0.0, 10.0) - position_world).normalize();
        let (range, inner_angle, outer_angle) = (Some(20.0), 0.5, 0.6);
        let kind = LightKind::Spot { position_world, direction, range, inner_angle, outer_angle };
        Light { color, ..light(kind, 9_000.0) }
    };
    match mix {
        "sun" => own[..1].to_vec(),
        "spots" => vec![spot(-9.0, 5.5, warm), spot(-1.5, 6.0, cool)],
        "points" => vec![point(-8.6, 6.8, warm), point(-2.0, 7.4, cool)],
        "several suns" => vec![sun_of(0.8, 0.3, warm), sun_of(-0.6, 0.6, cool), sun_of(0.1, 0.9, Vec3::ONE)],
        _ => Vec::new(),
    }
}

/// Adds panels 1.6 m wide and high, each of four stripes with alpha 1, 0.6, 0.4 and 0: opaque, clipped, dithered and blended.
fn add_panels(scene: &mut Scene) {
    let corners = [[-0.8, 0.0], [0.8, 0.0], [0.8, 1.6], [-0.8, 1.6]];
    let vertex = |[x, y]: [f32; 2]| Vertex {
        position: [x, y, 0.0],
        normal: [0.0, 0.0, 1.0],
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv0: [x / 1.6 + 0.5, y / 1.6],
        uv1: [0.0; 2],
        color: Vertex::WHITE,
    };
    let alpha = |x: u32| [255, 153, 102, 0][x as usize / 16];
    let rgba8 = (0..64 * 64).flat_map(|i| [220, 60, 40, alpha(i % 64)]).collect();
    let stripes = Image::new("stripes", 64, 64, rgba8);
    let image = scene.insert_image(stripes).unwrap();
    let mesh = scene.insert_mesh(Mesh::new("panel", corners.map(vertex).to_vec(), vec![0, 1, 2, 0, 2, 3]));
    let kinds = [
        (AlphaMode::Opaque, None),
        (AlphaMode::Mask { cutoff: 0.5 }, None),
        (AlphaMode::Mask { cutoff: 0.5 }, Some(CasterMode::Dither)),
        (AlphaMode::Blend, None),
    ];
    for (x, (alpha, casts)) in [-9.0, -6.8, -4.6, -2.4].into_iter().zip(kinds) {
        let panel = Material {
            name: "panel".into(),
            base_color: Vec4::ONE,
            metallic: 0.0,
            alpha,
            casts,
            double_sided: true,
            base_color_texture: Some(TextureRef::new(image)),
            ..Material::default()
        };
        let material = scene.insert_material(panel).unwrap();
        let world_from_local =
            DAffine3::from_translation(DVec3::new(x, 0.0, 9.5)) * DAffine3::from_rotation_y(0.3);
        scene.insert_instance(Instance::new(mesh, material, world_from_local).with_name("panel")).unwrap();
    }
}

/// Returns the fractions of the pixels that are darker and lighter than the reference by more than a sixth of white.
fn differing(image: &RenderedImage, truth: &RenderedImage) -> (f64, f64) {
    let luma = |rgba: &[u8]| rgba[..3].iter().map(|&byte| i32::from(byte)).sum::<i32>() / 3;
    let pairs = image.rgba8.chunks_exact(4).zip(truth.rgba8.chunks_exact(4));
    let by: Vec<i32> = pairs.map(|(a, b)| luma(a) - luma(b)).collect();
    let part = |is: &dyn Fn(i32) -> bool| by.iter().filter(|by| is(**by)).count() as f64 / by.len() as f64;
    (part(&|by| by < -42), part(&|by| by > 42))
}

struct Sheet(RgbaImage);

impl Sheet {
    fn new() -> Self {
        let count = [MIXES.len() as u32, configs().len() as u32];
        let [width, height] = [0, 1].map(|axis| count[axis] * (CELL_PX[axis] + GAP_PX));
        Self(RgbaImage::from_pixel(width, height, Rgba([255; 4])))
    }

    fn paste(&mut self, image: &RenderedImage, column: usize, row: usize) {
        let [left, top] = [column as u32 * (CELL_PX[0] + GAP_PX), row as u32 * (CELL_PX[1] + GAP_PX)];
        for (x, y) in (0..CELL_PX[1]).flat_map(|y| (0..CELL_PX[0]).map(move |x| (x, y))) {
            self.0.put_pixel(left + x, top + y, Rgba(image.pixel(x, y).unwrap()));
        }
    }
}
