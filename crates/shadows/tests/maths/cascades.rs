//! Splits, spheres, and the coverage of cascades.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use shadowgraph_scene::{Aabb, BoundingSphere, Camera, Light, Projection, origin_near};
use shadowgraph_shadows::{
    CascadeFitting, OrthoFit, ShadowInputs, ShadowPlan, ShadowSettings, Slice, SplitScheme, light_from_world,
    plan_shadows, slice_sphere, split_distances,
};

use crate::common::{Boxes, Lookup, Receiver, cube, sun};

fn any_direction() -> impl Strategy<Value = DVec3> {
    let axis = prop_oneof![Just(0.0), -1.0..1.0f64];
    [axis.clone(), axis.clone(), axis]
        .prop_map(DVec3::from)
        .prop_filter("is not zero", |d| d.length() > 0.05)
        .prop_map(DVec3::normalize)
}

fn any_position() -> impl Strategy<Value = DVec3> {
    (-2e4..2e4f64, -200.0..200.0f64, -2e4..2e4f64).prop_map(DVec3::from)
}

fn any_projection() -> impl Strategy<Value = Projection> {
    let perspective = (0.1..2.5f64, 0.01..2.0f64, prop_oneof![Just(None), (50.0..2000.0f64).prop_map(Some)])
        .prop_map(|(fov_y, near, far)| Projection::Perspective { fov_y, near, far });
    let orthographic = (0.5..50.0f64, 0.5..50.0f64, -5.0..5.0f64, 20.0..300.0f64).prop_map(
        |(half_width, half_height, near, far)| Projection::Orthographic {
            half_width,
            half_height,
            near,
            far,
        },
    );
    prop_oneof![perspective, orthographic]
}

fn any_camera() -> impl Strategy<Value = Camera> {
    (any_position(), any_direction(), any_projection())
        .prop_map(|(eye, forward, projection)| Camera::look_at(eye, eye + forward, DVec3::Y, projection))
}

fn plan(camera: &Camera, aspect: f64, light: Light, settings: &ShadowSettings) -> (ShadowPlan, DVec3) {
    // A large caster: everything is in range.
    plan_of(cube(camera.position_world(), 1e5), camera, aspect, light, settings)
}

fn plan_of(
    caster: Aabb,
    camera: &Camera,
    aspect: f64,
    light: Light,
    settings: &ShadowSettings,
) -> (ShadowPlan, DVec3) {
    let origin_world = origin_near(camera.position_world());
    let casters = Boxes(vec![caster]);
    let lights = [light];
    let inputs =
        ShadowInputs { view: 0, camera, aspect, lights: &lights, casters: &casters, origin_world, settings };
    (plan_shadows(&inputs).unwrap(), origin_world)
}

proptest! {
    #[test]
    fn a_sphere_contains_the_corners_of_its_slice(
        camera in any_camera(), aspect in 0.3..4.0f64, from in 0.0..0.9f64, length in 0.01..1.0f64,
    ) {
        let far = camera.far().unwrap_or(150.0).min(150.0);
        let near_m = camera.near() + from * (far - camera.near());
        let far_m = near_m + length * (far - near_m);
        let sphere = slice_sphere(&Slice { camera: &camera, aspect, near_m, far_m });
        for corner in camera.slice_corners_view(aspect, near_m, far_m) {
            let distance = camera.world_from_view.transform_point3(corner).distance(sphere.center_world);
            prop_assert!(distance <= sphere.radius_m * (1.0 + 1e-9) + 1e-8, "{distance} {sphere:?}");
        }
    }

    #[test]
    fn splits_ascend_to_the_shadow_distance(
        near in 0.0..5.0f64, length in 0.1..1000.0f64, count in 1u32..=8, lambda in 0f32..=1.0,
        number in 0.01f32..1000.0,
    ) {
        for scheme in [
            SplitScheme::Standard,
            SplitScheme::Practical { lambda },
            SplitScheme::Logarithmic,
            SplitScheme::Geometric { first_m: number },
            SplitScheme::Factor(1.01 + number),
            SplitScheme::Metres((1..count).map(|i| number * i as f32).collect()),
        ] {
            let ends = split_distances(&scheme, count, near, near + length);
            prop_assert_eq!(ends.len(), count as usize);
            prop_assert_eq!(ends.last(), Some(&(near + length)));
            prop_assert!(ends[0] > near && ends.windows(2).all(|pair| pair[0] < pair[1]), "{ends:?}");
        }
    }

    #[test]
    fn every_point_in_the_shadow_distance_has_a_cascade(
        camera in any_camera(), aspect in 0.3..4.0f64, direction in any_direction(), normal in any_direction(),
        at in (-1.0..=1.0f64, -1.0..=1.0f64, 0.0..=1.0f64), count in 1u32..=8, tight in any::<bool>(),
    ) {
        let mut settings = ShadowSettings::default();
        settings.cascades.count = count;
        settings.cascades.fit = if tight { CascadeFitting::Tight } else { CascadeFitting::Stable };
        settings.bias.normal_texels = 1.5;
        let (plan, origin_world) = plan(&camera, aspect, sun(direction, 1.0), &settings);
        let far = camera.far().unwrap_or(150.0).min(150.0);
        // More points nearby.
        let depth = camera.near() + (far - camera.near()) * at.2 * at.2;
        let corner = camera.slice_corners_view(aspect, depth, far)[3];
        let view = DVec3::new(corner.x * at.0, corner.y * at.1, -depth);
        let position = camera.world_from_view.transform_point3(view) - origin_world;
        // With the precision of a GPU.
        let receiver = Receiver { position: position.as_vec3().as_dvec3(), normal };
        let found = plan.views.iter().find_map(|view| Lookup::new(view, &plan.lights[0], receiver));
        prop_assert!(found.is_some(), "no cascade at {view}");
    }

    #[test]
    fn every_receiver_in_the_image_has_a_cascade_in_a_scene_of_any_size(
        camera in any_camera(), aspect in 0.3..4.0f64, direction in any_direction(), normal in any_direction(),
        at in (-1.0..=1.0f64, -1.0..=1.0f64, 0.0..=1.0f64), within in (0.0..=1.0f64, 0.0..=1.0f64, 0.0..=1.0f64),
        size in (-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64), count in 1u32..=8,
    ) {
        let mut settings = ShadowSettings::default();
        settings.cascades.count = count;
        settings.bias.normal_texels = 1.5;
        let far = camera.far().unwrap_or(150.0).min(150.0);
        let depth = camera.near() + (far - camera.near()) * at.2 * at.2;
        let corner = camera.slice_corners_view(aspect, depth, far)[3];
        let view = DVec3::new(corner.x * at.0, corner.y * at.1, -depth);
        let position = camera.world_from_view.transform_point3(view);
        // Boxes of millimetres to kilometres that contain the point.
        let size = DVec3::from(size).map(|exponent| 10f64.powf(exponent));
        let min = position - size * DVec3::from(within);
        let bounds = Aabb { min, max: min + size };
        let (plan, origin_world) = plan_of(bounds, &camera, aspect, sun(direction, 1.0), &settings);
        let receiver = Receiver { position: (position - origin_world).as_vec3().as_dvec3(), normal };
        let found = plan.views.iter().find_map(|view| Lookup::new(view, &plan.lights[0], receiver));
        let has_views = plan.lights[0].view_count > 0;
        prop_assert!(found.is_some() || !has_views, "no cascade at {view} of {bounds:?}");
    }

    #[test]
    fn depth_is_reversed_and_in_range_in_the_sphere(
        center_world in any_position(), radius_m in 0.01..500.0f64, direction in any_direction(),
        a in any_direction(), b in any_direction(),
    ) {
        let rotation = light_from_world(direction).unwrap();
        let fit = OrthoFit::new(rotation, BoundingSphere { center_world, radius_m }, 1024, 5.0);
        let origin_world = origin_near(center_world);
        let clip_from_world = fit.clip_from_world(origin_world);
        let depth = |p: DVec3| clip_from_world.transform_point3(p - origin_world).z;
        let (p, q) = (center_world + a * radius_m, center_world + b * radius_m);
        for point in [p, q] {
            prop_assert!((0.0..=1.0).contains(&depth(point)));
            let clip = clip_from_world.transform_point3(point - origin_world);
            prop_assert!(clip.truncate().abs().max_element() <= 1.0 - 6.0 / 1024.0);
        }
        let (p_before, q_before) = (p.dot(direction), q.dot(direction));
        if (p_before - q_before).abs() > 1e-6 * radius_m {
            prop_assert_eq!(p_before < q_before, depth(p) > depth(q), "nearer to the light is greater");
        }
    }

    #[test]
    fn casters_towards_the_light_are_kept_and_those_beyond_are_culled(
        center_world in any_position(), radius_m in 0.1..200.0f64, direction in any_direction(),
        towards in 0.0..1e4f64, within in any_direction(),
    ) {
        let rotation = light_from_world(direction).unwrap();
        let fit = OrthoFit::new(rotation, BoundingSphere { center_world, radius_m }, 512, 5.0);
        let volume = fit.cull_volume();
        let small = |center: DVec3| cube(center, radius_m * 1e-3);
        let receiver = center_world + within * radius_m;
        prop_assert!(volume.intersects(&small(receiver - direction * towards)));
        let beyond = center_world + direction * (2.0 * fit.half_extent_m() + towards);
        prop_assert!(!volume.intersects(&small(beyond)));
        let sideways = direction.any_orthonormal_vector() * (3.0 * fit.half_extent_m());
        prop_assert!(!volume.intersects(&small(center_world + sideways - direction * towards)));
    }

    #[test]
    fn smaller_tiles_cover_everything_that_larger_ones_cover(
        center_world in any_position(), radius_m in 0.1..200.0f64, direction in any_direction(),
        corner in (0..2, 0..2, 0..2), step in 0usize..3,
    ) {
        let rotation = light_from_world(direction).unwrap();
        let sphere = BoundingSphere { center_world, radius_m };
        let large_px = [2048, 1024, 682][step];
        let (small, large) =
            (OrthoFit::new(rotation, sphere, 512, 4.0), OrthoFit::new(rotation, sphere, large_px, 4.0));
        let sign = |bit: i32| f64::from(2 * bit - 1);
        let corner = DVec3::new(sign(corner.0), sign(corner.1), sign(corner.2)) * large.half_extent_m();
        let world = rotation.transpose() * (large.center_m() + corner * (1.0 - 1e-12));
        prop_assert!(small.cull_volume().planes.iter().all(|p| p.signed_distance(world) > -1e-6 * radius_m));
    }

    #[test]
    fn light_space_is_a_rotation_along_the_light(direction in any_direction()) {
        let rotation: DMat3 = light_from_world(direction).unwrap();
        prop_assert!((rotation.determinant() - 1.0).abs() < 1e-9);
        prop_assert!((rotation * direction - DVec3::NEG_Z).length() < 1e-9);
        let product = rotation * rotation.transpose();
        prop_assert!((0..3).all(|i| (product.col(i) - DMat3::IDENTITY.col(i)).length() < 1e-9));
    }
}

#[test]
fn a_light_from_straight_above_or_below_has_axes() {
    for direction in [DVec3::NEG_Y, DVec3::Y, DVec3::new(1e-9, -1.0, 1e-9), DVec3::new(0.0, -3.0, 0.01)] {
        let rotation = light_from_world(direction).unwrap();
        assert!(rotation.is_finite() && (rotation * direction.normalize()).z < -0.999_999);
    }
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::new(f64::INFINITY, 0.0, 0.0)] {
        assert_eq!(light_from_world(direction), None);
    }
}

#[test]
fn axes_turn_no_faster_than_a_high_light_also_near_the_vertical() {
    let direction = |elevation_deg: f64, heading: f64| {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        DVec3::new(cos * heading.cos(), -sin, cos * heading.sin())
    };
    for step in 0..200 {
        // Over the zenith, past the former threshold of 2.6 degrees, along several meridians.
        let (elevation_deg, heading) = (80.0 + 0.1 * f64::from(step), f64::from(step % 7));
        let (before, after) = (direction(elevation_deg, heading), direction(elevation_deg + 0.05, heading));
        let turn = light_from_world(after).unwrap() * light_from_world(before).unwrap().transpose();
        let angle = ((turn.x_axis.x + turn.y_axis.y + turn.z_axis.z - 1.0) * 0.5).clamp(-1.0, 1.0).acos();
        assert!(angle.to_degrees() < 0.0501, "{elevation_deg}: {}", angle.to_degrees());
    }
}

#[test]
fn the_radius_does_not_depend_on_the_camera() {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
    let radius = |eye: DVec3, forward: DVec3| {
        let camera = Camera::look_at(eye, eye + forward, DVec3::Y, projection);
        slice_sphere(&Slice { camera: &camera, aspect: 1.6, near_m: 3.0, far_m: 20.0 }).radius_m
    };
    let first = radius(DVec3::ZERO, DVec3::NEG_Z);
    for i in 0..100 {
        let angle = f64::from(i) * 0.37;
        let forward = DVec3::new(angle.sin(), (angle * 0.3).sin(), angle.cos());
        assert_eq!(radius(DVec3::new(angle * 997.0, angle, -1e4), forward), first);
    }
}

#[test]
fn the_sphere_keeps_the_margin_from_the_tiles_edges_after_snapping() {
    // A radius that is not rounded up, so that there is no other slack.
    let (radius_m, tile_px) = (8.0, 256);
    for margin_px in [4.0, 6.5] {
        for i in 0..200 {
            let angle = f64::from(i) * 0.7;
            let direction = DVec3::new(angle.sin(), -1.2, angle.cos());
            let rotation = light_from_world(direction).unwrap();
            let sphere =
                BoundingSphere { center_world: DVec3::new(angle, -angle, 0.3 * angle) * 7.7, radius_m };
            let clip_from_world =
                OrthoFit::new(rotation, sphere, tile_px, margin_px).clip_from_world(DVec3::ZERO);
            let center = clip_from_world.transform_point3(sphere.center_world).truncate();
            let right = rotation.transpose().x_axis * radius_m;
            let edge = clip_from_world.transform_point3(sphere.center_world + right).truncate();
            let spare_px = (1.0 - (edge - center).x - center.abs().max_element()) * f64::from(tile_px) * 0.5;
            // The last texel of the margin is for snapping.
            assert!(spare_px >= margin_px - 1.0 && spare_px <= margin_px + 1e-9, "{spare_px}");
        }
    }
}

#[test]
fn schemes_split_as_documented() {
    let close = |scheme: &SplitScheme, expected: &[f64]| {
        let ends = split_distances(scheme, expected.len() as u32, 1.0, 101.0);
        let equal = ends.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(equal && ends.len() == expected.len(), "{scheme:?}: {ends:?}");
    };
    close(&SplitScheme::Standard, &[7.7, 21.0, 47.7, 101.0]);
    close(&SplitScheme::Standard, &[11.0, 36.0, 101.0]);
    close(&SplitScheme::Standard, &[101.0]);
    close(&SplitScheme::Ratios(vec![0.25]), &[26.0, 101.0]);
    close(&SplitScheme::Practical { lambda: 0.0 }, &[51.0, 101.0]);
    close(&SplitScheme::Practical { lambda: 1.0 }, &[101f64.sqrt(), 101.0]);
    close(&SplitScheme::Logarithmic, &[101f64.sqrt(), 101.0]);
    close(&SplitScheme::Metres(vec![20.0, 30.0]), &[20.0, 30.0, 101.0]);
    close(&SplitScheme::Factor(2.0), &[12.625, 25.25, 50.5, 101.0]);
    close(&SplitScheme::Geometric { first_m: 6.0 }, &[6.0, (6.0f64 * 101.0).sqrt(), 101.0]);
    // Where the first would end too far away, each ends twice as far as the last.
    close(&SplitScheme::Geometric { first_m: 90.0 }, &[25.25, 50.5, 101.0]);
}

#[test]
fn empty_bounds_intersect_no_cascade() {
    let rotation = light_from_world(DVec3::NEG_Y).unwrap();
    let sphere = BoundingSphere { center_world: DVec3::ZERO, radius_m: 10.0 };
    assert!(!OrthoFit::new(rotation, sphere, 512, 4.0).cull_volume().intersects(&Aabb::EMPTY));
}
