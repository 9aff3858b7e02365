//! The three figures in the shade of the hall, and the lights on them.

use std::f64::consts::PI;

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3};

use super::builder::SceneBuilder;
use super::court::{BACK_Z, FLOOR, FRONT_Z, HALL_BAY};
use super::motion::Motion;
use crate::mesh_builder::{MeshBuilder, box_on_ground, tapered_shaft};
use crate::round::{bulge, lathe, ring, sphere, tube};
use shadowgraph_scene::{Light, LightKind, MeshKey};

const PEDESTAL: f64 = 0.95;
/// Position of the figures between the hall's front and back.
const FIGURE_Z: f64 = BACK_Z + 2.0;

/// Length of the chains of the lanterns, metres.
const CHAIN: f64 = 1.7;

/// Adds figures, lanterns and spot lights.
pub(super) fn build(builder: &mut SceneBuilder) {
    let mut pedestal = box_on_ground(0.95, 0.16, 0.95);
    pedestal.append_translated(&box_on_ground(0.75, PEDESTAL - 0.28, 0.75), DVec3::Y * 0.16);
    pedestal.append_translated(&box_on_ground(0.9, 0.12, 0.9), DVec3::Y * (PEDESTAL - 0.12));
    let pedestal = builder.add_mesh("pedestal", pedestal);
    let lantern = lantern(builder);
    let figures = [("vase", vase()), ("rings", rings()), ("needle", needle())];
    let colors = [
        ("amber", Vec3::new(1.0, 0.50, 0.14)),
        ("teal", Vec3::new(0.10, 0.95, 0.62)),
        ("violet", Vec3::new(0.50, 0.26, 1.0)),
    ];
    let materials = [builder.materials.stone, builder.materials.bronze, builder.materials.stone];
    for (i, ((name, shape), (color_name, color))) in figures.into_iter().zip(colors).enumerate() {
        let x = HALL_BAY * (i as f64 - 1.0);
        let foot = DVec3::new(x, FLOOR, FIGURE_Z);
        builder.add_instance_at("pedestal", pedestal, builder.materials.stone, foot);
        let mesh = builder.add_mesh(name, shape);
        let foot_of_figure = foot + DVec3::Y * PEDESTAL;
        let instance = builder.add_instance_at(name, mesh, materials[i], foot_of_figure);
        if name == "rings" {
            let node = builder.add_moving_node(name, foot_of_figure, DQuat::IDENTITY, Motion::Turn);
            builder.attach_instance(node, instance);
        }
        // From the upper right, so that the shadow on the back wall is to the left of its figure.
        let position = DVec3::new(x + 1.9, FLOOR + 3.7, FRONT_Z - 0.9);
        let target = foot + DVec3::new(-0.35, PEDESTAL + 0.4, 0.0);
        let swing = Motion::Swing { axis: DVec3::Z, angle: 0.09, swings: 5.0 - i as f64 };
        spot(builder, lantern, (color_name, color), [position, target], swing);
    }
    vases(builder);
}

/// Adds a spot light and the model of its lantern, which is behind the tip of the light and swings on a chain.
fn spot(
    builder: &mut SceneBuilder,
    [housing, glass, chain]: [MeshKey; 3],
    (name, color): (&str, Vec3),
    [position, target]: [DVec3; 2],
    swing: Motion,
) {
    let direction = (target - position).normalize();
    let rotation = DQuat::from_rotation_arc(DVec3::Y, direction);
    let place = position - direction * 0.04;
    // The chain ends at the back of the lantern.
    let hook = place - direction * 0.3 + DVec3::Y * CHAIN;
    let pivot = builder.add_moving_node(&format!("{name} chain"), hook, DQuat::IDENTITY, swing);
    let iron = builder.materials.iron;
    let instance = builder.add_instance_at("chain", chain, iron, hook);
    builder.attach_instance(pivot, instance);
    let node = builder.add_node(&format!("{name} lantern"), Some(pivot), place - hook, rotation);
    let transform = DAffine3::from_rotation_translation(rotation, place);
    for (name, mesh, material) in
        [("lantern", housing, iron), ("lantern glass", glass, builder.materials.lantern)]
    {
        let instance = builder.add_instance(name, mesh, material, transform);
        builder.attach_instance(node, instance);
    }
    let facing = DQuat::from_rotation_arc(DVec3::NEG_Z, direction);
    let node = builder.add_node(name, Some(pivot), position - hook, facing);
    let light = builder.scene.insert_light(Light {
        name: Some(name.to_owned()),
        kind: LightKind::Spot {
            position_world: position,
            direction,
            range: Some(14.0),
            inner_angle: 0.36,
            outer_angle: 0.60,
        },
        color,
        intensity: 320_000.0,
        casts_shadow: true,
    });
    builder.attach_light(node, light);
}

/// Adds the meshes of a lantern's housing and glass, which opens along +Y just below the origin, and of the chain below its hook.
fn lantern(builder: &mut SceneBuilder) -> [MeshKey; 3] {
    let run = |points: &[(f64, f64)]| points.iter().map(|&(r, y)| DVec2::new(r, y)).collect::<Vec<_>>();
    let housing = lathe(&[run(&[(0.0, -0.34), (0.06, -0.33), (0.08, -0.28), (0.14, 0.0)])], 16);
    let glass = lathe(&[run(&[(0.135, -0.01), (0.0, -0.01)])], 16);
    let chain = tube(&[DVec3::ZERO, DVec3::NEG_Y * CHAIN], 0.018, 6);
    [("lantern", housing), ("lantern glass", glass), ("chain", chain)]
        .map(|(name, shape)| builder.add_mesh(name, shape))
}

/// Returns a turned vase of about 1.1 m.
fn vase() -> MeshBuilder {
    let belly = (0..=14).map(|i| f64::from(i) / 14.0);
    let radius = |t: f64| 0.13 + 0.27 * (t * PI).sin().powf(1.4) * (1.25 - t * 0.55);
    let belly: Vec<DVec2> = belly.map(|t| DVec2::new(radius(t), 0.1 + t * 0.78)).collect();
    let neck = [(0.13, 0.88), (0.11, 0.98), (0.14, 1.06), (0.21, 1.12)].map(|(r, y)| DVec2::new(r, y));
    let lip = [(0.21, 1.12), (0.15, 1.12)].map(|(r, y)| DVec2::new(r, y));
    let inside = [(0.15, 1.12), (0.08, 0.95), (0.0, 0.95)].map(|(r, y)| DVec2::new(r, y));
    lathe(&[bulge(0.16, 0.0, 0.05, 6), belly, neck.to_vec(), lip.to_vec(), inside.to_vec()], 28)
}

/// Returns two interlocked rings around a ball.
fn rings() -> MeshBuilder {
    let mut shape = MeshBuilder::default();
    let middle = DVec3::Y * 0.66;
    for (radius, rotation) in [(0.58, 0.5), (0.42, -0.9)] {
        let transform = DAffine3::from_translation(middle) * DAffine3::from_rotation_y(rotation);
        shape.append(&ring(radius, 0.06, 40, 12), transform);
    }
    shape.append_translated(&sphere(0.17, 14), middle);
    shape.append_translated(&box_on_ground(0.24, 0.12, 0.24), DVec3::ZERO);
    shape
}

/// Returns a small obelisk with a pyramid on top, on three steps.
fn needle() -> MeshBuilder {
    let mut shape = MeshBuilder::default();
    for (i, width) in [0.62, 0.5, 0.38].into_iter().enumerate() {
        shape.append_translated(&box_on_ground(width, 0.09, width), DVec3::Y * (0.09 * i as f64));
    }
    shape.append_translated(&tapered_shaft(0.27..=1.25, 0.15, 0.09), DVec3::ZERO);
    shape.append_translated(&tapered_shaft(1.25..=1.42, 0.09, 0.002), DVec3::ZERO);
    shape
}

/// Adds vases in the sun, on both sides of the stairs.
fn vases(builder: &mut SceneBuilder) {
    let mesh = builder.add_mesh("garden vase", vase());
    for x in [-6.05, 6.05] {
        let position = DVec3::new(x, FLOOR + 0.12, FRONT_Z + 1.9);
        builder.add_instance_at("garden vase", mesh, builder.materials.stone, position);
    }
}
