//! What stands in the court: ball, fence, flagpole with ropes and a flag, crates, a barrel, banners.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec2, DVec3};

use super::court::{FLOOR, FRONT_Z, HALL_BAY};
use super::pictures::FENCE_PANEL;
use super::stage::Stage;
use crate::solids::round::{bulge, lathe, rope, sphere, tube};
use crate::solids::shape::{Shape, standing_box};

/// Where the ball touches the ground, and its radius, metres.
pub(super) const BALL: (DVec3, f64) = (DVec3::new(2.9, 0.0, 2.6), 0.9);
/// Ends of the fence; the sun shines square onto it.
const FENCE: (DVec3, DVec3) = (DVec3::new(-2.4, 0.0, -1.9), DVec3::new(0.98, 0.0, 5.35));
const POLE: DVec3 = DVec3::new(-2.3, 0.0, -5.2);
const POLE_HEIGHT: f64 = 8.6;

/// Adds all of it.
pub(super) fn build(stage: &mut Stage) {
    ball(stage);
    fence(stage);
    flagpole(stage);
    banners(stage);
    crates(stage);
}

fn ball(stage: &mut Stage) {
    let (foot, radius) = BALL;
    let mesh = stage.mesh("ball", sphere(radius, 32));
    stage.place_at("ball", mesh, stage.paint.bronze, foot + DVec3::Y * radius);
}

/// Panels with the iron in their alpha, between solid posts.
fn fence(stage: &mut Stage) {
    const PANELS: u32 = 4;
    let along = (FENCE.1 - FENCE.0).normalize();
    let turn = DAffine3::from_rotation_y((-along.z).atan2(along.x));
    let mut panel = Shape::default();
    panel.parallelogram(DVec3::ZERO, DVec3::X * FENCE_PANEL.x, DVec3::Y * FENCE_PANEL.y);
    let panel = stage.mesh("fence panel", panel);
    let mut post = standing_box(0.07, FENCE_PANEL.y + 0.06, 0.07);
    post.append_at(&sphere(0.07, 8), DVec3::Y * (FENCE_PANEL.y + 0.1));
    let post = stage.mesh("fence post", post);
    for i in 0..=PANELS {
        let foot = FENCE.0 + along * (FENCE_PANEL.x * f64::from(i));
        let placed = DAffine3::from_translation(foot) * turn;
        stage.place("fence post", post, stage.paint.iron, placed);
        if i < PANELS {
            stage.place("fence panel", panel, stage.paint.fence, placed);
        }
    }
}

/// A thin pole with a flag in the wind and three ropes to the ground.
fn flagpole(stage: &mut Stage) {
    let side = [(0.07, 0.3), (0.035, POLE_HEIGHT)].map(|(radius, height)| DVec2::new(radius, height));
    let mut pole = lathe(&[side.to_vec()], 12);
    pole.append_at(&sphere(0.09, 8), DVec3::Y * (POLE_HEIGHT + 0.04));
    pole.append_at(&lathe(&[bulge(0.07, 0.18, 0.06, 6)], 12), DVec3::ZERO);
    let mesh = stage.mesh("flagpole", pole);
    stage.place_at("flagpole", mesh, stage.paint.iron, POLE);
    let mut foot = standing_box(0.7, 0.2, 0.7);
    foot.append_at(&standing_box(0.45, 0.12, 0.45), DVec3::Y * 0.2);
    let foot = stage.mesh("flagpole foot", foot);
    stage.place_at("flagpole foot", foot, stage.paint.stone, POLE);
    let mut flag = Shape::default();
    flag.surface(20, 12, |u, v| {
        let wave = 0.22 * u * (u * 1.6 * TAU - v * 1.2).sin();
        DVec3::new(u * 2.3, -v * 1.5 - 0.18 * u * u, wave)
    });
    let flag = stage.mesh("flag", flag);
    let wind = DAffine3::from_translation(POLE + DVec3::new(0.04, POLE_HEIGHT - 0.1, 0.0));
    stage.place("flag", flag, stage.paint.cloth, wind * DAffine3::from_rotation_y(-0.35));
    let tie = POLE + DVec3::Y * (POLE_HEIGHT - 2.1);
    let mut ropes = Shape::default();
    for i in 0..3 {
        let (sin, cos) = (f64::from(i) * TAU / 3.0 + 0.9).sin_cos();
        let stake = POLE + DVec3::new(cos * 2.6, 0.04, sin * 2.6);
        ropes.append_at(&rope(tie, stake, 0.12, 0.018), DVec3::ZERO);
        let lean = DVec3::new(cos * 0.06, 0.22, sin * 0.06);
        ropes.append_at(&tube(&[stake - lean * 0.2, stake + lean], 0.03, 6), DVec3::ZERO);
    }
    stage.add("ropes", ropes, stage.paint.rope);
}

/// Two long banners before the hall's inner columns.
fn banners(stage: &mut Stage) {
    let mut cloth = Shape::default();
    cloth.surface(10, 24, |u, v| {
        let fold = 0.05 * (u * 2.0 * TAU + v * 2.0).sin() * (0.3 + 0.7 * v);
        DVec3::new((u - 0.5) * 1.1, -v * 2.5, fold + 0.06 * (v * PI).sin())
    });
    let cloth = stage.mesh("banner", cloth);
    let rod = stage.mesh("banner rod", tube(&[DVec3::NEG_X * 0.68, DVec3::X * 0.68], 0.025, 8));
    for side in [-0.5, 0.5] {
        let top = DVec3::new(side * HALL_BAY, FLOOR + 5.2, FRONT_Z + 0.56);
        stage.place_at("banner", cloth, stage.paint.cloth, top);
        stage.place_at("banner rod", rod, stage.paint.iron, top);
    }
}

/// Wooden crates, one of them painted, and a barrel.
fn crates(stage: &mut Stage) {
    let mesh = stage.mesh("crate", wooden_crate());
    let (wood, painted) = (stage.paint.wood, stage.paint.painted);
    let stack = [
        (DVec3::new(8.7, 0.0, 3.9), 0.25, 1.2, wood),
        (DVec3::new(7.4, 0.0, 4.9), -0.2, 0.95, painted),
        (DVec3::new(8.6, 1.2, 3.9), 0.75, 0.8, wood),
        (DVec3::new(-3.4, 0.0, 4.6), 0.5, 0.9, wood),
    ];
    for (position, turn, size, material) in stack {
        let turned = DAffine3::from_scale_rotation_translation(
            DVec3::splat(size),
            glam::DQuat::from_rotation_y(turn),
            position,
        );
        stage.place("crate", mesh, material, turned);
    }
    let barrel = stage.mesh("barrel", barrel());
    stage.place_at("barrel", barrel, wood, DVec3::new(9.2, 0.0, 5.5));
    stage.place_at("barrel", barrel, painted, DVec3::new(-4.5, 0.0, 3.6));
}

/// A crate of 1 m with a raised frame.
fn wooden_crate() -> Shape {
    const EDGE: f64 = 0.11;
    let mut shape = Shape::default();
    shape.append_at(&standing_box(0.94, 0.94, 0.94), DVec3::Y * 0.03);
    let half = 0.5 - EDGE * 0.5;
    for (x, z) in [(-half, -half), (half, -half), (-half, half), (half, half)] {
        shape.append_at(&standing_box(EDGE, 1.0, EDGE), DVec3::new(x, 0.0, z));
    }
    let inner = 1.0 - 2.0 * EDGE;
    for y in [0.0, 1.0 - EDGE] {
        for side in [-half, half] {
            shape.append_at(&standing_box(inner, EDGE, EDGE), DVec3::new(0.0, y, side));
            shape.append_at(&standing_box(EDGE, EDGE, inner), DVec3::new(side, y, 0.0));
        }
    }
    shape
}

/// A barrel of about 1 m with a sunken lid.
fn barrel() -> Shape {
    let radius = |t: f64| 0.32 + 0.09 * (t * PI).sin();
    let side = (0..=10).map(|i| f64::from(i) / 10.0).map(|t| DVec2::new(radius(t), t * 1.05));
    let rim = [(0.32, 1.05), (0.28, 1.05)].map(|(r, y)| DVec2::new(r, y));
    let inside = [(0.28, 1.05), (0.28, 1.0)].map(|(r, y)| DVec2::new(r, y));
    let lid = [(0.28, 1.0), (0.0, 1.0)].map(|(r, y)| DVec2::new(r, y));
    lathe(&[side.collect(), rim.to_vec(), inside.to_vec(), lid.to_vec()], 24)
}
