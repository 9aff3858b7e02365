use glam::{Vec2, Vec3};
use shadowgraph_shadows::rays::{
    Cutout, Error, Filter, GpuRayScene, MAX_DEPTH, Occluder, RayNode, RayScene, Surface, Wrap,
};

use crate::common::{cutout_square, level_square, ray, scene, sphere, texture};

#[test]
fn an_empty_scene_blocks_nothing() {
    let ray = ray(Vec3::ZERO, Vec3::Y);
    assert!(!scene(&[]).is_occluded(&ray) && scene(&[]).nearest_distance(&ray).is_none());
    assert_eq!(scene(&[]).max_coordinate_m(), 0.0);
}

#[test]
fn triangles_without_area_or_with_invalid_numbers_are_dropped_and_counted() {
    let mut occluders = level_square(1.0, 7.0);
    let [a, b, c] = occluders[0].corners;
    let cutout = Cutout { texture: None, uv: [Vec2::ZERO; 3], alpha: [1.0; 3], cutoff: f32::NAN };
    occluders.extend(
        [[a, a, b], [a, b, a.midpoint(b)], [a, b, Vec3::NAN], [a, b, c * 1e30]].map(Occluder::opaque),
    );
    occluders.push(Occluder { corners: [a, b, c], surface: Surface::Cutout(cutout) });
    let scene = scene(&occluders);
    assert_eq!((scene.dropped(), scene.triangles().len(), scene.max_coordinate_m()), (5, 2, 7.0));
}

#[test]
fn every_triangle_is_in_the_tree() {
    let occluders: Vec<Occluder> = sphere(3).into_iter().map(Occluder::opaque).collect();
    let scene = scene(&occluders);
    let mut sorted: Vec<_> = scene.triangles().iter().map(|t| format!("{:?}", t.corners())).collect();
    let mut given: Vec<_> = occluders.iter().map(|o| format!("{:?}", o.corners)).collect();
    sorted.sort();
    given.sort();
    assert_eq!(sorted, given);
}

#[test]
fn a_cutout_must_refer_to_an_existing_texture() {
    let occluders = [level_square(0.0, 1.0), cutout_square(1.0, 1.0, Some(1), 1.0)].concat();
    let one = texture([1, 1], &[0], Wrap::Repeat, Filter::Nearest);
    let error = RayScene::new(&occluders, vec![one]).err();
    assert_eq!(error, Some(Error::NoTexture { occluder: 2, texture: 1, count: 1 }));
}

#[test]
fn a_buffer_above_the_limit_is_an_error_with_name_and_size() {
    let big = texture([64, 64], &[0; 4096], Wrap::Repeat, Filter::Nearest);
    let scene = RayScene::new(&cutout_square(1.0, 1.0, Some(0), 1.0), vec![big]).unwrap();
    assert!(GpuRayScene::new(&scene, 4096).is_ok());
    let text = |limit| GpuRayScene::new(&scene, limit).unwrap_err().to_string();
    for (limit, start) in [
        (
            4095,
            "the texels of the ray scene need 4096 bytes; a storage buffer binding is limited to 4095: use sm",
        ),
        (95, "the nodes of the ray scene need 96 bytes; a storage buffer binding is limited to 95: remove"),
    ] {
        assert!(text(limit).starts_with(start), "{}", text(limit));
    }
}

/// Returns the depth of the tree in the buffers.
fn levels(gpu: &GpuRayScene, node: usize) -> usize {
    let RayNode { first, count, .. } = gpu.nodes[node];
    let below = |child: u32| levels(gpu, child as usize);
    1 + if count == 0 { below(first).max(below(first + 1)) } else { 0 }
}

#[test]
fn the_tree_is_never_deeper_than_the_stack() {
    let stacked: Vec<_> = level_square(1.0, 1.0).into_iter().cycle().take(50_000).collect();
    // Each is inside the next.
    let nested: Vec<_> = (0..2000).flat_map(|i| level_square(1.0, 1.004f32.powi(i))).collect();
    for (occluders, at) in [(stacked, 0.3), (nested, 2900.0)] {
        let scene = scene(&occluders);
        let gpu = GpuRayScene::new(&scene, 1 << 27).unwrap();
        assert!(levels(&gpu, 0) <= MAX_DEPTH);
        assert_eq!(scene.triangles().len(), occluders.len());
        for x in (0..50).map(|i| at * i as f32 * 0.02) {
            let up = ray(Vec3::new(x, 0.0, 0.1), Vec3::new(x, 1.0, 0.1));
            assert!(scene.nearest_distance(&up).is_some());
            assert_eq!(scene.nearest_distance(&up), scene.nearest_distance_brute_force(&up));
        }
    }
}
