//! The courtyard itself: ground, walls, stairs, the arcade in the west and the hall in the north.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DVec3};

use super::arch::{ArchBay, column};
use super::stage::Stage;
use crate::solids::shape::{Point, Shape, cuboid, standing_box};

/// Height of the hall's floor over the court, metres.
pub(super) const FLOOR: f64 = 0.9;
/// Middle of the hall's front wall.
pub(super) const FRONT_Z: f64 = -10.3;
/// The hall's back wall, seen from inside.
pub(super) const BACK_Z: f64 = -15.4;
/// Width of a bay of the hall.
pub(super) const HALL_BAY: f64 = 5.6;

const STEPS: u32 = 6;
const HALL_WALL: ArchBay =
    ArchBay { width: HALL_BAY, radius: 2.35, height: 3.4, thickness: 0.7, segments: 32 };
const HALL_COLUMN: f64 = 2.5;
const ARCADE_WALL: ArchBay = ArchBay { width: 4.2, radius: 1.65, height: 2.6, thickness: 0.7, segments: 28 };
const ARCADE_COLUMN: f64 = 3.4;

/// Adds everything built of stone.
pub(super) fn build(stage: &mut Stage) {
    ground(stage);
    low_walls(stage);
    stairs(stage);
    arcade(stage);
    hall_front(stage);
    hall_room(stage);
}

/// A wide plain, cut into cells so that no triangle is as large as the world, and the paved court on it.
fn ground(stage: &mut Stage) {
    const HALF: f64 = 235.0;
    let mut plain = Shape::default();
    plain.grid(24, 24, |u, v| {
        let position = DVec3::new((u * 2.0 - 1.0) * HALF, -0.15, (v * 2.0 - 1.0) * HALF);
        Point { position, normal: DVec3::Y, uv: glam::DVec2::new(position.x, position.z) }
    });
    stage.add("plain", plain, stage.paint.earth);
    let court = cuboid(DVec3::new(-15.0, -0.6, -16.4), DVec3::new(15.0, 0.0, 18.0));
    stage.add("court", court, stage.paint.paving);
}

/// A wall of sitting height in the east, with piers.
fn low_walls(stage: &mut Stage) {
    let mut wall = cuboid(DVec3::new(13.2, 0.0, -14.0), DVec3::new(13.7, 0.95, 14.0));
    wall.append_at(&cuboid(DVec3::ZERO, DVec3::new(0.7, 0.14, 28.0)), DVec3::new(13.1, 0.95, -14.0));
    stage.add("east wall", wall, stage.paint.masonry);
    let mut pier = standing_box(0.9, 1.35, 0.9);
    pier.append_at(&standing_box(1.1, 0.16, 1.1), DVec3::Y * 1.35);
    let pier = stage.mesh("pier", pier);
    for i in 0..5 {
        let position = DVec3::new(13.45, 0.0, -14.0 + 7.0 * f64::from(i));
        stage.place_at("pier", pier, stage.paint.stone, position);
    }
}

/// Steps up to the hall between two blocks that carry vases.
fn stairs(stage: &mut Stage) {
    const HALF_WIDTH: f64 = 5.6;
    const TREAD: f64 = 0.36;
    let top = FRONT_Z + 0.55;
    let rise = FLOOR / f64::from(STEPS);
    let mut steps = Shape::default();
    for i in 0..STEPS {
        let front = top + TREAD * f64::from(STEPS - 1 - i);
        let bottom = rise * f64::from(i);
        let back = FRONT_Z - 0.5;
        steps.append_at(
            &cuboid(DVec3::new(-HALF_WIDTH, 0.0, back), DVec3::new(HALF_WIDTH, rise, front)),
            DVec3::Y * bottom,
        );
    }
    stage.add("stairs", steps, stage.paint.stone);
    let cheek = stage.mesh("cheek", standing_box(0.9, FLOOR + 0.12, 3.0));
    for (side, name) in [(-1.0, "west cheek"), (1.0, "east cheek")] {
        let position = DVec3::new(side * (HALF_WIDTH + 0.45), 0.0, top + 0.4);
        stage.place_at(name, cheek, stage.paint.stone, position);
    }
}

/// Five open arches along the west side: the sun comes through them.
fn arcade(stage: &mut Stage) {
    const X: f64 = -11.2;
    const SOUTH: f64 = 10.4;
    let bay = stage.mesh("arcade bay", ARCADE_WALL.shape());
    let column = stage.mesh("arcade column", column(ARCADE_COLUMN, 0.36));
    for i in 0..=5 {
        let z = SOUTH - ARCADE_WALL.width * f64::from(i);
        stage.place_at("arcade column", column, stage.paint.stone, DVec3::new(X, 0.0, z));
        if i < 5 {
            let middle = DVec3::new(X, ARCADE_COLUMN, z - ARCADE_WALL.width * 0.5);
            let placed = DAffine3::from_translation(middle) * DAffine3::from_rotation_y(FRAC_PI_2);
            stage.place("arcade bay", bay, stage.paint.masonry, placed);
        }
    }
}

/// Three wide arches on columns, open to the court.
fn hall_front(stage: &mut Stage) {
    let bay = stage.mesh("hall bay", HALL_WALL.shape());
    let column = stage.mesh("hall column", column(HALL_COLUMN, 0.4));
    for i in 0..4 {
        let x = HALL_BAY * (f64::from(i) - 1.5);
        stage.place_at("hall column", column, stage.paint.stone, DVec3::new(x, FLOOR, FRONT_Z));
        if i < 3 {
            let middle = DVec3::new(x + HALL_BAY * 0.5, FLOOR + HALL_COLUMN, FRONT_Z);
            stage.place_at("hall bay", bay, stage.paint.masonry, middle);
        }
    }
}

/// Floor, three walls and a roof: a room in the shade for the spot lights.
fn hall_room(stage: &mut Stage) {
    let half = HALL_BAY * 1.5 + 0.5;
    let roof = FLOOR + HALL_COLUMN + HALL_WALL.height;
    let front = FRONT_Z + 0.35;
    let mut floor = cuboid(DVec3::new(-half, 0.0, BACK_Z - 0.6), DVec3::new(-5.6, FLOOR, front));
    floor.append_at(&cuboid(DVec3::ZERO, DVec3::new(half - 5.6, FLOOR, front - BACK_Z + 0.6)), {
        DVec3::new(5.6, 0.0, BACK_Z - 0.6)
    });
    let between = cuboid(DVec3::new(-5.6, 0.0, BACK_Z - 0.6), DVec3::new(5.6, FLOOR, FRONT_Z - 0.5));
    floor.append_at(&between, DVec3::ZERO);
    stage.add("hall floor", floor, stage.paint.paving);
    let mut walls = cuboid(DVec3::new(-half, FLOOR, BACK_Z - 0.6), DVec3::new(half, roof, BACK_Z));
    for side in [-1.0, 1.0] {
        let x = side * (half - 0.25);
        let depth = FRONT_Z - 0.35 - BACK_Z;
        let wall = standing_box(0.5, roof - FLOOR, depth);
        walls.append_at(&wall, DVec3::new(x, FLOOR, BACK_Z + depth * 0.5));
    }
    stage.add("hall walls", walls, stage.paint.plaster);
    let mut slab =
        cuboid(DVec3::new(-half - 0.3, 0.0, BACK_Z - 0.9), DVec3::new(half + 0.3, 0.35, front + 0.3));
    slab.append_at(&cuboid(DVec3::new(-half, 0.35, BACK_Z - 0.6), DVec3::new(half, 0.8, front)), DVec3::ZERO);
    let mut placed = Shape::default();
    placed.append_at(&slab, DVec3::Y * roof);
    stage.add("hall roof", placed, stage.paint.masonry);
}
