//! The courtyard itself: ground, walls, stairs, the arcade in the west and the hall in the north.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DVec3};

use super::arch::{ArchBay, column};
use super::builder::SceneBuilder;
use crate::mesh_builder::{MeshBuilder, SurfacePoint, box_on_ground, cuboid};

/// Height of the hall's floor above the court, metres.
pub(super) const FLOOR: f64 = 0.9;
/// Centre of the hall's front wall.
pub(super) const FRONT_Z: f64 = -10.3;
/// Inner face of the hall's back wall.
pub(super) const BACK_Z: f64 = -15.4;
/// Width of a bay of the hall.
pub(super) const HALL_BAY: f64 = 5.6;

const STEPS: u32 = 4;
const HALL_WALL: ArchBay =
    ArchBay { width: HALL_BAY, radius: 2.35, height: 3.4, thickness: 0.7, segments: 32 };
const HALL_COLUMN: f64 = 2.5;
const ARCADE_WALL: ArchBay = ArchBay { width: 4.2, radius: 1.65, height: 2.6, thickness: 0.7, segments: 28 };
const ARCADE_COLUMN: f64 = 3.4;

/// Adds everything that is built of stone.
pub(super) fn build(builder: &mut SceneBuilder) {
    ground(builder);
    low_walls(builder);
    stairs(builder);
    arcade(builder);
    hall_front(builder);
    hall_room(builder);
}

/// Adds a wide plain, divided into cells to avoid huge triangles, and the paved court on it.
fn ground(builder: &mut SceneBuilder) {
    const HALF: f64 = 235.0;
    let mut plain = MeshBuilder::default();
    plain.grid(24, 24, |u, v| {
        let position = DVec3::new((u * 2.0 - 1.0) * HALF, -0.15, (v * 2.0 - 1.0) * HALF);
        SurfacePoint { position, normal: DVec3::Y, uv: glam::DVec2::new(position.x, position.z) }
    });
    builder.add_single("plain", plain, builder.materials.earth);
    let court = cuboid(DVec3::new(-15.0, -0.6, -16.4), DVec3::new(15.0, 0.0, 18.0));
    builder.add_single("court", court, builder.materials.paving);
}

/// Adds a low wall with piers in the east.
fn low_walls(builder: &mut SceneBuilder) {
    let mut wall = cuboid(DVec3::new(13.2, 0.0, -14.0), DVec3::new(13.7, 0.95, 14.0));
    wall.append_translated(&cuboid(DVec3::ZERO, DVec3::new(0.7, 0.14, 28.0)), DVec3::new(13.1, 0.95, -14.0));
    builder.add_single("east wall", wall, builder.materials.masonry);
    let mut pier = box_on_ground(0.9, 1.35, 0.9);
    pier.append_translated(&box_on_ground(1.1, 0.16, 1.1), DVec3::Y * 1.35);
    let pier = builder.add_mesh("pier", pier);
    for i in 0..5 {
        let position = DVec3::new(13.45, 0.0, -14.0 + 7.0 * f64::from(i));
        builder.add_instance_at("pier", pier, builder.materials.stone, position);
    }
}

/// Adds the steps up to the hall, between two blocks with vases.
fn stairs(builder: &mut SceneBuilder) {
    const HALF_WIDTH: f64 = 5.6;
    const TREAD: f64 = 0.5;
    let top = FRONT_Z + 0.55;
    let rise = FLOOR / f64::from(STEPS);
    let mut steps = MeshBuilder::default();
    for i in 0..STEPS {
        let front = top + TREAD * f64::from(STEPS - 1 - i);
        let bottom = rise * f64::from(i);
        let back = FRONT_Z - 0.5;
        steps.append_translated(
            &cuboid(DVec3::new(-HALF_WIDTH, 0.0, back), DVec3::new(HALF_WIDTH, rise, front)),
            DVec3::Y * bottom,
        );
    }
    builder.add_single("stairs", steps, builder.materials.stone);
    let cheek = builder.add_mesh("cheek", box_on_ground(0.9, FLOOR + 0.12, 3.0));
    for (side, name) in [(-1.0, "west cheek"), (1.0, "east cheek")] {
        let position = DVec3::new(side * (HALF_WIDTH + 0.45), 0.0, top + 0.4);
        builder.add_instance_at(name, cheek, builder.materials.stone, position);
    }
}

/// Adds five open arches along the west side, through which the sun shines.
fn arcade(builder: &mut SceneBuilder) {
    const X: f64 = -11.2;
    const SOUTH: f64 = 10.4;
    let bay = builder.add_mesh("arcade bay", ARCADE_WALL.shape());
    let column = builder.add_mesh("arcade column", column(ARCADE_COLUMN, 0.36));
    for i in 0..=5 {
        let z = SOUTH - ARCADE_WALL.width * f64::from(i);
        builder.add_instance_at("arcade column", column, builder.materials.stone, DVec3::new(X, 0.0, z));
        if i < 5 {
            let middle = DVec3::new(X, ARCADE_COLUMN, z - ARCADE_WALL.width * 0.5);
            let transform = DAffine3::from_translation(middle) * DAffine3::from_rotation_y(FRAC_PI_2);
            builder.add_instance("arcade bay", bay, builder.materials.masonry, transform);
        }
    }
}

/// Adds three wide arches on columns, open to the court.
fn hall_front(builder: &mut SceneBuilder) {
    let bay = builder.add_mesh("hall bay", HALL_WALL.shape());
    let column = builder.add_mesh("hall column", column(HALL_COLUMN, 0.4));
    for i in 0..4 {
        let x = HALL_BAY * (f64::from(i) - 1.5);
        builder.add_instance_at(
            "hall column",
            column,
            builder.materials.stone,
            DVec3::new(x, FLOOR, FRONT_Z),
        );
        if i < 3 {
            let middle = DVec3::new(x + HALL_BAY * 0.5, FLOOR + HALL_COLUMN, FRONT_Z);
            builder.add_instance_at("hall bay", bay, builder.materials.masonry, middle);
        }
    }
}

/// Adds a floor, three walls and a roof: a shaded room for the spot lights.
fn hall_room(builder: &mut SceneBuilder) {
    let half = HALL_BAY * 1.5 + 0.5;
    let roof = FLOOR + HALL_COLUMN + HALL_WALL.height;
    let front = FRONT_Z + 0.35;
    let mut floor = cuboid(DVec3::new(-half, 0.0, BACK_Z - 0.6), DVec3::new(-5.6, FLOOR, front));
    floor.append_translated(&cuboid(DVec3::ZERO, DVec3::new(half - 5.6, FLOOR, front - BACK_Z + 0.6)), {
        DVec3::new(5.6, 0.0, BACK_Z - 0.6)
    });
    let between = cuboid(DVec3::new(-5.6, 0.0, BACK_Z - 0.6), DVec3::new(5.6, FLOOR, FRONT_Z - 0.5));
    floor.append_translated(&between, DVec3::ZERO);
    builder.add_single("hall floor", floor, builder.materials.paving);
    let mut walls = cuboid(DVec3::new(-half, FLOOR, BACK_Z - 0.6), DVec3::new(half, roof, BACK_Z));
    for side in [-1.0, 1.0] {
        let x = side * (half - 0.25);
        let depth = FRONT_Z - 0.35 - BACK_Z;
        let wall = box_on_ground(0.5, roof - FLOOR, depth);
        walls.append_translated(&wall, DVec3::new(x, FLOOR, BACK_Z + depth * 0.5));
    }
    builder.add_single("hall walls", walls, builder.materials.plaster);
    let mut slab =
        cuboid(DVec3::new(-half - 0.3, 0.0, BACK_Z - 0.9), DVec3::new(half + 0.3, 0.35, front + 0.3));
    slab.append_translated(
        &cuboid(DVec3::new(-half, 0.35, BACK_Z - 0.6), DVec3::new(half, 0.8, front)),
        DVec3::ZERO,
    );
    let mut roof_mesh = MeshBuilder::default();
    roof_mesh.append_translated(&slab, DVec3::Y * roof);
    builder.add_single("hall roof", roof_mesh, builder.materials.masonry);
}
