//! Culling in a steady state allocates nothing.

use glam::DVec3;
use shadowgraph_scene::{Aabb, Camera, Projection};
use shadowgraph_scene::{BoundingSphere, Cone, CullTree, CullVolume};

fn boxes() -> Vec<Aabb> {
    let at = |i: u32| DVec3::new(f64::from(i % 100), 0.0, f64::from(i / 100));
    (0..10_000).map(|i| Aabb { min: at(i), max: at(i) + DVec3::ONE }).collect()
}

fn volumes() -> Vec<CullVolume> {
    let eye = DVec3::new(50.0, 2.0, 50.0);
    let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: Some(40.0) };
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection).frustum(1.5);
    let sphere = BoundingSphere { center_world: eye, radius_m: 30.0 };
    let cone = Cone { tip_world: eye, axis: DVec3::X, half_angle: 0.1, length_m: 8.0 };
    vec![
        camera.into(),
        CullVolume { sphere: Some(sphere), ..CullVolume::default() },
        CullVolume { cone: Some(cone), ..CullVolume::default() },
    ]
}

#[test]
fn a_query_into_a_list_with_capacity_and_a_refit_allocate_nothing() {
    let boxes = boxes();
    let mut tree = CullTree::new(&boxes);
    let volumes = volumes();
    let mut found = Vec::new();
    let mut hits = Vec::new();
    let frame = |tree: &mut CullTree, found: &mut Vec<u32>| {
        tree.refit((0u32..).zip(boxes.iter().copied()).step_by(7));
        volumes.iter().fold(0, |hits, volume| {
            found.clear();
            tree.query(volume, found);
            hits + found.len()
        })
    };
    hits.push(frame(&mut tree, &mut found));
    let mut again = 0;
    let counted = allocation_counter::measure(|| again = frame(&mut tree, &mut found));
    hits.push(again);
    assert_eq!(counted.count_total, 0);
    assert!(hits[0] > 1000 && hits[0] == hits[1], "{hits:?}");
}
