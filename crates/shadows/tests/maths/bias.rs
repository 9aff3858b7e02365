//! Self-shadowing and the position of outlines, with the CPU reference of `pcf.wgsl` on analytic scenes.

use crate::common::{Analytic, Receiver};
use glam::DVec3;
use shadowgraph_scene::{Aabb, BoundingSphere};
use shadowgraph_shadows::{
    BiasSettings, OrthoFit, ShadowLight, ShadowSettings, ShadowView, SpotCone, SpotFit, TilePlacement,
    TileRect, light_from_world,
};

const TILE_PX: u32 = 1024;
const ELEVATIONS_DEG: [f64; 4] = [15.0, 30.0, 52.0, 75.0];
const AZIMUTHS_DEG: [f64; 3] = [0.0, 25.0, 45.0];
const TEXELS_M: [f64; 3] = [0.01, 0.03, 0.1];

/// A surface of the scene, and a test of which points of its plane belong to it.
struct Surface {
    normal: DVec3,
    points: Vec<DVec3>,
    on: fn(DVec3) -> bool,
}

fn whole_tile() -> (TileRect, [u32; 2]) {
    (TileRect { x: 0, y: 0, width: TILE_PX, height: TILE_PX }, [TILE_PX, TILE_PX])
}

fn light(bias: &BiasSettings) -> ShadowLight {
    let settings = ShadowSettings { bias: bias.clone(), ..ShadowSettings::default() };
    ShadowLight::new(&settings, 150.0)
}

fn bias() -> BiasSettings {
    ShadowSettings::default().bias
}

fn sun_direction(elevation_deg: f64, azimuth_deg: f64) -> DVec3 {
    let (e, a) = (elevation_deg.to_radians(), azimuth_deg.to_radians());
    -DVec3::new(a.cos() * e.cos(), e.sin(), a.sin() * e.cos())
}

fn placement(rect: TileRect, map_size_px: [u32; 2]) -> TilePlacement {
    TilePlacement { rect, map_size_px, border_px: 3, depth_step: 0.0 }
}

fn cube() -> Aabb {
    Aabb { min: DVec3::new(-0.5, 0.0, -0.5), max: DVec3::new(0.5, 1.0, 0.5) }
}

/// Returns a cube of 1 m on a floor, under a sun.
fn sunlit(direction: DVec3, texel_m: f64, bias: &BiasSettings) -> Analytic {
    let radius_m = texel_m * f64::from(TILE_PX) * 0.48;
    // Off-centre, so that no edge coincides with the border of texels.
    let sphere = BoundingSphere { center_world: DVec3::new(0.313, 0.217, 0.131), radius_m };
    let fit = OrthoFit::new(light_from_world(direction).unwrap(), sphere, TILE_PX, 8.0);
    let (rect, map_size_px) = whole_tile();
    Analytic {
        floor: 0.0,
        block: cube(),
        view: ShadowView::directional(&fit, &placement(rect, map_size_px), DVec3::ZERO),
        light: light(bias),
        map_size_px,
    }
}

fn grid(steps: i32, at: impl Fn(f64, f64) -> DVec3) -> Vec<DVec3> {
    let part = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
    (0..steps * steps).map(|i| at(part(i % steps), part(i / steps))).collect()
}

/// Returns the floor around the cube up to the end of the shadow, denser at the foot of the cube, and its lit faces.
fn surfaces(direction: DVec3, texel_m: f64) -> Vec<Surface> {
    let away = direction.with_y(0.0).normalize();
    let side = DVec3::new(-away.z, 0.0, away.x);
    let length = 2.2 + direction.with_y(0.0).length() / -direction.y;
    let off_cube = |p: DVec3| p.x.abs() > 0.5 || p.z.abs() > 0.5;
    let mut floor = grid(45, |u, v| away * (u * length - 1.2) + side * (2.4 * v - 1.2));
    // The cube's foot, on all sides, four texels wide and dense.
    let rim = texel_m * 4.0;
    for axis in [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z] {
        let along = DVec3::new(axis.z, 0.0, axis.x);
        floor.extend(grid(12, |u, v| axis * (0.5 + rim * u) + along * (1.2 * v - 0.6)));
    }
    floor.retain(|point| off_cube(*point));
    let on_face = |p: DVec3| p.x.abs() <= 0.5001 && p.z.abs() <= 0.5001 && (0.0..=1.0001).contains(&p.y);
    let mut all = vec![
        Surface { normal: DVec3::Y, points: floor, on: off_cube },
        Surface { normal: DVec3::Y, points: grid(20, |u, v| DVec3::new(u - 0.5, 1.0, v - 0.5)), on: on_face },
    ];
    for normal in [DVec3::X, DVec3::Z] {
        let along = DVec3::new(normal.z, 0.0, normal.x);
        let face = |u: f64, v: f64| normal * 0.5 + along * (u - 0.5) + DVec3::Y * v;
        let foot = grid(8, |u, v| face(u, v * rim.min(0.9)));
        let points = grid(20, face).into_iter().chain(foot).collect();
        all.push(Surface { normal, points, on: on_face });
    }
    all.retain(|surface| surface.normal.dot(-direction) > 0.1);
    all
}

fn for_each_case(mut check: impl FnMut(&Analytic, Receiver, f64, fn(DVec3) -> bool, &str)) {
    for elevation in ELEVATIONS_DEG {
        for azimuth in AZIMUTHS_DEG {
            for texel_m in TEXELS_M {
                let direction = sun_direction(elevation, azimuth);
                let scene = sunlit(direction, texel_m, &bias());
                let name = format!("sun {elevation} deg, azimuth {azimuth} deg, texel {texel_m} m");
                for surface in surfaces(direction, texel_m) {
                    for position in surface.points {
                        let receiver = Receiver { position, normal: surface.normal };
                        let visibility = scene.visibility(receiver).unwrap();
                        check(&scene, receiver, visibility, surface.on, &name);
                    }
                }
            }
        }
    }
}

#[test]
fn the_outline_is_within_one_and_a_half_texels_of_the_exact_one() {
    let mut wrong = 0;
    for_each_case(|scene, receiver, visibility, on, name| {
        if (visibility > 0.5) == scene.in_shadow(receiver) {
            wrong += 1;
            let near = [0.1, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5];
            let near = near.iter().any(|texels| scene.near_outline(receiver, *texels, &on));
            assert!(near, "{name}: {} at {}", visibility, receiver.position);
        }
    });
    assert!(wrong > 0, "the test is not dense enough");
}

#[test]
fn surfaces_away_from_outlines_and_corners_are_fully_lit() {
    for_each_case(|scene, receiver, visibility, on, name| {
        let edges = |texels: f64| scene.near_outline(receiver, texels, &on);
        if scene.in_shadow(receiver) || [0.5, 1.0, 1.75, 2.5, 3.25, 4.0].into_iter().any(edges) {
            return;
        }
        // Near the foot of a lit wall the filter overlaps the wall: never more than half of it.
        assert!(visibility > 0.5, "{name}: {visibility} at {}", receiver.position);
        let facing = receiver.normal.dot(scene.to_light(receiver.position));
        let reach = 4.5 * scene.texel_m(receiver.position) / facing;
        let p = receiver.position;
        let from_foot = if receiver.normal == DVec3::Y { p.abs().max_element() - 0.5 } else { p.y };
        if p.y == 1.0 || from_foot > reach {
            assert!(visibility > 0.999, "{name}: {visibility} at {p}");
        }
    });
}

#[test]
fn without_any_bias_surfaces_would_shadow_themselves() {
    let none = BiasSettings {
        normal_texels: 0.0,
        slope: 0.0,
        min_slope: 0.0,
        max_slope: 10.0,
        depth_texels: 0.0,
        ..BiasSettings::default()
    };
    let direction = sun_direction(30.0, 25.0);
    let scene = sunlit(direction, 0.03, &none);
    let floor = grid(10, |u, v| DVec3::new(2.0 + u, 0.0, 2.0 + v));
    let lit = floor
        .iter()
        .map(|position| scene.visibility(Receiver { position: *position, normal: DVec3::Y }).unwrap());
    assert!(lit.sum::<f64>() / 100.0 < 0.8);
}

#[test]
fn a_filtered_shadow_edge_is_centred_on_the_exact_edge() {
    // Far from contacts, the middle of the penumbra is at the edge.
    let direction = sun_direction(52.0, 0.0);
    let bias = BiasSettings { normal_texels: 0.0, ..bias() };
    let scene = sunlit(direction, 0.03, &bias);
    let tip = -(0.5 + 1.0 / 52f64.to_radians().tan());
    let mean = |offset_texels: f64| {
        let x = tip + offset_texels * scene.texel_m(DVec3::ZERO) / 52f64.to_radians().sin();
        let points = (0..200).map(|i| DVec3::new(x, 0.0, -0.3 + 0.003 * f64::from(i)));
        points.map(|p| scene.visibility(Receiver { position: p, normal: DVec3::Y }).unwrap()).sum::<f64>()
            / 200.0
    };
    assert!(mean(-1.0) > 0.5 && mean(1.0) < 0.5, "{} {}", mean(-1.0), mean(1.0));
    assert!(mean(-3.6) > 0.999 && mean(3.6) < 0.001);
}

fn spotlit(position: DVec3, target: DVec3, tile_px: u32) -> Analytic {
    let cone = SpotCone {
        position_world: position,
        direction: (target - position).normalize(),
        half_angle: 0.6,
        range_m: 30.0,
    };
    let fit = SpotFit::new(cone, light_from_world(cone.direction).unwrap(), 0.05, tile_px, 4.25);
    let rect = TileRect { x: 0, y: 0, width: tile_px, height: tile_px };
    let map_size_px = [tile_px, tile_px];
    Analytic {
        floor: 0.0,
        block: cube(),
        view: ShadowView::spot(&fit, &placement(rect, map_size_px), DVec3::ZERO),
        light: light(&bias()),
        map_size_px,
    }
}

#[test]
fn spot_shadows_have_correct_outlines_and_no_acne() {
    let (mut covered, mut shadowed) = (0, 0);
    for position in [DVec3::new(3.0, 4.0, 1.0), DVec3::new(6.0, 2.0, -2.0), DVec3::new(0.2, 8.0, 0.1)] {
        for tile_px in [128, 1024] {
            let scene = spotlit(position, DVec3::new(0.2, 0.3, 0.0), tile_px);
            let off_cube = |p: DVec3| p.x.abs() > 0.5 || p.z.abs() > 0.5;
            for at in grid(70, |u, v| DVec3::new(u * 6.0 - 3.0, 0.0, v * 6.0 - 3.0)) {
                let receiver = Receiver { position: at, normal: DVec3::Y };
                let Some(visibility) = scene.visibility(receiver).filter(|_| off_cube(at)) else { continue };
                covered += 1;
                shadowed += usize::from(scene.in_shadow(receiver));
                let edge =
                    |texels: &[f64]| texels.iter().any(|t| scene.near_outline(receiver, *t, &off_cube));
                let name = format!("light {position}, tile {tile_px}: {visibility} at {at}");
                if (visibility > 0.5) == scene.in_shadow(receiver) {
                    assert!(edge(&[0.1, 0.3, 0.6, 1.0, 1.5]), "{name}");
                }
                let foot = at.abs().max_element() - 0.5 < 12.0 * scene.texel_m(at);
                if !scene.in_shadow(receiver) && !foot && !edge(&[0.5, 1.2, 2.0, 2.8, 3.6, 4.5]) {
                    assert!(visibility > 0.999, "{name}");
                }
            }
        }
    }
    assert!(covered > 10_000 && shadowed > 500, "{covered} {shadowed}");
}
