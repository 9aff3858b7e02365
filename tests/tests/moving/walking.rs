//! Maps that scroll with the camera: the maps of a walk are those of a fresh start, but for rounding.

use crate::boxes::Boxes;
use crate::maps::{Drawn, Frames, View, camera, notes, sun};
use crate::{frames, gpu};
use glam::DVec3;
use shadowgraph::scene::Aabb;
use shadowgraph::shadows::{CullSettings, Mobility, ShadowSettings};
use shadowgraph_tests::random::Random;

/// Depth by which a texel may differ: rounding in f32 of positions some hundred metres from the origin.
const ROUNDING: f32 = 2e-6;

/// Returns the numbers of texels of the cascades and of those that differ.
fn different_texels(with: &Drawn, without: &Drawn) -> (usize, usize) {
    let depths = |drawn: &Drawn| -> Vec<f32> {
        drawn.bytes[0].chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
    };
    let (with, without) = (depths(with), depths(without));
    assert_eq!(with.len(), without.len());
    let differ = with.iter().zip(&without).filter(|(a, b)| (*a - *b).abs() > ROUNDING).count();
    (with.len(), differ)
}

#[test]
fn maps_that_scroll_are_those_of_a_fresh_start_but_for_rounding_and_it_never_adds_up() {
    let Some(gpu) = gpu() else { return };
    let random = &mut Random::new(7);
    let mut boxes = Boxes::new(&gpu.device, 300);
    for index in 0..300 {
        let min = DVec3::new(random.between(-40.0, 40.0), 0.0, random.between(-90.0, 20.0));
        let size = DVec3::new(random.between(0.3, 3.0), random.between(0.3, 6.0), random.between(0.3, 3.0));
        let mobility = if index % 50 == 0 { Mobility::Moving } else { Mobility::Static };
        boxes.add(Aabb { min, max: min + size }, mobility);
    }
    let mut settings =
        ShadowSettings { cull: CullSettings::NONE, distance_m: 60.0, ..ShadowSettings::default() };
    settings.cascades.map_size_px = 512;
    let [mut kept, mut drawn] = [(); 2].map(|()| Frames::new(&gpu.device, &gpu.queue));
    let (mut texels, mut halves, mut scrolled) = (0, [0; 2], 0);
    // With fewer, single texels decide.
    let count = frames().max(120);
    let mut eye = DVec3::new(0.0, 1.7, 10.0);
    let mut heading = 0.0;
    for frame in 0..count {
        heading += random.between(-0.03, 0.03);
        let ahead = DVec3::new(f64::sin(heading), 0.0, -f64::cos(heading));
        eye += ahead * (1.4 / 60.0 * random.between(0.0, 3.0)) + DVec3::Y * random.between(-0.01, 0.01);
        for index in (0..300).step_by(50).filter(|_| frame % 3 == 0) {
            boxes.shift(index, DVec3::new(random.between(-0.1, 0.1), 0.0, 0.1));
        }
        let mut view = View {
            camera: camera(eye, eye + ahead - DVec3::Y * 0.1),
            lights: vec![sun(DVec3::new(0.4, -1.0, 0.3))],
            settings: settings.clone(),
        };
        let with = kept.draw(&boxes, &view, true);
        view.settings.cascades.cache = false;
        let without = drawn.draw(&boxes, &view, true);
        scrolled += notes(&with.plan, "cascades").iter().filter(|note| note.contains("came in")).count();
        let (all, differ) = different_texels(&with, &without);
        texels += all;
        halves[usize::from(frame >= count / 2)] += differ;
    }
    println!("{} and {} of {texels} texels differ; {scrolled} tiles scrolled", halves[0], halves[1]);
    assert!(scrolled as u64 > count, "{scrolled} tiles scrolled in {count} frames");
    // An edge may move by a texel where a vertex is rounded.
    assert!((halves[0] + halves[1]) * 10_000 <= texels, "{halves:?} of {texels} texels differ");
    assert!(halves[1] <= 2 * halves[0] + texels / 200_000, "{halves:?} of {texels} texels differ");
}
