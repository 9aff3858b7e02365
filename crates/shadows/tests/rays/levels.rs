//! The two levels: instances of meshes with transforms and surfaces.

use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3, Vec4};
use proptest::prelude::*;
use shadowgraph_shadows::rays::{
    ChannelTexture, Cutout, Filter, Instance, Ray, RayScene, RayTextureKey, Surface, Tint, Wrap,
};

use crate::common::{Occluder, insert, level_square, ray, sphere};

fn vector() -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-1f32..1.0).prop_map(Vec3::from)
}

fn textures() -> impl Strategy<Value = Vec<ChannelTexture>> {
    let wrap = || prop::sample::select(vec![Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]);
    let filter = prop::sample::select(vec![Filter::Nearest, Filter::Bilinear]);
    let one = (prop::collection::vec(any::<u8>(), 15), 0usize..3, wrap(), wrap(), filter).prop_map(
        |(texels, shape, u, v, filter)| {
            let size = [[3, 5], [5, 3], [1, 15]][shape];
            ChannelTexture::new(size, texels, [u, v], filter).unwrap()
        },
    );
    prop::collection::vec(one, 5)
}

/// An occluder whose texture is still a number.
type Numbered = (Occluder, Option<usize>);

fn occluder() -> impl Strategy<Value = Numbered> {
    (vector(), prop::array::uniform3(vector()), surface()).prop_map(
        |(center, corners, (surface, texture))| {
            let corners = corners.map(|corner| center * 10.0 + corner * 3.0);
            (Occluder { corners, surface }, texture)
        },
    )
}

fn surface() -> impl Strategy<Value = (Surface, Option<usize>)> {
    let uv = || prop::array::uniform3(prop::array::uniform2(-3f32..3.0).prop_map(Vec2::from));
    let texture = None;
    let cutout = (uv(), prop::array::uniform3(0.3f32..1.5))
        .prop_map(move |(uv, alpha)| Surface::Cutout(Cutout { texture, uv, alpha, cutoff: 0.5 }));
    let color = prop::array::uniform3(prop::array::uniform4(0f32..1.0).prop_map(Vec4::from));
    let tint = (uv(), color, any::<bool>())
        .prop_map(move |(uv, color, transmits)| Surface::Tint(Tint { texture, uv, color, transmits }));
    (prop_oneof![Just(Surface::Opaque), cutout, tint], prop::option::weighted(0.8, 0usize..2))
}

/// Returns any affine transform, now and then one that mirrors, or flattens to a plane.
pub(crate) fn transform() -> impl Strategy<Value = DAffine3> {
    let axis = || prop::array::uniform3(-1.5f64..1.5).prop_map(DVec3::from);
    let flat = prop::bool::weighted(0.1);
    (axis(), axis(), axis(), axis(), flat, -2.0f64..2.0).prop_map(|(x, y, z, offset, is_flat, scale)| {
        let y = if is_flat { DVec3::ZERO } else { y };
        let matrix3 = DMat3::from_cols(x, y, z) * 10f64.powf(scale);
        DAffine3 { matrix3, translation: offset * 10.0 }
    })
}

impl Occluder {
    fn with_texture(self, texture: Option<RayTextureKey>) -> Self {
        let surface = match self.surface {
            Surface::Opaque => Surface::Opaque,
            Surface::Cutout(cutout) => Surface::Cutout(Cutout { texture, ..cutout }),
            Surface::Tint(tint) => Surface::Tint(Tint { texture, ..tint }),
        };
        Self { surface, ..self }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn the_trees_and_brute_force_agree(
        meshes in prop::collection::vec(prop::collection::vec(occluder(), 0..40), 1..4),
        textures in textures(),
        placed in prop::collection::vec((any::<prop::sample::Index>(), transform()), 0..12),
        rays in prop::collection::vec((vector(), vector()), 50),
    ) {
        let mut scene = RayScene::default();
        // Two textures of four channels: the first serves as alpha for cutouts too.
        let keys = [0, 1].map(|first| scene.insert_texture(&textures[first..first + 4]).unwrap());
        let meshes: Vec<_> = meshes.iter().map(|occluders| {
            let textured = |&(occluder, texture): &Numbered| occluder.with_texture(texture.map(|at| keys[at]));
            let occluders: Vec<_> = occluders.iter().map(textured).collect();
            let corners: Vec<_> = occluders.iter().map(|occluder| occluder.corners).collect();
            let surfaces: Vec<_> = occluders.iter().map(|occluder| occluder.surface).collect();
            (scene.insert_mesh(&corners).unwrap(), scene.insert_surfaces(&surfaces).unwrap())
        }).collect();
        for (index, (mesh, world_from_mesh)) in placed.iter().enumerate() {
            let (mesh, surfaces) = *mesh.get(&meshes);
            let surfaces = (index % 3 > 0).then_some(surfaces);
            scene.insert_instance(Instance { mesh, surfaces, world_from_mesh: *world_from_mesh }).unwrap();
        }
        for (origin, direction) in rays {
            let (origin, direction) = (origin * 15.0, direction.normalize_or(Vec3::Y));
            let ray = Ray::new(origin, direction, 0.0, f32::INFINITY);
            let (nearest, all) = (scene.nearest_distance_brute_force(&ray), scene.transmittance_brute_force(&ray));
            prop_assert_eq!(scene.nearest_distance(&ray), nearest);
            prop_assert_eq!(scene.is_occluded(&ray), nearest.is_some());
            prop_assert_eq!(all == Vec3::ZERO, nearest.is_some());
            // Products in another order.
            prop_assert!(scene.transmittance(&ray).abs_diff_eq(all, 1e-6));
        }
    }

    #[test]
    fn no_ray_leaves_a_sphere_that_is_turned_scaled_and_far_from_its_own_origin(
        own_center in prop::array::uniform3(-50f32..50.0).prop_map(Vec3::from),
        turned in transform(),
        center in prop::array::uniform3(-1500f64..1500.0).prop_map(DVec3::from),
        inside in vector(),
        part in 0f32..1.0,
    ) {
        prop_assume!(turned.matrix3.determinant().abs() > 1e-2 * turned.matrix3.to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max).powi(3));
        let own: Vec<_> = sphere(1).into_iter().map(|corners| corners.map(|corner| corner + own_center)).collect();
        let translation = center - turned.matrix3 * own_center.as_dvec3();
        let world_from_mesh = DAffine3 { translation, ..turned };
        let mut scene = RayScene::default();
        let mesh = scene.insert_mesh(&own).unwrap();
        scene.insert_instance(Instance { mesh, surfaces: None, world_from_mesh }).unwrap();
        let at = |point: Vec3| world_from_mesh.transform_point3(point.as_dvec3()).as_vec3();
        let origin = at(own_center + inside * 0.4);
        for [a, b, c] in own {
            for target in [a, a.lerp(b, part), b.lerp(c, part), (a + b) / 2.0] {
                prop_assert!(scene.is_occluded(&ray(origin, at(target))), "{} to {}", origin, target);
            }
        }
    }
}

#[test]
fn distances_are_those_of_the_world_under_any_scale() {
    let mut scene = RayScene::default();
    let square: Vec<_> = level_square(1.0, 1.0).iter().map(|occluder| occluder.corners).collect();
    let mesh = scene.insert_mesh(&square).unwrap();
    let up = ray(Vec3::new(0.01, -1.0, 0.02), Vec3::new(0.01, 1.0, 0.02));
    for scale in [DVec3::splat(1e-3), DVec3::splat(1e3), DVec3::new(20.0, 7.0, -0.5)] {
        let world_from_mesh = DAffine3::from_scale(scale);
        let key = scene.insert_instance(Instance { mesh, surfaces: None, world_from_mesh }).unwrap();
        let hit = scene.nearest_distance(&up);
        if scale.x > 0.1 {
            assert!((f64::from(hit.unwrap()) / (1.0 + scale.y) - 1.0).abs() < 1e-6, "{hit:?}");
        } else {
            assert_eq!(hit, None);
        }
        scene.remove_instance(key).unwrap();
    }
}

#[test]
fn meshes_flattened_to_a_plane_block_light_and_invalid_transforms_none() {
    let mut scene = RayScene::default();
    let ball = scene.insert_mesh(&sphere(2)).unwrap();
    let flat = DAffine3::from_scale_rotation_translation(
        DVec3::new(1.0, 0.0, 1.0),
        glam::DQuat::IDENTITY,
        DVec3::new(0.0, 3.0, 0.0),
    );
    let key = scene.insert_instance(Instance { mesh: ball, surfaces: None, world_from_mesh: flat }).unwrap();
    let at = |x: f32| ray(Vec3::new(x, 0.0, 0.1), Vec3::new(x, 1.0, 0.1));
    assert!((scene.nearest_distance(&at(0.3)).unwrap() - 3.0).abs() < 1e-6);
    assert_eq!(scene.nearest_distance(&at(1.1)), None);
    for invalid in [DVec3::NAN, DVec3::splat(f64::INFINITY), DVec3::splat(1e10)] {
        scene.set_transform(key, DAffine3::from_translation(invalid)).unwrap();
        assert_eq!((scene.nearest_distance(&at(0.3)), scene.max_coordinate_m()), (None, 0.0));
    }
    scene.set_transform(key, flat).unwrap();
    assert!(scene.is_occluded(&at(0.3)));
    insert(&mut scene, &level_square(2.0, 0.5)).unwrap();
    assert_eq!(scene.nearest_distance(&at(0.3)), Some(2.0));
}
