use glam::Vec3;
use proptest::{prelude::*, strategy::ValueTree};
use shadowgraph_shadows::rays::{LightShape, Ray, ReceiverPoint, trace_hard};

use crate::common::{Occluder, scene};

const ROUNDING: f32 = 1.0 / (1 << 24) as f32;

/// A triangle, a point on it with an error like an interpolated one, and a direction to a light above it.
#[derive(Clone, Debug)]
struct Case {
    corners: [Vec3; 3],
    receiver: ReceiverPoint,
    to_light: Vec3,
}

fn vector(largest: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-largest..largest).prop_map(Vec3::from)
}

fn cases(largest: f32) -> impl Strategy<Value = Case> {
    let corners = prop::array::uniform3(vector(largest));
    let thinness = prop::sample::select(vec![0.0f32, 0.9, 0.999, 0.9999]);
    (corners, thinness, prop::array::uniform2(0f32..1.0), vector(1.0), 0.02f32..1.0, vector(1.0)).prop_map(
        |([a, b, c], thinness, [s, t], error, cosine, aside)| {
            let corners = [a, b, c.lerp(a.lerp(b, 0.3), thinness)];
            let [a, b, c] = corners.map(|corner| corner.as_dvec3());
            let normal = (b - a).cross(c - a).normalize().as_vec3();
            let [a, b, c] = corners;
            let (s, t) = (s * (1.0 - t), t);
            let position = a * (1.0 - s - t) + b * s + c * t;
            let position = position + error * 6.0 * ROUNDING * position.abs().max_element();
            let aside = aside.reject_from_normalized(normal).normalize_or_zero();
            let to_light = normal * cosine + aside * (1.0 - cosine * cosine).sqrt();
            let receiver = ReceiverPoint { position, geometric_normal: normal, view_distance_m: 0.0 };
            Case { corners, receiver, to_light: to_light.normalize() }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn no_surface_shadows_itself(largest in prop::sample::select(vec![1.0, 30.0, 1500.0]), seed in cases(1.0)) {
        let mut case = seed;
        case.corners = case.corners.map(|corner| corner * largest);
        case.receiver.position *= largest;
        let light = LightShape::Directional { to_light: case.to_light, angular_radius: 0.0 };
        let truth = trace_hard(&scene(&[Occluder::opaque(case.corners)]), &light, &case.receiver, true);
        prop_assert!(truth.faces_away || truth.visibility == Vec3::ONE, "{:?} {:?}", case, truth);
    }
}

#[test]
fn without_the_offset_surfaces_shadow_themselves() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let is_occluded = |case: Case| {
        let ray = Ray::new(case.receiver.position, case.to_light, 0.0, f32::INFINITY);
        scene(&[Occluder::opaque(case.corners)]).is_occluded(&ray)
    };
    let strategy = cases(1500.0);
    let shadowed =
        (0..500).filter(|_| is_occluded(strategy.new_tree(&mut runner).unwrap().current())).count();
    assert!(shadowed > 100, "{shadowed} of 500");
}

#[test]
fn the_offset_is_as_large_as_documented() {
    let offset = |position: f32, largest: f32, view_distance_m: f32| {
        let position = Vec3::new(0.0, -position, 0.0);
        ReceiverPoint { position, geometric_normal: Vec3::Y, view_distance_m }.offset_m(largest)
    };
    for (given, millimetres) in
        [((1500.0, 1500.0, 1500.0), 16.45), ((150.0, 150.0, 150.0), 1.645), ((10.0, 150.0, 10.0), 0.31)]
    {
        let offset = offset(given.0, given.1, given.2) * 1000.0;
        assert!((offset / millimetres - 1.0).abs() < 0.02, "{offset} {millimetres}");
    }
}
