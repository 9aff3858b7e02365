//! The three figures in the shade of the hall, and the lights on them.

use std::f64::consts::PI;

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3};

use super::builder::SceneBuilder;
use super::court::{BACK_Z, FLOOR, FRONT_Z, HALL_BAY};
use crate::mesh_builder::{MeshBuilder, box_on_ground, tapered_shaft};
use crate::round::{bulge, lathe, ring, sphere};
use shadowgraph_scene::{Light, LightKind, MeshKey};

const PEDESTAL: f64 = 0.95;
/// Position of the figures between the hall's front and back.
const FIGURE_Z: f64 = BACK_Z + 2.0;

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
        builder.add_instance_at(name, mesh, materials[i], foot + DVec3::Y * PEDESTAL);
        // From the upper right, so that the shadow on the back wall is to the left of its figure.
        let position = DVec3::new(x + 1.9, FLOOR + 3.7, FRONT_Z - 0.9);
        let target = foot + DVec3::new(-0.35, PEDESTAL + 0.4, 0.0);
        spot(builder, lantern, color_name, color, position, target);
    }
    vases(builder);
}

/// Adds a spot light and the model of its lantern, which is behind the tip of the light.
fn spot(
    builder: &mut SceneBuilder,
    lantern: [MeshKey; 2],
    name: &str,
    color: Vec3,
    position: DVec3,
    target: DVec3,
) {
    let direction = (target - position).normalize();
    let rotation = DQuat::from_rotation_arc(DVec3::Y, direction);
    let transform = DAffine3::from_rotation_translation(rotation, position - direction * 0.04);
    builder.add_instance("lantern", lantern[0], builder.materials.iron, transform);
    builder.add_instance("lantern glass", lantern[1], builder.materials.lantern, transform);
    builder.scene.insert_light(Light {
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
}

/// Adds the meshes of a lantern's housing and glass, which opens along +Y just below the origin.
fn lantern(builder: &mut SceneBuilder) -> [MeshKey; 2] {
    let run = |points: &[(f64, f64)]| points.iter().map(|&(r, y)| DVec2::new(r, y)).collect::<Vec<_>>();
    let housing = lathe(&[run(&[(0.0, -0.34), (0.06, -0.33), (0.08, -0.28), (0.14, 0.0)])], 16);
    let glass = lathe(&[run(&[(0.135, -0.01), (0.0, -0.01)])], 16);
    [builder.add_mesh("lantern", housing), builder.add_mesh("lantern glass", glass)]
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
