#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::collections::BTreeSet;

use super::*;

/// Returns the triangles of all instances.
fn drawn_triangles(scene: &Scene) -> usize {
    let triangles = |key| scene.mesh(key).unwrap().indices.len() / 3;
    scene.instances().map(|(_, instance)| triangles(instance.mesh)).sum()
}

#[test]
fn a_city_has_the_requested_instances_and_a_million_triangles_or_more() {
    for instances in [10_000, 100_000] {
        let scene = city(instances, 1).unwrap();
        assert_eq!(scene.instances().len(), instances as usize);
        let triangles = drawn_triangles(&scene);
        assert!((1_000_000..=20_000_000).contains(&triangles), "{instances}: {triangles}");
    }
}

#[test]
fn the_largest_city_stays_below_twenty_million_triangles() {
    let scene = city(1_000_000, 1).unwrap();
    assert_eq!(scene.instances().len(), 1_000_000);
    let triangles = drawn_triangles(&scene);
    assert!((10_000_000..=20_000_000).contains(&triangles), "{triangles}");
}

#[test]
fn sixty_four_street_lights_cast_shadows_and_there_are_at_most_a_thousand() {
    let scene = city(100_000, 1).unwrap();
    let street_lights: Vec<&Light> =
        scene.lights().iter().filter(|light| light.name.as_deref() != Some("sun")).collect();
    assert_eq!(street_lights.len(), 1_000);
    assert_eq!(street_lights.iter().filter(|light| light.casts_shadow).count(), 64);
}

#[test]
fn the_same_seed_gives_the_same_city_and_another_seed_another() {
    let transforms = |seed| -> Vec<glam::DAffine3> {
        city(10_000, seed).unwrap().instances().map(|(_, instance)| instance.world_from_local).collect()
    };
    assert!(transforms(3) == transforms(3));
    assert!(transforms(3) != transforms(4));
}

#[test]
fn blocks_fill_ring_after_ring_without_gaps() {
    let cells: BTreeSet<[i32; 2]> = (0..49).map(ring_cell).collect();
    let expected = (-3..=3).flat_map(|x| (-3..=3).map(move |z| [x, z])).collect();
    assert_eq!(cells, expected);
    assert!((0..9).all(|index| ring_cell(index).iter().all(|along| along.abs() <= 1)));
}

#[test]
fn cars_drive_forwards_on_the_roadway_and_return_to_where_they_began() {
    let mut scene = city(10_000, 1).unwrap();
    let cars: Vec<_> = scene.hierarchy.instances.iter().map(|attachment| attachment.object).collect();
    assert!(cars.len() >= 30, "{}", cars.len());
    let mut pose = |time_s: f64| -> Vec<glam::DAffine3> {
        scene.set_time(shadowgraph_scene::AnimationSelection::All, time_s).unwrap();
        cars.iter().map(|&car| scene.instance(car).unwrap().world_from_local).collect()
    };
    let start = pose(0.0);
    let end = pose(30.0);
    assert!(start.iter().zip(&end).all(|(a, b)| a.abs_diff_eq(*b, 1e-3)));
    for step in 0..120 {
        let time_s = f64::from(step) * 0.25;
        let (before, after) = (pose(time_s), pose(time_s + 0.05));
        for (before, after) in before.iter().zip(&after) {
            let moved = after.translation - before.translation;
            let forwards = before.transform_vector3(DVec3::Z);
            assert!(moved.normalize().dot(forwards) > 0.6, "{time_s} s: {moved} {forwards}");
            let from_street = |along: f64| (along.rem_euclid(PITCH_M) - PITCH_M * 0.5).abs();
            // Between kerb and centre line of one of the two streets.
            let lateral =
                [before.translation.x, before.translation.z].map(from_street).into_iter().fold(0.0, f64::max);
            assert!(lateral > BLOCK_M * 0.5 + 1.0, "{time_s} s: {}", before.translation);
        }
    }
}
