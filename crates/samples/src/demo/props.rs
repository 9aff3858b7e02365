//! The objects in the court: ball, fence, flagpole with ropes and a flag, crates, a barrel, banners.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DQuat, DVec2, DVec3};

use super::builder::SceneBuilder;
use super::court::{FLOOR, FRONT_Z, HALL_BAY};
use super::motion::Motion;
use super::textures::FENCE_PANEL;
use crate::mesh_builder::{MeshBuilder, box_on_ground};
use crate::round::{bulge, lathe, rope, sphere, tube};

/// Contact point of the ball with the ground, and its radius, metres.
pub(super) const BALL: (DVec3, f64) = (DVec3::new(2.9, 0.0, 2.6), 0.9);
/// Ends of the fence, which is perpendicular to the sunlight.
const FENCE: (DVec3, DVec3) = (DVec3::new(-2.4, 0.0, -1.9), DVec3::new(0.98, 0.0, 5.35));
const POLE: DVec3 = DVec3::new(-2.3, 0.0, -5.2);
const POLE_HEIGHT: f64 = 8.6;

/// Adds all objects.
pub(super) fn build(builder: &mut SceneBuilder) {
    ball(builder);
    fence(builder);
    flagpole(builder);
    banners(builder);
    crates(builder);
}

fn ball(builder: &mut SceneBuilder) {
    let (foot, radius) = BALL;
    let mesh = builder.add_mesh("ball", sphere(radius, 48));
    builder.add_instance_at("ball", mesh, builder.materials.gold, foot + DVec3::Y * radius);
}

/// Adds alpha-tested panels between solid posts.
fn fence(builder: &mut SceneBuilder) {
    const PANELS: u32 = 4;
    let along = (FENCE.1 - FENCE.0).normalize();
    let rotation = DAffine3::from_rotation_y((-along.z).atan2(along.x));
    let mut panel = MeshBuilder::default();
    panel.parallelogram(DVec3::ZERO, DVec3::X * FENCE_PANEL.x, DVec3::Y * FENCE_PANEL.y);
    let panel = builder.add_mesh("fence panel", panel);
    let mut post = box_on_ground(0.07, FENCE_PANEL.y + 0.06, 0.07);
    post.append_translated(&sphere(0.07, 8), DVec3::Y * (FENCE_PANEL.y + 0.1));
    let post = builder.add_mesh("fence post", post);
    for i in 0..=PANELS {
        let foot = FENCE.0 + along * (FENCE_PANEL.x * f64::from(i));
        let transform = DAffine3::from_translation(foot) * rotation;
        builder.add_instance("fence post", post, builder.materials.iron, transform);
        if i < PANELS {
            builder.add_instance("fence panel", panel, builder.materials.fence, transform);
        }
    }
}

/// Adds a thin pole with a flag in the wind and three ropes to the ground.
fn flagpole(builder: &mut SceneBuilder) {
    let side = [(0.07, 0.3), (0.035, POLE_HEIGHT)].map(|(radius, height)| DVec2::new(radius, height));
    let mut pole = lathe(&[side.to_vec()], 12);
    pole.append_translated(&sphere(0.09, 8), DVec3::Y * (POLE_HEIGHT + 0.04));
    pole.append_translated(&lathe(&[bulge(0.07, 0.18, 0.06, 6)], 12), DVec3::ZERO);
    let mesh = builder.add_mesh("flagpole", pole);
    builder.add_instance_at("flagpole", mesh, builder.materials.iron, POLE);
    let mut foot = box_on_ground(0.7, 0.2, 0.7);
    foot.append_translated(&box_on_ground(0.45, 0.12, 0.45), DVec3::Y * 0.2);
    let foot = builder.add_mesh("flagpole foot", foot);
    builder.add_instance_at("flagpole foot", foot, builder.materials.stone, POLE);
    let mut flag = MeshBuilder::default();
    flag.surface(20, 12, |u, v| {
        let wave = 0.22 * u * (u * 1.6 * TAU - v * 1.2).sin();
        DVec3::new(u * 2.3, -v * 1.5 - 0.18 * u * u, wave)
    });
    let flag = builder.add_mesh("flag", flag);
    let (top, rest) = (POLE + DVec3::new(0.04, POLE_HEIGHT - 0.1, 0.0), DQuat::from_rotation_y(-0.35));
    let transform = DAffine3::from_rotation_translation(rest, top);
    let instance = builder.add_instance("flag", flag, builder.materials.cloth, transform);
    let sway = Motion::Swing { axis: DVec3::Y, angle: 0.22, swings: 3.0 };
    let node = builder.add_moving_node("flag", top, rest, sway);
    builder.attach_instance(node, instance);
    let tie = POLE + DVec3::Y * (POLE_HEIGHT - 2.1);
    let mut ropes = MeshBuilder::default();
    for i in 0..3 {
        let (sin, cos) = (f64::from(i) * TAU / 3.0 + 0.9).sin_cos();
        let stake = POLE + DVec3::new(cos * 2.6, 0.04, sin * 2.6);
        ropes.append_translated(&rope(tie, stake, 0.12, 0.018), DVec3::ZERO);
        let lean = DVec3::new(cos * 0.06, 0.22, sin * 0.06);
        ropes.append_translated(&tube(&[stake - lean * 0.2, stake + lean], 0.03, 6), DVec3::ZERO);
    }
    builder.add_single("ropes", ropes, builder.materials.rope);
}

/// Adds two long banners in front of the hall's inner columns.
fn banners(builder: &mut SceneBuilder) {
    let mut cloth = MeshBuilder::default();
    cloth.surface(10, 24, |u, v| {
        let fold = 0.05 * (u * 2.0 * TAU + v * 2.0).sin() * (0.3 + 0.7 * v);
        DVec3::new((u - 0.5) * 1.1, -v * 2.5, fold + 0.06 * (v * PI).sin())
    });
    let cloth = builder.add_mesh("banner", cloth);
    let rod = builder.add_mesh("banner rod", tube(&[DVec3::NEG_X * 0.68, DVec3::X * 0.68], 0.025, 8));
    for side in [-0.5, 0.5] {
        let top = DVec3::new(side * HALL_BAY, FLOOR + 5.2, FRONT_Z + 0.66);
        let instance = builder.add_instance_at("banner", cloth, builder.materials.cloth, top);
        let sway = Motion::Swing { axis: DVec3::X, angle: 0.08 * side, swings: 4.0 };
        let node = builder.add_moving_node("banner", top, DQuat::IDENTITY, sway);
        builder.attach_instance(node, instance);
        builder.add_instance_at("banner rod", rod, builder.materials.iron, top);
    }
}

/// Adds wooden crates, one of them painted, and a barrel.
fn crates(builder: &mut SceneBuilder) {
    let mesh = builder.add_mesh("crate", wooden_crate());
    let (wood, painted) = (builder.materials.wood, builder.materials.painted);
    let stack = [
        (DVec3::new(8.7, 0.0, 3.9), 0.25, 1.2, wood),
        (DVec3::new(7.4, 0.0, 4.9), -0.2, 0.95, painted),
        (DVec3::new(8.6, 1.2, 3.9), 0.75, 0.8, wood),
        (DVec3::new(-3.4, 0.0, 4.6), 0.5, 0.9, wood),
    ];
    for (position, rotation, size, material) in stack {
        let turned = DAffine3::from_scale_rotation_translation(
            DVec3::splat(size),
            DQuat::from_rotation_y(rotation),
            position,
        );
        builder.add_instance("crate", mesh, material, turned);
    }
    let barrel = builder.add_mesh("barrel", barrel());
    builder.add_instance_at("barrel", barrel, wood, DVec3::new(9.2, 0.0, 5.5));
    builder.add_instance_at("barrel", barrel, painted, DVec3::new(-4.5, 0.0, 3.6));
}

/// Returns a crate of 1 m with a raised frame.
fn wooden_crate() -> MeshBuilder {
    const EDGE: f64 = 0.11;
    let mut shape = MeshBuilder::default();
    shape.append_translated(&box_on_ground(0.94, 0.94, 0.94), DVec3::Y * 0.03);
    let half = 0.5 - EDGE * 0.5;
    for (x, z) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
        shape.append_translated(&box_on_ground(EDGE, 1.0, EDGE), DVec3::new(x, 0.0, z));
    }
    let inner = 1.0 - 2.0 * EDGE;
    for y in [0.0, 1.0 - EDGE] {
        for side in [-half, half] {
            shape.append_translated(&box_on_ground(inner, EDGE, EDGE), DVec3::new(0.0, y, side));
            shape.append_translated(&box_on_ground(EDGE, EDGE, inner), DVec3::new(side, y, 0.0));
        }
    }
    shape
}

/// Returns a barrel of about 1 m with a sunken lid.
fn barrel() -> MeshBuilder {
    let radius = |t: f64| 0.32 + 0.09 * (t * PI).sin();
    let side = (0..=10).map(|i| f64::from(i) / 10.0).map(|t| DVec2::new(radius(t), t * 1.05));
    let rim = [(0.32, 1.05), (0.28, 1.05)].map(|(r, y)| DVec2::new(r, y));
    let inside = [(0.28, 1.05), (0.28, 1.0)].map(|(r, y)| DVec2::new(r, y));
    let lid = [(0.28, 1.0), (0.0, 1.0)].map(|(r, y)| DVec2::new(r, y));
    lathe(&[side.collect(), rim.to_vec(), inside.to_vec(), lid.to_vec()], 24)
}
