//! Cars that drive around blocks.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec3};

use super::builder::CityBuilder;
use super::{BLOCK_M, Block};
use crate::insert::{rotation_curve, translation_curve};
use shadowgraph_scene::animation::{Channel, Property};

/// Blocks with an index below this have traffic.
const BLOCKS: u32 = 250;
/// Cars around each of them.
const CARS: u32 = 2;
/// Time of one round, seconds.
const ROUND_S: f64 = 30.0;
/// Distance of the lane from the centre of the block, and of the beginning of a turn from the corner, metres.
const LANE_M: f64 = BLOCK_M * 0.5 + 4.6;
const TURN_M: f64 = 4.0;

/// Adds the moving cars of a block; returns whether all of them fitted.
pub(super) fn build(block: &mut Block, builder: &mut CityBuilder) -> bool {
    block.index >= BLOCKS || (0..CARS).all(|car| drive(block, builder, car))
}

fn drive(block: &mut Block, builder: &mut CityBuilder, car: u32) -> bool {
    let from = f64::from(car) / f64::from(CARS) + block.random.between(0.0, 0.3);
    let keys = keys(from);
    let (position, rotation) = pose(from);
    let start = block.to_world(position.x, position.y, position.z);
    let node = builder.add_node("car", start, rotation);
    let times_s: Vec<f32> = keys.iter().map(|fraction| ((fraction - from) * ROUND_S) as f32).collect();
    let poses: Vec<(DVec3, DQuat)> = keys.iter().map(|&fraction| pose(fraction)).collect();
    let positions = poses.iter().flat_map(|(at, _)| block.to_world(at.x, at.y, at.z).as_vec3().to_array());
    let rotations = poses.iter().flat_map(|(_, rotation)| rotation.as_quat().to_array());
    builder.animate([
        Channel {
            node,
            property: Property::Translation,
            curve: translation_curve(times_s.clone(), positions.collect()),
        },
        Channel { node, property: Property::Rotation, curve: rotation_curve(times_s, rotations.collect()) },
    ]);
    let paint = block.random.pick(&builder.materials.paints);
    let transform = DAffine3::from_rotation_translation(rotation, start);
    let [windows, wheels] = builder.shapes.car_fittings;
    [(builder.shapes.car, Some(paint)), (windows, None), (wheels, None)].into_iter().all(
        |(part, material)| {
            let instance = builder.add(part, material, transform);
            instance.inspect(|&instance| builder.attach(node, instance)).is_some()
        },
    )
}

/// Returns the moments of a round from a fraction of it on, at which the car begins or ends a turn.
fn keys(from: f64) -> Vec<f64> {
    let turn = TURN_M / (8.0 * LANE_M);
    let turns = (0..=8).flat_map(|corner| [-turn, turn].map(|by| f64::from(corner) * 0.25 + by));
    let within = turns.filter(|&key| key > from + 1e-3 && key < from + 1.0 - 1e-3);
    [from].into_iter().chain(within).chain([from + 1.0]).collect()
}

/// Returns the place relative to the block, and the rotation of a car that drives along +Z, at a fraction of the round. The block is to
/// its right.
fn pose(fraction: f64) -> (DVec3, DQuat) {
    let side = (fraction * 4.0).floor();
    let along = (fraction * 4.0 - side) * 2.0 * LANE_M - LANE_M;
    let heading = DQuat::from_rotation_y(-side * FRAC_PI_2);
    (heading * DVec3::new(LANE_M, 0.0, along), heading)
}
