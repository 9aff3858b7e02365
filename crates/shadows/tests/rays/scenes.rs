use glam::{DAffine3, DVec3, Vec2, Vec3};
use shadowgraph_shadows::rays::{
    Cutout, Error, Filter, GpuRayScene, Instance, RayScene, Surface, Tint, Wrap,
};

use crate::common::{Occluder, cutout_square, insert, level_square, ray, scene, texture};

#[test]
fn an_empty_scene_blocks_nothing() {
    let ray = ray(Vec3::ZERO, Vec3::Y);
    for empty in [RayScene::default(), scene(&[])] {
        assert!(!empty.is_occluded(&ray) && empty.nearest_distance(&ray).is_none());
        assert_eq!((empty.max_coordinate_m(), empty.triangle_count()), (0.0, 0));
    }
}

#[test]
fn triangles_without_area_or_with_invalid_numbers_are_not_hit() {
    let mut occluders = level_square(1.0, 7.0);
    let [a, b, c] = occluders[0].corners;
    occluders.extend(
        [[a, a, b], [a, b, a.midpoint(b)], [a, b, Vec3::NAN], [a, b, c * 1e30]].map(Occluder::opaque),
    );
    let scene = scene(&occluders);
    assert_eq!((scene.triangle_count(), scene.max_coordinate_m()), (2, 7.0));
}

#[test]
fn rays_pass_through_surfaces_with_invalid_numbers() {
    let (texture, uv) = (None, [Vec2::ZERO; 3]);
    let cutout = Cutout { texture, uv, alpha: [1.0; 3], cutoff: f32::NAN };
    let tint = Tint { texture, uv: [Vec2::NAN; 3], color: [glam::Vec4::ONE; 3], transmits: false };
    for surface in [Surface::Cutout(cutout), Surface::Tint(tint)] {
        let square: Vec<_> =
            level_square(1.0, 1.0).iter().map(|occluder| Occluder { surface, ..*occluder }).collect();
        let up = ray(Vec3::new(0.3, 0.0, 0.1), Vec3::new(0.3, 1.0, 0.1));
        assert_eq!(scene(&square).transmittance(&up), Vec3::ONE);
    }
}

#[test]
fn stale_keys_and_removal_of_what_is_used_are_errors_in_one_line() {
    let mut scene = RayScene::default();
    let alpha = scene.insert_texture(&[texture([1, 1], &[255], Wrap::Repeat, Filter::Nearest)]).unwrap();
    let square = cutout_square(1.0, 1.0, Some(alpha), 1.0);
    let corners: Vec<_> = square.iter().map(|occluder| occluder.corners).collect();
    let kinds: Vec<_> = square.iter().map(|occluder| occluder.surface).collect();
    let mesh = scene.insert_mesh(&corners).unwrap();
    let surfaces = scene.insert_surfaces(&kinds).unwrap();
    let placed = Instance { mesh, surfaces: Some(surfaces), world_from_mesh: DAffine3::IDENTITY };
    let instance = scene.insert_instance(placed).unwrap();
    let in_use = |what| Err(Error::InUse { what, users: 1 });
    assert_eq!(scene.remove_mesh(mesh), in_use("mesh"));
    assert_eq!(scene.remove_surfaces(surfaces), in_use("set of surfaces"));
    assert_eq!(scene.remove_texture(alpha), in_use("texture"));
    assert_eq!(scene.replace_mesh(mesh, &corners[1..]), Err(Error::Surfaces { count: 2, triangles: 1 }));
    assert!(scene.is_occluded(&ray(Vec3::ZERO, Vec3::new(0.1, 1.0, 0.2))));
    scene.remove_instance(instance).unwrap();
    scene.remove_surfaces(surfaces).unwrap();
    scene.remove_texture(alpha).unwrap();
    scene.remove_mesh(mesh).unwrap();
    assert!(!scene.is_occluded(&ray(Vec3::ZERO, Vec3::new(0.1, 1.0, 0.2))));
    let stale = |what| Err(Error::Stale { what });
    assert_eq!(scene.remove_mesh(mesh), stale("mesh"));
    assert_eq!(scene.replace_mesh(mesh, &corners), stale("mesh"));
    assert_eq!(scene.remove_surfaces(surfaces), stale("set of surfaces"));
    assert_eq!(scene.remove_texture(alpha), stale("texture"));
    assert_eq!(scene.remove_instance(instance), stale("instance"));
    assert_eq!(scene.set_transform(instance, DAffine3::IDENTITY), stale("instance"));
    assert_eq!(scene.insert_instance(placed).map(drop), stale("mesh"));
    assert_eq!(scene.insert_surfaces(&kinds).map(drop), stale("texture"));
    assert_eq!(Error::Stale { what: "mesh" }.to_string().lines().count(), 1);
}

#[test]
fn a_buffer_above_the_limit_is_an_error_with_name_and_size() {
    let limits = wgpu::Limits { max_storage_buffer_binding_size: 4096, ..wgpu::Limits::default() };
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = wgpu::Device::noop(&descriptor);
    let mut scene = scene(&level_square(1.0, 1.0));
    let mut gpu = GpuRayScene::new(&device);
    assert!(gpu.update(&queue, &mut scene).is_ok());
    scene.insert_texture(&[texture([64, 64], &[9; 4096], Wrap::Repeat, Filter::Nearest)]).unwrap();
    let text = gpu.update(&queue, &mut scene).unwrap_err().to_string();
    let start =
        "the texels of the ray scene need 4112 bytes; a storage buffer binding is limited to 4096: use sm";
    assert!(text.starts_with(start), "{text}");
}

#[test]
fn trees_are_never_deeper_than_the_stack() {
    let stacked: Vec<_> = level_square(1.0, 1.0).into_iter().cycle().take(50_000).collect();
    // Each is inside the next.
    let nested: Vec<_> = (0..2000).flat_map(|i| level_square(1.0, 1.004f32.powi(i))).collect();
    let up = |x: f32| ray(Vec3::new(x, 0.0, 0.1), Vec3::new(x, 1.0, 0.1));
    for (occluders, at) in [(&stacked, 0.3), (&nested, 2900.0)] {
        let scene = scene(occluders);
        assert_eq!(scene.triangle_count(), occluders.len());
        for ray in (0..50).map(|i| up(at * i as f32 * 0.02)) {
            assert!(scene.nearest_distance(&ray).is_some());
            assert_eq!(scene.nearest_distance(&ray), scene.nearest_distance_brute_force(&ray));
        }
    }
    // As instances, inserted one by one.
    let mut scene = RayScene::default();
    for pair in nested.chunks(2) {
        insert(&mut scene, pair).unwrap();
    }
    for ray in (0..50).map(|i| up(58.0 * i as f32)) {
        assert_eq!(scene.nearest_distance(&ray), scene.nearest_distance_brute_force(&ray));
    }
    assert_eq!(scene.origin_world(), DVec3::ZERO);
}
