//! The ground of a block: roadway, pavement, trees, street lights and parked cars.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DAffine3, DQuat, DVec3, Vec3};

use super::builder::CityBuilder;
use super::shapes::LENS;
use super::{BLOCK_M, Block, KERB_M, PITCH_M};
use shadowgraph_scene::{Light, LightKind};

/// Trees up to this ring have many leaves.
const NEAR_RINGS: u32 = 2;

/// Adds everything but buildings and what drives; returns whether all of it fitted.
pub(super) fn build(block: &mut Block, builder: &mut CityBuilder) -> bool {
    let roadway = DAffine3::from_scale_rotation_translation(
        DVec3::new(PITCH_M, 1.0, PITCH_M),
        DQuat::IDENTITY,
        block.to_world(0.0, 0.0, 0.0),
    );
    let pavement = DVec3::new(BLOCK_M, KERB_M, BLOCK_M);
    builder.add(builder.shapes.plane, None, roadway).is_some()
        && builder.add_box(builder.materials.pavement, block.to_world(0.0, 0.0, 0.0), pavement)
        && (0..4).all(|side| edge(block, builder, side))
}

/// Adds the trees, the street lights and the parked cars along one side.
fn edge(block: &mut Block, builder: &mut CityBuilder, side: u32) -> bool {
    let turn = DQuat::from_rotation_y(f64::from(side) * FRAC_PI_2);
    let place = |along: f64, out: f64, height: f64| turn * DVec3::new(along, height, BLOCK_M * 0.5 + out);
    let at = |block: &Block, place: DVec3| block.to_world(place.x, place.y, place.z);
    let lights = (0..6).all(|index| {
        let foot = at(block, place(f64::from(index) * 9.6 - 24.0, -0.7, KERB_M));
        builder.insert_street_light(street_light(foot + turn * DVec3::new(0.0, LENS.y - 0.1, LENS.x)));
        let parts = builder.shapes.street_light;
        builder.add_all(&parts, DAffine3::from_rotation_translation(turn, foot))
    });
    lights
        && (0..10).all(|index| {
            let foot = at(block, place(f64::from(index) * 5.2 - 23.4, -2.0, KERB_M));
            tree(block, builder, foot)
        })
        && (0..7).all(|index| {
            if block.random.happens(0.45) {
                return true;
            }
            let foot = at(block, place(f64::from(index) * 6.6 - 19.8, 1.3, 0.0));
            let turn = turn * DQuat::from_rotation_y(FRAC_PI_2);
            let paint = block.random.pick(&builder.materials.paints);
            let transform = DAffine3::from_rotation_translation(turn, foot);
            let fittings = builder.shapes.car_fittings;
            builder.add(builder.shapes.car, Some(paint), transform).is_some()
                && builder.add_all(&fittings, transform)
        })
}

/// Adds a tree of a random size and turn.
fn tree(block: &mut Block, builder: &mut CityBuilder, foot: DVec3) -> bool {
    let turn = DQuat::from_rotation_y(block.random.between(0.0, TAU));
    let scale = DVec3::splat(block.random.between(0.7, 1.1));
    let parts = if block.ring <= NEAR_RINGS { builder.shapes.tree } else { builder.shapes.far_tree };
    builder.add_all(&parts, DAffine3::from_scale_rotation_translation(scale, turn, foot))
}

/// Adds a lawn with trees.
pub(super) fn park(block: &mut Block, builder: &mut CityBuilder) -> bool {
    let size = DVec3::new(48.0, KERB_M + 0.06, 48.0);
    builder.add_box(builder.materials.lawn, block.to_world(0.0, 0.0, 0.0), size)
        && (0..16).all(|index| {
            let x = f64::from(index % 4) * 12.0 - 18.0 + block.random.between(-3.0, 3.0);
            let z = f64::from(index / 4) * 12.0 - 18.0 + block.random.between(-3.0, 3.0);
            let foot = block.to_world(x, KERB_M + 0.06, z);
            tree(block, builder, foot)
        })
}

/// Returns the light of a street light.
fn street_light(position_world: DVec3) -> Light {
    Light {
        name: Some("street light".to_owned()),
        kind: LightKind::Spot {
            position_world,
            direction: DVec3::NEG_Y,
            range: Some(16.0),
            inner_angle: 0.7,
            outer_angle: 1.15,
        },
        color: Vec3::new(1.0, 0.72, 0.42),
        intensity: 12_000.0,
        casts_shadow: true,
    }
}
