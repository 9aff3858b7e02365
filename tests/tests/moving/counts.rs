//! What a frame costs, counted. Nothing is drawn: the device does nothing.

use crate::boxes::Boxes;
use crate::maps::{Frames, View, camera, notes, sun};
use glam::DVec3;
use shadowgraph::scene::Aabb;
use shadowgraph::shadows::{Mobility, ShadowSettings};
use shadowgraph::wgpu;
use shadowgraph_tests::random::Random;

/// Returns a field of boxes; the first, which moves, stands in front of the camera.
fn field(device: &wgpu::Device, count: usize, half_m: f64) -> Boxes {
    let mut boxes = Boxes::new(device, count);
    let mut random = Random::new(1);
    boxes.add(Aabb { min: DVec3::new(-1.0, 0.0, -1.0), max: DVec3::new(1.0, 2.0, 1.0) }, Mobility::Moving);
    for _ in 1..count {
        let min = DVec3::new(random.between(-half_m, half_m), 0.0, random.between(-half_m, half_m));
        let size = DVec3::new(0.5, random.between(0.5, 3.0), 0.5);
        boxes.add(Aabb { min, max: min + size }, Mobility::Static);
    }
    boxes
}

fn view(eye: DVec3) -> View {
    let target = eye + DVec3::new(0.3, -0.15, -1.0);
    let lights = vec![sun(DVec3::new(0.4, -1.0, 0.3))];
    View { camera: camera(eye, target), lights, settings: ShadowSettings::default() }
}

fn device() -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor::default())
}

#[test]
fn one_moving_caster_among_10_000_costs_at_most_a_fiftieth_of_the_draws_of_a_redraw() {
    let (device, queue) = device();
    let mut boxes = field(&device, 10_000, 60.0);
    let view = view(DVec3::new(0.0, 3.0, 8.0));
    let mut frames = Frames::new(&device, &queue);
    frames.draw(&boxes, &view, false);
    let redraw = boxes.take_drawn();
    assert!(redraw > 3_000, "{redraw} draws");
    for step in 0..4 {
        boxes.shift(0, DVec3::X * 0.1);
        let drawn = frames.draw(&boxes, &view, false);
        let draws = boxes.take_drawn();
        let said = notes(&drawn.plan, "cascades");
        // The first step draws the static casters apart.
        if step > 0 {
            println!("{draws} of {redraw} draws; {said:?}");
            assert!(draws > 0 && draws * 50 <= redraw, "{draws} of {redraw} draws");
            assert!(said.iter().any(|note| note.ends_with("unchanged; drawn: `Fox` moved")), "{said:?}");
        }
    }
    let drawn = frames.draw(&boxes, &view, false);
    assert_eq!(boxes.take_drawn(), 0);
    assert!(notes(&drawn.plan, "cascades").iter().all(|note| note.contains(" kept: ")));
}

#[test]
fn a_still_world_draws_no_shadow_pass() {
    let (device, queue) = device();
    let boxes = field(&device, 200, 20.0);
    let view = view(DVec3::new(0.0, 3.0, 8.0));
    let mut frames = Frames::new(&device, &queue);
    let passes: Vec<_> = (0..3).map(|_| frames.draw(&boxes, &view, false).plan.order().len()).collect();
    assert!(passes[0] > 0 && passes[1..] == [0, 0], "{passes:?}");
}

/// Returns the fraction of its texels into which static casters are drawn, by what the plan says about a tile.
pub(crate) fn redrawn(note: &str, tile_px: u32) -> f64 {
    if note.contains(" drawn: ") && !note.contains(" kept: ") || note.contains(" stored: ") {
        return 1.0;
    }
    let texels = note.split_once(" of ").and_then(|(_, rest)| rest.split_once(" texels that came in"));
    texels.map_or(0.0, |(texels, _)| texels.parse::<f64>().unwrap() / f64::from(tile_px * tile_px))
}

/// Walks for ten seconds, 60 frames each, along a bend, with the head going up and down, and returns the mean fraction of the
/// cascades' texels into which static casters are drawn.
fn walk(distance_m: f32, receivers_half_m: f64) -> f64 {
    let (device, queue) = device();
    let mut boxes = field(&device, 400, 100.0);
    boxes.receivers = Aabb { min: DVec3::splat(-receivers_half_m), max: DVec3::splat(receivers_half_m) };
    let mut frames = Frames::new(&device, &queue);
    let count = 600;
    let mut sum = 0.0;
    for frame in 0..count {
        let seconds = f64::from(frame) / 60.0;
        let heading = 0.6 * (0.5 * seconds).sin();
        let bob_m = 0.03 * (12.0 * seconds).sin();
        let eye = DVec3::new(2.0 * (0.3 * seconds).sin(), 1.7 + bob_m, 8.0 - 1.4 * seconds);
        let mut view = view(eye);
        view.camera = camera(eye, eye + DVec3::new(heading.sin(), -0.1, -heading.cos()));
        view.settings.distance_m = distance_m;
        let drawn = frames.draw(&boxes, &view, false);
        let said = notes(&drawn.plan, "cascades");
        assert!((3..=4).contains(&said.len()), "{said:?}");
        let tile_px = view.settings.cascades.map_size_px / 2;
        sum += said.iter().map(|note| redrawn(note, tile_px)).sum::<f64>() / 4.0;
    }
    sum / f64::from(count)
}

#[test]
fn a_camera_that_walks_redraws_at_most_a_tenth_of_the_texels_of_the_cascades() {
    for (distance_m, receivers_half_m) in [(150.0, 500.0), (1e5, 100.0)] {
        let fraction = walk(distance_m, receivers_half_m);
        println!("{:.2} % of the texels redrawn up to {distance_m} m", 100.0 * fraction);
        assert!(fraction > 0.0 && fraction <= 0.1, "{fraction} up to {distance_m} m");
    }
}
