//! Round primitives: turned profiles, tubes along a path, rings, spheres.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

use crate::mesh_builder::{MeshBuilder, SurfacePoint};

/// Revolves a profile about the Y axis. Each run is a smooth line of (radius, height) points from bottom to top; runs meet
/// in hard edges. The outside is to the right of the line, so a lid runs inwards.
pub(crate) fn lathe(runs: &[Vec<DVec2>], segments: u32) -> MeshBuilder {
    let mut shape = MeshBuilder::default();
    for run in runs {
        let normals = run_normals(run);
        let lengths = run_lengths(run);
        let rows = run.len().saturating_sub(1) as u32;
        // A whole number of metres around, so that a texture tiles.
        let widest = run.iter().fold(0.0_f64, |widest, point| widest.max(point.x));
        let around = (widest * TAU).round().max(1.0);
        shape.grid(segments, rows, |u, v| {
            let row = (v * f64::from(rows)).round() as usize;
            let (sin, cos) = (u * TAU).sin_cos();
            SurfacePoint {
                position: DVec3::new(cos * run[row].x, run[row].y, -sin * run[row].x),
                normal: DVec3::new(cos * normals[row].x, normals[row].y, -sin * normals[row].x),
                uv: DVec2::new(u * around, -lengths[row]),
            }
        });
    }
    shape
}

/// Returns the normals of a profile line: the mean direction of the adjacent segments, rotated to the right.
fn run_normals(run: &[DVec2]) -> Vec<DVec2> {
    let segment = |i: usize| (run[i + 1] - run[i]).normalize_or_zero();
    let normal = |i: usize| {
        let before = if i > 0 { segment(i - 1) } else { DVec2::ZERO };
        let after = if i + 1 < run.len() { segment(i) } else { DVec2::ZERO };
        let along = before + after;
        DVec2::new(along.y, -along.x).normalize_or(DVec2::X)
    };
    (0..run.len()).map(normal).collect()
}

/// Returns the length of the profile up to each of its points.
fn run_lengths(run: &[DVec2]) -> Vec<f64> {
    let mut length = 0.0;
    let step = |i: usize| {
        if i > 0 {
            length += run[i].distance(run[i - 1]);
        }
        length
    };
    (0..run.len()).map(step).collect()
}

/// Returns a half-round moulding: a profile run that bulges out by `radius`.
pub(crate) fn bulge(inner: f64, bottom: f64, radius: f64, steps: u32) -> Vec<DVec2> {
    let angle = |i: u32| -FRAC_PI_2 + PI * f64::from(i) / f64::from(steps);
    let point = |i| DVec2::new(inner + radius * angle(i).cos(), bottom + radius + radius * angle(i).sin());
    (0..=steps).map(point).collect()
}

/// Returns a sphere around the origin.
pub(crate) fn sphere(radius: f64, segments: u32) -> MeshBuilder {
    let mut shape = MeshBuilder::default();
    shape.grid(segments * 2, segments, |u, v| {
        let (sin_u, cos_u) = (u * TAU).sin_cos();
        let (sin_v, cos_v) = (v * PI).sin_cos();
        let normal = DVec3::new(cos_u * sin_v, cos_v, -sin_u * sin_v);
        let uv = DVec2::new(u * (radius * TAU).round().max(1.0), v * radius * PI);
        SurfacePoint { position: normal * radius, normal, uv }
    });
    shape
}

/// Returns a torus around the Z axis.
pub(crate) fn ring(radius: f64, thickness: f64, segments: u32, sides: u32) -> MeshBuilder {
    let mut shape = MeshBuilder::default();
    shape.grid(segments, sides, |u, v| {
        let (sin_u, cos_u) = (u * TAU).sin_cos();
        let (sin_v, cos_v) = (v * TAU).sin_cos();
        let outwards = DVec3::new(cos_u, sin_u, 0.0);
        let normal = outwards * cos_v + DVec3::Z * sin_v;
        let position = outwards * radius + normal * thickness;
        SurfacePoint { position, normal, uv: DVec2::new(u * (radius * TAU).round(), v) }
    });
    shape
}

/// Returns a tube along a path of at least two points, open at its ends.
pub(crate) fn tube(path: &[DVec3], radius: f64, sides: u32) -> MeshBuilder {
    let along =
        |i: usize| (path[(i + 1).min(path.len() - 1)] - path[i.saturating_sub(1)]).normalize_or(DVec3::Y);
    // One reference for the whole path: the paths here bend in a plane, so the tube does not twist.
    let reference = along(0).cross(along(path.len() / 2)).normalize_or(along(0).any_orthonormal_vector());
    let rows = path.len().saturating_sub(1) as u32;
    let mut shape = MeshBuilder::default();
    shape.grid(sides, rows, |u, v| {
        let i = (v * f64::from(rows)).round() as usize;
        let side = along(i).cross(reference).normalize_or(along(i).any_orthonormal_vector());
        let (sin, cos) = (u * TAU).sin_cos();
        let normal = side * cos + side.cross(along(i)) * sin;
        SurfacePoint { position: path[i] + normal * radius, normal, uv: DVec2::new(u, v * f64::from(rows)) }
    });
    shape
}

/// Returns a rope that hangs between two points, `sag` metres below the straight line at its middle.
pub(crate) fn rope(from: DVec3, to: DVec3, sag: f64, radius: f64) -> MeshBuilder {
    let point = |i: u32| {
        let t = f64::from(i) / 16.0;
        from.lerp(to, t) - DVec3::Y * (sag * 4.0 * t * (1.0 - t))
    };
    let path: Vec<DVec3> = (0..=16).map(point).collect();
    tube(&path, radius, 6)
}
