#![allow(clippy::print_stdout, reason = "prints measured shares")]

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use proptest::prelude::*;
use shadowgraph_scene::{Aabb, Camera, ConvexVolume, Projection};

use super::super::random::{Random, View, cases, minimum, randoms};
use super::super::{LightSpaceView, ReceiverHull};

/// Returns the depth of the point inside the volume, metres: its least distance from a plane.
fn depth_in(volume: &ConvexVolume, point: DVec3) -> f64 {
    volume.planes.iter().map(|plane| plane.signed_distance(point)).fold(f64::INFINITY, f64::min)
}

fn rounding_m(points: &[DVec3]) -> f64 {
    1e-12 * points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn casters_with_shadows_in_the_view_are_inside(mut random in randoms()) {
        let distance_m = random.magnitude(0.0, 6.0);
        let view = random.view(distance_m);
        let to_light = random.light_direction(&view);
        let pad_m = if random.below(2) == 0 { 0.0 } else { random.magnitude(-3.0, 2.0) };
        let volume = view.hull().swept_towards(to_light, pad_m);
        prop_assert!(volume.planes.iter().all(|plane| plane.normal.is_normalized()));
        for _ in 0..20 {
            let t = if random.below(4) == 0 { 0.0 } else { random.magnitude(-2.0, 5.0) };
            let receiver = random.visible(&view);
            let caster = receiver + to_light * t;
            let inside_m = depth_in(&volume, caster);
            prop_assert!(inside_m >= pad_m - rounding_m(&[caster, receiver]), "{inside_m} < {pad_m}, t {t}");
            if t < 1e3 {
                let near = caster + random.unit() * pad_m;
                prop_assert!(volume.contains_point(near));
            }
        }
    }

    #[test]
    fn casters_between_a_light_and_the_view_are_inside(mut random in randoms()) {
        let distance_m = random.magnitude(0.0, 6.0);
        let view = random.view(distance_m);
        let light = light_position(&mut random, &view);
        let pad_m = if random.below(2) == 0 { 0.0 } else { random.magnitude(-3.0, 2.0) };
        let volume = view.hull().hull_with(light, pad_m);
        prop_assert!(volume.planes.iter().all(|plane| plane.normal.is_normalized()));
        for _ in 0..20 {
            let receiver = random.visible(&view);
            let caster = receiver.lerp(light, random.fraction_or_end());
            let inside_m = depth_in(&volume, caster);
            prop_assert!(inside_m >= pad_m - rounding_m(&[caster, receiver, light]), "{inside_m} < {pad_m}");
            prop_assert!(volume.contains_point(caster + random.unit() * pad_m));
        }
    }

    #[test]
    fn with_a_light_in_the_view_the_volume_is_the_view(mut random in randoms()) {
        let view = random.view(100.0);
        let light = view.point((random.cube() * 0.49) + 0.5);
        let volume = view.hull().hull_with(light, 0.5);
        let hull = view.hull();
        for plane in &volume.planes {
            let is_face = hull.faces().iter().any(|face| face.normal.abs_diff_eq(plane.normal, 1e-5));
            prop_assert!(is_face, "{plane:?}");
        }
    }

    #[test]
    fn flat_hulls_are_swept_too(mut random in randoms()) {
        // Flat along any axis, lines and points, with lights along and across them.
        let size = DVec3::from_array(std::array::from_fn(|_| [0.0, 0.0, 1e-9, 5.0][random.below(4) as usize]));
        let middle = random.cube() * 1e3;
        let bounds = Aabb { min: middle - size, max: middle + size };
        let hull = ReceiverHull::from_box(&bounds);
        let to_light = if random.below(2) == 0 { DVec3::AXES[random.below(3) as usize] } else { random.unit() };
        let light = middle + random.cube() * 50.0 * DVec3::from(bounds.min.cmplt(bounds.max));
        let (swept, with) = (hull.swept_towards(to_light, 0.25), hull.hull_with(light, 0.25));
        for _ in 0..20 {
            let receiver = middle + random.cube() * size;
            let near = random.unit() * 0.25;
            prop_assert!(swept.contains_point(receiver + to_light * random.magnitude(-2.0, 3.0) + near));
            prop_assert!(with.contains_point(receiver.lerp(light, random.fraction_or_end()) + near));
        }
    }
}

/// Returns a light position: anywhere, in the view, on its boundary, on the plane of a face, or on the line of an edge.
fn light_position(random: &mut Random, view: &View) -> DVec3 {
    let (a, b, c) = (random.visible(view), random.visible(view), random.visible(view));
    let hull = view.hull();
    let corner = |random: &mut Random| hull.corners()[random.below(8) as usize];
    match random.below(6) {
        0 => a,
        1 => corner(random),
        2 => a + (b - a) * random.range(-3.0, 3.0) + (c - a) * random.range(-3.0, 3.0),
        3 => corner(random).lerp(corner(random), random.range(-2.0, 2.0)),
        4 => view.camera.position_world(),
        _ => a + random.unit() * view.far_m * random.magnitude(-2.0, 2.0),
    }
}

/// A volume and points with their distances from what it should contain, metres.
struct Sample {
    far_m: f64,
    pad_m: f64,
    volume: ConvexVolume,
    points: Vec<(DVec3, f64)>,
}

/// Samples views whose near plane is large enough for the precision of the reference.
fn samples(padded: bool, mut sample: impl FnMut(&mut Random, &View, f64) -> Sample) -> Vec<Sample> {
    let mut random = Random(7);
    let mut next = || loop {
        let view = random.view(100.0);
        if view.near_m > 1e-2 && view.far_m > 5.0 {
            let pad_m = if padded { view.far_m * random.magnitude(-4.0, -2.0) } else { 0.0 };
            return sample(&mut random, &view, pad_m);
        }
    };
    (0..300).map(|_| next()).collect()
}

/// Prints and returns the share of points outside the volumes among those that are at least `distance` away.
fn share_culled(name: &str, samples: &[Sample], distance: impl Fn(&Sample) -> f64) -> f64 {
    let (mut out, mut all) = (0u32, 0u32);
    for sample in samples {
        for (point, _) in sample.points.iter().filter(|(_, distance_m)| *distance_m > distance(sample)) {
            all += 1;
            out += u32::from(!sample.volume.contains_point(*point));
        }
    }
    let share = f64::from(out) / f64::from(all);
    println!("{name}: {:.3} % of {all}", 100.0 * share);
    share
}

/// Returns a distance: mostly a few pads, or a small fraction of the view.
fn offset_m(random: &mut Random, view: &View, pad_m: f64) -> f64 {
    if pad_m > 0.0 && random.below(4) > 0 {
        pad_m * random.magnitude(0.2, 1.5)
    } else {
        view.far_m * random.magnitude(-5.0, 0.5)
    }
}

fn check_tightness(name: &str, sample: impl Fn(&mut Random, &View, f64) -> Sample) {
    let bare = samples(false, &sample);
    let bare = share_culled(&format!("{name}, a millionth of the view away"), &bare, |s| s.far_m * 1e-6);
    assert!(bare > 0.999);
    let padded = samples(true, &sample);
    let near = share_culled(&format!("{name}, 2 pads away"), &padded, |s| s.pad_m * 2.0);
    let farther = share_culled(&format!("{name}, 5 pads away"), &padded, |s| s.pad_m * 5.0);
    assert!(near > 0.98 && farther > 0.999, "{near} {farther}");
}

#[test]
fn points_well_outside_the_swept_view_are_outside_the_volume() {
    check_tightness("swept", |random, view, pad_m| {
        let to_light = random.light_direction(view);
        let volume = view.hull().swept_towards(to_light, pad_m);
        let points = (0..40).map(|_| {
            let t = random.magnitude(-2.0, 3.0);
            let offset_m = offset_m(random, view, pad_m);
            let point = random.visible(view) + to_light * t + random.unit() * offset_m;
            // The least distance of the light's path from here to the view.
            let length_m = (point - view.camera.position_world()).length() + 400.0 * view.far_m;
            (point, minimum(0.0, length_m, |t| view.distance(point - to_light * t)))
        });
        let points = points.collect();
        Sample { far_m: view.far_m, pad_m, volume, points }
    });
}

#[test]
fn points_well_outside_view_and_light_are_outside_the_volume() {
    check_tightness("view and light", |random, view, pad_m| {
        let light = light_position(random, view);
        let volume = view.hull().hull_with(light, pad_m);
        let points = (0..40).map(|_| {
            let offset_m = offset_m(random, view, pad_m);
            let point = random.visible(view).lerp(light, random.fraction()) + random.unit() * offset_m;
            // The distance of the point from the view shrunk towards the light, at each scale.
            let shrunk = |scale: f64| scale * view.distance(light + (point - light) / scale);
            (point, minimum(1e-9, 1.0, shrunk))
        });
        let points = points.collect();
        Sample { far_m: view.far_m, pad_m, volume, points }
    });
}

#[test]
fn without_a_valid_direction_or_position_the_volume_is_the_whole_space() {
    let hull = ReceiverHull::from_box(&Aabb { min: DVec3::ZERO, max: DVec3::ONE });
    for invalid in [DVec3::ZERO, DVec3::NAN, DVec3::new(f64::INFINITY, 0.0, 0.0)] {
        assert_eq!(hull.swept_towards(invalid, 0.0), ConvexVolume::default());
    }
    for invalid in [DVec3::NAN, DVec3::new(f64::INFINITY, 0.0, 0.0)] {
        assert_eq!(hull.hull_with(invalid, 0.0), ConvexVolume::default());
    }
    let invalid = ReceiverHull::new([DVec3::NAN; 8]);
    assert_eq!(invalid.swept_towards(DVec3::Y, 0.0), ConvexVolume::default());
    assert_eq!(invalid.hull_with(DVec3::Y, 0.0), ConvexVolume::default());
}

#[test]
fn a_tiny_near_plane_far_from_the_origin_is_swept() {
    let projection = Projection::Perspective { fov_y: 0.2, near: 1e-4, far: None };
    let eye = DVec3::new(1e6, -1e6, 1e6);
    let camera = Camera::look_at(eye, eye + DVec3::new(1.0, -0.3, 0.2), DVec3::Y, projection);
    let view = View { camera, aspect: 1.7, near_m: 1e-4, far_m: 1e4 };
    let volume = view.hull().swept_towards(DVec3::Y, 0.0);
    assert!(volume.contains_point(eye + DVec3::Y * 1e3 + view.camera.forward_world()));
    assert!(!volume.contains_point(eye + DVec3::Y * 1e3 - view.camera.forward_world()));
    assert!(!volume.contains_point(eye - DVec3::Y * 1e3 + view.camera.forward_world()));
}

#[test]
fn timing_of_ten_thousand_casters() {
    let mut random = Random(1);
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
    let camera = Camera::look_at(DVec3::Y * 2.0, DVec3::new(1.0, 1.8, -3.0), DVec3::Y, projection);
    let to_light = DVec3::new(0.5, 0.7, 0.2).normalize();
    let casters: Vec<Aabb> = (0..10_000)
        .map(|_| {
            let at = random.cube() * DVec3::new(150.0, 5.0, 150.0);
            Aabb { min: at - 0.5, max: at + 0.5 }
        })
        .collect();
    let start = Instant::now();
    let mut planes = 0;
    for round in 0..100 {
        let view = ReceiverHull::from_view(&camera, 1.7, 0.1, 150.0 + f64::from(round));
        planes += black_box(view.swept_towards(to_light, 0.1)).planes.len();
    }
    let one = start.elapsed() / 100;
    let start = Instant::now();
    for round in 0..100 {
        let view = ReceiverHull::from_view(&camera, 1.7, 0.1, 150.0 + f64::from(round));
        black_box(LightSpaceView::new(&view, random.axes(to_light)));
    }
    let prepared = start.elapsed() / 100;
    let view = ReceiverHull::from_view(&camera, 1.7, 0.1, 150.0);
    let start = Instant::now();
    let mut kept = 0;
    for cascade in 0..4 {
        let volume = view.swept_towards(to_light, 0.1 * f64::from(cascade));
        kept += casters.iter().filter(|caster| volume.intersects(caster)).count();
    }
    println!(
        "a swept volume ({} planes) {one:.1?}, a light-space view {prepared:.1?}; 4 x 10000 casters {:.2?}, {kept} kept",
        planes / 100,
        start.elapsed()
    );
    assert!(kept > 0 && kept < 40_000);
}
