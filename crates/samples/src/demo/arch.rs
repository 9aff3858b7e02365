//! Columns and arches.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::mesh_builder::{MeshBuilder, SurfacePoint, box_on_ground, cuboid};
use crate::round::{bulge, lathe};

/// A wall along X with a round opening, centred in Z, with its spring line at y = 0. Lengths in metres.
#[derive(Clone, Copy)]
pub(super) struct ArchBay {
    /// Distance between the centres of neighbouring columns.
    pub(super) width: f64,
    /// Radius of the opening, less than half the width.
    pub(super) radius: f64,
    /// Height of the wall above the spring line, more than the radius.
    pub(super) height: f64,
    /// Thickness of the wall.
    pub(super) thickness: f64,
    /// Segments of the half circle.
    pub(super) segments: u32,
}

impl ArchBay {
    /// Returns the wall with its opening, the moulding around it, a keystone and a cornice.
    pub(super) fn shape(&self) -> MeshBuilder {
        let mut shape = self.wall();
        self.add_moulding(&mut shape);
        let (half_width, half_depth) = (self.width * 0.5, self.thickness * 0.5);
        let out = DVec3::new(0.21, 0.36, half_depth + 0.13);
        let key = DVec3::Y * (self.radius + 0.25);
        shape.append_translated(&cuboid(-out, out), key);
        for (drop, rise, overhang) in [(0.36, 0.14, 0.09), (0.22, 0.22, 0.22)] {
            let bottom = self.height - drop;
            shape.append_translated(
                &cuboid(
                    DVec3::new(-half_width, 0.0, -half_depth - overhang),
                    DVec3::new(half_width, rise, half_depth + overhang),
                ),
                DVec3::Y * bottom,
            );
        }
        shape
    }

    /// Returns only the wall and the inside of the opening, for distant arches.
    pub(super) fn wall(&self) -> MeshBuilder {
        let (half_width, half_depth) = (self.width * 0.5, self.thickness * 0.5);
        let size = DVec3::new(half_width - self.radius, self.height, self.thickness);
        let mut shape = MeshBuilder::default();
        for left in [-half_width, self.radius] {
            let min = DVec3::new(left, 0.0, -half_depth);
            shape.append_translated(&cuboid(DVec3::ZERO, size), min);
        }
        for side in [-1.0, 1.0] {
            // Straight strips from the half circle up to the top of the wall.
            shape.grid(self.segments, 1, |u, v| {
                let (sin, cos) = (PI * (1.0 - u)).sin_cos();
                let bottom = sin * self.radius;
                let position =
                    DVec3::new(cos * self.radius, bottom + (self.height - bottom) * v, side * half_depth);
                SurfacePoint { position, normal: DVec3::Z * side, uv: DVec2::new(position.x, -position.y) }
            });
        }
        shape.grid(self.segments, 1, |u, v| {
            let (sin, cos) = (PI * u).sin_cos();
            let z = half_depth * (v * 2.0 - 1.0);
            SurfacePoint {
                position: DVec3::new(cos * self.radius, sin * self.radius, z),
                normal: DVec3::new(-cos, -sin, 0.0),
                uv: DVec2::new(u * PI * self.radius, z),
            }
        });
        let top = DVec3::new(-self.radius, self.height, half_depth);
        shape.parallelogram(top, DVec3::X * self.radius * 2.0, DVec3::NEG_Z * self.thickness);
        shape
    }

    /// Adds a raised band around the opening, on both faces.
    fn add_moulding(&self, shape: &mut MeshBuilder) {
        const WIDTH: f64 = 0.24;
        const RAISED: f64 = 0.08;
        for side in [-1.0, 1.0] {
            let face = side * self.thickness * 0.5;
            let (inner, outer, front) = (self.radius, self.radius + WIDTH, face + side * RAISED);
            let pieces = [
                ((inner, face), (inner, front), (-1.0, 0.0)),
                ((inner, front), (outer, front), (0.0, side)),
                ((outer, front), (outer, face), (1.0, 0.0)),
            ];
            for ((r0, z0), (r1, z1), (normal_r, normal_z)) in pieces {
                shape.grid(self.segments, 1, |u, v| {
                    let (sin, cos) = (PI * u).sin_cos();
                    let (r, z) = (r0 + (r1 - r0) * v, z0 + (z1 - z0) * v);
                    SurfacePoint {
                        position: DVec3::new(cos * r, sin * r, z),
                        normal: DVec3::new(cos * normal_r, sin * normal_r, normal_z),
                        uv: DVec2::new(u * PI * self.radius, r + z),
                    }
                });
            }
            for x in [-outer, inner] {
                let corner = DVec3::new(x, 0.0, face.min(front));
                shape.parallelogram(corner, DVec3::X * WIDTH, DVec3::Z * RAISED);
            }
        }
    }
}

/// Returns a column of this height on the ground, with a square base, a swelling shaft and a capital.
pub(super) fn column(height: f64, radius: f64) -> MeshBuilder {
    let (shaft_bottom, shaft_top) = (0.46, height - 0.5);
    // The shaft swells slightly before it tapers (entasis).
    let shaft_radius = |t: f64| radius * (1.0 - 0.16 * t * t + 0.03 * (t * PI).sin());
    let shaft = (0..=8).map(|i| f64::from(i) / 8.0);
    let shaft = shaft.map(|t| DVec2::new(shaft_radius(t), shaft_bottom + (shaft_top - shaft_bottom) * t));
    let neck = shaft_radius(1.0);
    let capital = (0..=5).map(|i| f64::from(i) / 5.0);
    let capital = capital
        .map(|t| DVec2::new(neck + (radius * 1.28 - neck) * t * t, shaft_top + 0.12 + (0.38 - 0.2) * t));
    let collar = 0.40;
    let runs = [
        bulge(radius * 1.1, 0.2, 0.1, 6),
        vec![DVec2::new(radius * 1.1, collar), DVec2::new(radius * 1.1, shaft_bottom)],
        vec![DVec2::new(radius * 1.1, shaft_bottom), DVec2::new(radius * 0.98, shaft_bottom)],
        shaft.collect(),
        bulge(neck, shaft_top, 0.06, 5),
        capital.collect(),
    ];
    let mut shape = lathe(&runs, 24);
    shape.append_translated(&box_on_ground(radius * 2.7, 0.2, radius * 2.7), DVec3::ZERO);
    shape.append_translated(&box_on_ground(radius * 2.7, 0.2, radius * 2.7), DVec3::Y * (height - 0.2));
    shape
}
