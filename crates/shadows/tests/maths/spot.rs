//! The pyramid of a spot light.

use glam::DVec3;
use proptest::prelude::*;
use shadowgraph_scene::Aabb;
use shadowgraph_shadows::{
    MAX_SPOT_HALF_ANGLE, ShadowFilter, ShadowView, SpotCone, SpotFit, TilePlacement, TileRect,
    light_from_world,
};

const MARGIN_PX: f64 = 4.5;

fn fit(cone: SpotCone, tile_px: u32) -> SpotFit {
    SpotFit::new(cone, light_from_world(cone.direction).unwrap(), 0.05, tile_px, MARGIN_PX)
}

fn cone(position_world: DVec3, direction: DVec3, half_angle: f64, range_m: f64) -> SpotCone {
    SpotCone { position_world, direction: direction.normalize(), half_angle, range_m }
}

/// Returns points on the cone's surface at a fraction of its range.
fn rim(cone: &SpotCone, fraction: f64) -> impl Iterator<Item = DVec3> + use<> {
    let cone = *cone;
    let (right, up) = cone.direction.any_orthonormal_pair();
    (0..32).map(move |step| {
        let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 32.0).sin_cos();
        let outward = (right * cos + up * sin) * cone.half_angle.sin();
        cone.position_world + (cone.direction * cone.half_angle.cos() + outward) * cone.range_m * fraction
    })
}

fn any_cone() -> impl Strategy<Value = SpotCone> {
    let direction = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64);
    let position = (-1e4..1e4f64, -50.0..50.0f64, -1e4..1e4f64);
    (position, direction, 0.02..MAX_SPOT_HALF_ANGLE, 0.5..500.0f64)
        .prop_filter("a direction", |(_, (x, y, z), ..)| DVec3::new(*x, *y, *z).length() > 0.01)
        .prop_map(|(p, d, angle, range)| cone(p.into(), DVec3::from(d), angle, range))
}

proptest! {
    #[test]
    fn cone_stays_inside_the_border_of_its_tile(cone in any_cone(), shift in 6u32..12) {
        let tile_px = 1 << shift;
        let clip_from_world = fit(cone, tile_px).clip_from_world(DVec3::ZERO);
        let inner = 1.0 - 2.0 * f64::from(ShadowFilter::Tent5.taps()) / f64::from(tile_px);
        for point in rim(&cone, 0.7) {
            let clip = clip_from_world.project_point3(point);
            prop_assert!(clip.truncate().abs().max_element() < inner, "{clip}");
        }
    }

    #[test]
    fn row_03_uploaded_view_puts_the_cone_in_its_inner_rect(cone in any_cone()) {
        let rect = TileRect { x: 512, y: 0, width: 512, height: 512 };
        let origin = shadowgraph_scene::origin_near(cone.position_world);
        let tile = TilePlacement { rect, map_size_px: [1024, 1024], border_px: 3, depth_step: 0.0 };
        let view = ShadowView::spot(&fit(cone, 512), &tile, origin);
        for point in rim(&cone, 0.9) {
            let map = view.map_from_world * (point - origin).as_vec3().extend(1.0);
            let uv = map.truncate().truncate() / map.w;
            prop_assert!(uv.cmpge(view.uv_min).all() && uv.cmple(view.uv_max).all(), "{uv}");
        }
    }

    #[test]
    fn depth_is_reversed(cone in any_cone(), near in 0.06..0.98f64, step in 0.001..0.01f64) {
        let fit = fit(cone, 512);
        let clip_from_world = fit.clip_from_world(DVec3::ZERO);
        let depth = |m: f64| clip_from_world.project_point3(cone.position_world + cone.direction * m).z;
        let (near, far) = (near * cone.range_m, (near + step) * cone.range_m);
        prop_assert!(depth(near) > depth(far));
        prop_assert!((depth(fit.near_m) - 1.0).abs() < 1e-6 && depth(fit.far_m).abs() < 1e-6);
    }

    #[test]
    fn casters_in_the_cone_are_kept_and_others_are_culled(
        cone in any_cone(), part in 0.0..1.0f64, side in -1.0..1.0f64,
    ) {
        let volume = fit(cone, 64).cull_volume();
        for point in rim(&cone, part) {
            let inside = cone.position_world.lerp(point, 0.99).lerp(
                cone.position_world + cone.direction * cone.range_m * part * cone.half_angle.cos(), side.abs());
            prop_assert!(volume.contains_point(inside));
        }
        // From the light's position to the end of its range, not behind it or beyond.
        let along = |m: f64| Aabb::from_points([cone.position_world + cone.direction * m]);
        prop_assert!(volume.intersects(&along(1e-6)));
        prop_assert!(!volume.intersects(&along(-0.01 * cone.range_m)));
        prop_assert!(!volume.intersects(&along(1.01 * cone.range_m)));
    }

    #[test]
    fn the_bounding_sphere_contains_the_cone(cone in any_cone(), part in 0.0..1.0f64) {
        let sphere = cone.bounding_sphere();
        let end = cone.position_world + cone.direction * cone.range_m * part;
        for point in rim(&cone, part).chain([end]) {
            // The end of the axis is outside a wide cone's flat disc.
            prop_assert!(point.distance(sphere.center_world) <= sphere.radius_m * (1.0 + 1e-9), "{point}");
        }
    }

    #[test]
    fn smaller_tiles_cover_everything_that_larger_ones_cover(cone in any_cone(), at in (-1.0..1.0f64, -1.0..1.0f64)) {
        let (small, large) = (fit(cone, 64), fit(cone, 2048));
        prop_assert!(small.tan_half > large.tan_half);
        let to_world = large.light_from_world.transpose();
        let ray = to_world * DVec3::new(at.0 * large.tan_half, at.1 * large.tan_half, -1.0);
        prop_assert!(small.cull_volume().contains_point(cone.position_world + ray * (0.5 * cone.range_m)));
    }
}

#[test]
fn a_cone_wider_than_a_tile_is_limited() {
    let wide = fit(cone(DVec3::ZERO, DVec3::NEG_Y, std::f64::consts::FRAC_PI_2, 10.0), 512);
    assert!(wide.tan_half.is_finite() && wide.tan_half < 6.0);
}

#[test]
fn the_near_plane_is_within_a_short_range() {
    let short = fit(cone(DVec3::ZERO, DVec3::NEG_Y, 0.5, 0.06), 512);
    assert_eq!(short.near_m, 0.03);
    assert!(short.clip_from_world(DVec3::ZERO).is_finite());
}
