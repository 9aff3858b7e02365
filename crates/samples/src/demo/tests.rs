#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::collections::BTreeSet;

use glam::{DAffine3, Vec3};

use super::*;
use shadowgraph_scene::{AlphaMode, AnimationSelection};

#[test]
fn every_vertex_has_a_unit_normal_and_a_perpendicular_tangent() {
    for (_, mesh) in demo_scene().meshes() {
        for vertex in &mesh.vertices {
            let normal = Vec3::from(vertex.normal);
            let [x, y, z, side] = vertex.tangent;
            let tangent = Vec3::new(x, y, z);
            assert!((normal.length() - 1.0).abs() < 1e-4, "{}: normal {normal}", mesh.name);
            assert!((tangent.length() - 1.0).abs() < 1e-4, "{}: tangent {tangent}", mesh.name);
            assert!(normal.dot(tangent).abs() < 1e-3, "{}: {normal} {tangent}", mesh.name);
            assert!(side.abs() == 1.0, "{}: side {side}", mesh.name);
        }
    }
}

#[test]
fn every_index_is_in_range_and_every_triangle_faces_its_normals() {
    for (_, mesh) in demo_scene().meshes() {
        assert!(!mesh.indices.is_empty() && mesh.indices.len().is_multiple_of(3), "{}", mesh.name);
        for corners in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.vertices[corners[k] as usize]);
            let [pa, pb, pc] = [a, b, c].map(|vertex| Vec3::from(vertex.position));
            let facing = (pb - pa).cross(pc - pa);
            let normals: Vec3 = [a, b, c].iter().map(|vertex| Vec3::from(vertex.normal)).sum();
            assert!(facing.dot(normals) > 0.0, "{}: {corners:?}", mesh.name);
        }
    }
}

#[test]
fn every_reference_is_in_range() {
    let scene = demo_scene();
    for (_, instance) in scene.instances() {
        assert!(scene.mesh(instance.mesh).is_some() && scene.material(instance.material).is_some());
        assert!(!instance.name.is_empty());
    }
    for (_, material) in scene.materials() {
        assert!(!material.name.is_empty());
        let textures = [material.base_color_texture, material.normal_texture];
        assert!(textures.iter().flatten().all(|texture| scene.image(texture.image).is_some()));
    }
    for (_, image) in scene.images() {
        assert_eq!(image.rgba8.len(), (image.width * image.height * 4) as usize, "{}", image.name);
    }
}

#[test]
fn all_meshes_and_materials_are_used() {
    let scene = demo_scene();
    for (key, mesh) in scene.meshes() {
        assert!(scene.instances().any(|(_, instance)| instance.mesh == key), "{}", mesh.name);
    }
    for (key, material) in scene.materials() {
        assert!(scene.instances().any(|(_, instance)| instance.material == key), "{}", material.name);
    }
}

#[test]
fn scene_has_one_sun_then_three_spots_and_all_cast_shadows() {
    let scene = demo_scene();
    let lights = scene.lights();
    let orders: Vec<u8> = lights.iter().map(|light| light.kind.order()).collect();
    assert_eq!(orders, [0, 1, 1, 1]);
    for light in lights {
        let (LightKind::Directional { direction }
        | LightKind::Spot { direction, .. }
        | LightKind::Point { position_world: direction, .. }) = light.kind;
        assert!((direction.length() - 1.0).abs() < 1e-12);
        assert!(light.casts_shadow && light.name.is_some());
    }
}

#[test]
fn scene_has_few_triangles_and_large_bounds() {
    let scene = demo_scene();
    assert!((10_000..60_000).contains(&scene.triangle_count()), "{}", scene.triangle_count());
    let bounds = scene.bounds();
    assert!(bounds.half_extent().x > 200.0 && bounds.half_extent().y > 15.0);
    assert!(bounds.min.y > -2.0 && bounds.max.y < 60.0);
}

#[test]
fn rings_lanterns_flag_and_banners_move_and_begin_where_they_are_at_rest() {
    let rest = demo_scene();
    let places = |scene: &Scene| -> Vec<(String, DAffine3)> {
        scene.instances().map(|(_, instance)| (instance.name.clone(), instance.world_from_local)).collect()
    };
    let mut scene = rest.clone();
    scene.set_time(AnimationSelection::All, 0.0).unwrap();
    for ((name, at_rest), (_, begun)) in places(&rest).iter().zip(places(&scene)) {
        assert!(at_rest.abs_diff_eq(begun, 1e-6), "{name}: {at_rest} {begun}");
    }
    scene.set_time(AnimationSelection::All, 1.3).unwrap();
    let moved: BTreeSet<_> = places(&rest)
        .into_iter()
        .zip(places(&scene))
        .filter(|((_, at_rest), (_, moved))| !at_rest.abs_diff_eq(*moved, 1e-3))
        .map(|((name, _), _)| name)
        .collect();
    let expected = ["banner", "chain", "flag", "lantern", "lantern glass", "rings"];
    assert_eq!(moved, expected.map(String::from).into());
    for (light, moved) in rest.lights().iter().zip(scene.lights()) {
        assert_eq!(light.kind != moved.kind, light.kind.order() == 1, "{:?}", light.name);
    }
    let end_s = scene.hierarchy.end_s(AnimationSelection::All);
    scene.set_time(AnimationSelection::All, end_s.into()).unwrap();
    for ((name, at_rest), (_, ended)) in places(&rest).iter().zip(places(&scene)) {
        assert!(at_rest.abs_diff_eq(ended, 1e-5), "{name} does not return: {at_rest} {ended}");
    }
}

#[test]
fn ball_touches_the_court() {
    let scene = demo_scene();
    let key = |name: &str| scene.instances().find(|(_, instance)| instance.name == name).unwrap().0;
    let ball = scene.instance_bounds(key("ball"));
    let court = scene.instance_bounds(key("court"));
    assert!((ball.min.y - court.max.y).abs() < 1e-6);
}

#[test]
fn fence_texture_has_holes_and_iron() {
    let scene = demo_scene();
    let (_, fence) = scene.materials().find(|(_, material)| material.name == "wrought iron").unwrap();
    assert_eq!(fence.alpha, AlphaMode::Mask { cutoff: 0.5 });
    let image = scene.image(fence.base_color_texture.unwrap().image).unwrap();
    let iron = image.rgba8.chunks_exact(4).filter(|texel| texel[3] >= 128).count();
    let fraction = iron as f64 / f64::from(image.width * image.height);
    assert!((0.15..0.6).contains(&fraction), "{fraction}");
}

#[test]
fn scene_is_the_same_every_time() {
    assert_eq!(demo_scene(), demo_scene());
}
