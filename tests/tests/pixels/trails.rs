//! Temporal anti-aliasing behind a fast object.

use glam::{DAffine3, DVec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::pipelines::Parameters;
use shadowgraph::scene::{Material, Mesh, Scene};
use shadowgraph::{Gpu, Pipeline, Registry, RenderedFrame, RenderedImage, Renderer, ViewOptions};

use crate::stage::{CUBE_MAX, CUBE_MIN, box_mesh, camera, gpu, vertex};

const SIZE_PX: [u32; 2] = [160, 90];
/// Frames of an object's flight; it moves by 8 pixels a frame.
const FRAMES: u32 = 20;
const STEP_M: f64 = 0.52;

/// Returns `forward` with temporal anti-aliasing; `velocity` is the producer of motion vectors, or empty.
fn pipeline(velocity: &str) -> Pipeline {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("temporal.ron");
    let velocity =
        if velocity.is_empty() { String::new() } else { format!(", \"velocity\": \"{velocity}\"") };
    let text = format!(
        "(nodes: [
            (name: \"view\", kind: \"view\", settings: {{\"jitter\": true}}),
            (name: \"geometry\", kind: \"geometry\", inputs: {{\"view\": \"view\"}}),
            (name: \"shadows\", kind: \"shadows\", inputs: {{\"surfaces\": \"geometry\"}}),
            (name: \"lighting\", kind: \"forward\", inputs: {{\"view\": \"view\", \"shadows\": \"shadows\", \"depth\": \"geometry\"}}),
            (name: \"taa\", kind: \"taa\", inputs: {{\"view\": \"view\", \"depth\": \"geometry\", \"light\": \"lighting\"{velocity}}}),
            (name: \"tonemap\", kind: \"tonemap\", inputs: {{\"light\": \"taa\"}}),
        ], outputs: {{\"image\": \"tonemap\"}})"
    );
    std::fs::write(&file, text).unwrap();
    let Registry { nodes, techniques } = Registry::built_in();
    Pipeline::load(&file, &nodes, &techniques, &Parameters::default()).unwrap()
}

/// Returns a wall at z = -2 of tiles of 0.1 m (1.2 pixels) with colours at random.
fn wall() -> Mesh {
    let (mut vertices, mut indices, mut state) = (Vec::new(), Vec::new(), 1u32);
    for (column, row) in (-80..80).flat_map(|column| (-45..45).map(move |row| (column, row))) {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let shade = 90 + (state >> 27) as u8;
        let base = vertices.len() as u32;
        for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let at = DVec3::new(f64::from(column + x) * 0.1, f64::from(row + y) * 0.1, -2.0);
            let mut corner = vertex(at, [0.0, 0.0, 1.0]);
            corner.color = [shade, shade, 255 - shade, 255].map(|channel| u16::from(channel) * 257);
            vertices.push(corner);
        }
        indices.extend([0, 1, 2, 0, 2, 3].map(|index| base + index));
    }
    Mesh::new("wall", vertices, indices)
}

/// Where the object is in a frame.
fn object_at(frame: u32) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(STEP_M * (f64::from(frame) - 10.0), -0.5, 0.0))
}

/// Draws the flight of a red cube in front of the wall, and returns the last frame.
fn fly(gpu: &Gpu, pipeline: &Pipeline, is_visible: bool) -> RenderedFrame {
    let mut scene = Scene::default();
    let unlit = |base_color| Material { base_color, unlit: true, ..Material::default() };
    scene.add(wall(), unlit(Vec4::ONE), DAffine3::IDENTITY).unwrap();
    let cube = box_mesh(CUBE_MIN, CUBE_MAX);
    let object = scene.add(cube, unlit(Vec4::new(1.0, 0.05, 0.02, 1.0)), object_at(0)).unwrap();
    scene.edit_instance(object, |object| object.visible = is_visible).unwrap();
    let camera = camera(DVec3::new(0.0, 0.0, 6.0), DVec3::ZERO);
    let options = ViewOptions { camera, size_px: SIZE_PX, shadows: Default::default() };
    let mut renderer =
        Renderer::with_config(gpu, scene, &options.camera, Aov::Color, pipeline.clone()).unwrap();
    let mut draw = |frame| {
        renderer.scene_mut().move_instance(object, object_at(frame)).unwrap();
        renderer.draw(gpu, &options).unwrap()
    };
    // The wall is smooth before the object flies.
    (0..16).for_each(|_| drop(draw(0)));
    (1..FRAMES - 1).for_each(|frame| drop(draw(frame)));
    draw(FRAMES - 1)
}

/// Returns the columns that the object covers in a frame, with two pixels around it.
fn covered(frame: u32) -> std::ops::Range<f64> {
    let center = object_at(frame).translation.x;
    // The front face is the largest.
    let px_per_m = f64::from(SIZE_PX[1]) / (2.0 * 5.5 * 0.45f64.tan());
    let to_px = |x: f64| f64::from(SIZE_PX[0]) / 2.0 + x * px_per_m;
    to_px(center - 0.5) - 2.0..to_px(center + 0.5) + 2.0
}

/// Returns the largest difference of two images, of 255, where the object has left at least 8 frames ago.
fn trail(one: &RenderedImage, other: &RenderedImage) -> u8 {
    let last = FRAMES - 1;
    let mut worst = 0;
    for x in 0..SIZE_PX[0] {
        let at = f64::from(x) + 0.5;
        let was = (0..=last - 8).any(|frame| covered(frame).contains(&at));
        if !was || (last - 7..=last).any(|frame| covered(frame).contains(&at)) {
            continue;
        }
        for y in 0..SIZE_PX[1] {
            let pixels = [one, other].map(|image| image.pixel(x, y).unwrap());
            worst = worst.max((0..3).map(|i| pixels[0][i].abs_diff(pixels[1][i])).max().unwrap());
        }
    }
    worst
}

#[test]
fn a_fast_object_leaves_no_trail_with_velocity_and_leaves_one_without() {
    let Some(gpu) = gpu() else { return };
    let [without, with] = ["", "geometry"].map(|velocity| {
        let pipeline = pipeline(velocity);
        let [visible, hidden] = [true, false].map(|is_visible| fly(gpu, &pipeline, is_visible));
        let passes = visible.plan.order().iter().map(|&pass| visible.plan.pass_path(pass).to_string());
        // Motion vectors are computed only where a node reads them.
        assert_eq!(passes.filter(|path| path.ends_with("velocity")).count() > 0, !velocity.is_empty());
        trail(&visible.image, &hidden.image)
    });
    println!("trail without velocity {without}, with it {with}, of 255");
    assert!(without > 4 && with <= 4, "{without} and {with}");
}
