//! A written file of each kind of animation, and where its vertices are at a time, computed from what the file means.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use glam::{DAffine3, DQuat, DVec3};
use serde_json::json;

pub use crate::gltf_file::File;

/// A kind of animation; it lasts from 0 to 1 s.
#[derive(Clone, Copy)]
pub struct Kind {
    /// The name, for messages.
    pub name: &'static str,
    /// Creates the file.
    pub file: fn() -> File,
    /// Returns the position and the normal of each vertex in the world at a time from 0 to 1 s.
    pub vertices: fn(f64) -> Vec<[DVec3; 2]>,
}

/// Kinds of written files, for messages.
impl std::fmt::Debug for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// A column whose transform is animated.
pub const RIGID: Kind = Kind { name: "rigid", file: rigid, vertices: rigid_vertices };
/// A column whose transform is a cubic spline.
pub const CUBIC: Kind = Kind { name: "cubic spline", file: cubic, vertices: cubic_vertices };
/// A column that two joints bend.
pub const SKINNED: Kind = Kind { name: "skinned", file: || skinned(4), vertices: skinned_vertices };
/// The same with eight influences a vertex.
pub const SKINNED_BY_EIGHT: Kind =
    Kind { name: "skinned by eight", file: || skinned(8), vertices: skinned_vertices };
/// A column that two morph targets bend and thicken.
pub const MORPHED: Kind = Kind { name: "morphed", file: morphed, vertices: morphed_vertices };

/// Rings of the column, and vertices of each.
const RINGS: usize = 13;
const SIDES: usize = 8;
const HEIGHT_M: f64 = 2.4;
const RADIUS_M: f64 = 0.3;

/// A vertex of a column around the Y axis: its height as a fraction, its position and its normal.
fn column() -> impl Iterator<Item = (f64, DVec3, DVec3)> {
    (0..RINGS * SIDES).map(|index| {
        let height = (index / SIDES) as f64 / (RINGS - 1) as f64;
        let angle = (index % SIDES) as f64 / SIDES as f64 * std::f64::consts::TAU;
        let normal = DVec3::new(angle.sin(), 0.0, angle.cos());
        (height, normal * RADIUS_M + DVec3::Y * height * HEIGHT_M, normal)
    })
}

fn floats(vectors: impl Iterator<Item = DVec3>) -> Vec<f32> {
    vectors.flat_map(|vector| vector.as_vec3().to_array()).collect()
}

/// Adds the mesh of the column, 0.
fn add_column(file: &mut File) {
    let positions = file.floats("VEC3", 3, &floats(column().map(|(_, position, _)| position)));
    let normals = file.floats("VEC3", 3, &floats(column().map(|(.., normal)| normal)));
    let quad = |index: usize| {
        let (ring, side) = (index / SIDES * SIDES, index % SIDES);
        let corners = [ring + side, ring + (side + 1) % SIDES];
        let [a, b, c, d] = [corners[0], corners[1], corners[1] + SIDES, corners[0] + SIDES];
        [a, b, c, a, c, d].map(|index| index as u16)
    };
    let indices: Vec<u8> = (0..(RINGS - 1) * SIDES).flat_map(quad).flat_map(u16::to_le_bytes).collect();
    let indices = file.accessor(&indices, 5123, "SCALAR", (RINGS - 1) * SIDES * 6);
    file.json["meshes"] = json!([{"primitives": [
        {"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices},
    ]}]);
    file.json["materials"] = json!([{"doubleSided": true}]);
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
}

fn column_at(transform: DAffine3) -> Vec<[DVec3; 2]> {
    let normals = transform.matrix3.inverse().transpose();
    column()
        .map(|(_, position, normal)| [transform.transform_point3(position), (normals * normal).normalize()])
        .collect()
}

fn rotation(axis: DVec3, angle: f64) -> Vec<f32> {
    DQuat::from_axis_angle(axis, angle).as_quat().to_array().to_vec()
}

/// A column that moves along X, turns around Z and shrinks, below a parent that steps from Z = 0 to 1 m at 0.3 s.
fn rigid() -> File {
    let mut file = File::new(json!([{"children": [1]}, {"mesh": 0}]), 1);
    add_column(&mut file);
    let input = file.floats("SCALAR", 1, &[0.0, 1.0]);
    let output = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    file.animate(1, "translation", json!({"input": input, "output": output}));
    let keys = [rotation(DVec3::Z, 0.0), rotation(DVec3::Z, FRAC_PI_2)].concat();
    let output = file.floats("VEC4", 4, &keys);
    file.animate(1, "rotation", json!({"input": input, "output": output}));
    let output = file.floats("VEC3", 3, &[1.0, 1.0, 1.0, 0.5, 0.25, 1.0]);
    file.animate(1, "scale", json!({"input": input, "output": output, "interpolation": "LINEAR"}));
    let input = file.floats("SCALAR", 1, &[0.0, 0.3]);
    let output = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    file.animate(0, "translation", json!({"input": input, "output": output, "interpolation": "STEP"}));
    file
}

fn rigid_vertices(time_s: f64) -> Vec<[DVec3; 2]> {
    let scale = DVec3::ONE + (DVec3::new(0.5, 0.25, 1.0) - DVec3::ONE) * time_s;
    let z = if time_s < f64::from(0.3f32) { 0.0 } else { 1.0 };
    let rotation = DQuat::from_rotation_z(FRAC_PI_2 * time_s);
    let translation = DVec3::new(2.0 * time_s, 0.0, z);
    column_at(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
}

/// A column whose position is a cubic polynomial of time, and whose rotation is a spline between two keyframes.
fn cubic() -> File {
    let mut file = File::new(json!([{"mesh": 0}]), 1);
    add_column(&mut file);
    let input = file.floats("SCALAR", 1, &[0.0, 0.5, 1.0]);
    let keys = [0.0, 0.5, 1.0].map(|time_s| [slope(time_s), path(time_s), slope(time_s)]);
    let output = file.floats("VEC3", 3, &floats(keys.into_iter().flatten()));
    file.animate(0, "translation", json!({"input": input, "output": output, "interpolation": "CUBICSPLINE"}));
    let input = file.floats("SCALAR", 1, &[0.0, 1.0]);
    let still = vec![0.0; 4];
    let turned = rotation(DVec3::Y, FRAC_PI_3);
    let keys = [still.clone(), rotation(DVec3::Y, 0.0), still.clone(), still.clone(), turned, still].concat();
    let output = file.floats("VEC4", 4, &keys);
    file.animate(0, "rotation", json!({"input": input, "output": output, "interpolation": "CUBICSPLINE"}));
    file
}

fn path(t: f64) -> DVec3 {
    DVec3::new(t * t * t - t, 2.0 * t * t, 1.0 - t)
}

fn slope(t: f64) -> DVec3 {
    DVec3::new(3.0 * t * t - 1.0, 4.0 * t, -1.0)
}

fn cubic_vertices(time_s: f64) -> Vec<[DVec3; 2]> {
    let weight = time_s * time_s * (3.0 - 2.0 * time_s);
    let mixed = DQuat::IDENTITY * (1.0 - weight) + DQuat::from_rotation_y(FRAC_PI_3) * weight;
    column_at(DAffine3::from_rotation_translation(mixed.normalize(), path(time_s)))
}

/// The weight of the upper joint at a height.
fn upper_weight(height: f64) -> f64 {
    (height * 2.0 - 0.5).clamp(0.0, 1.0)
}

/// A column that bends in the middle: its upper joint turns around X, and the lower one moves along X. The mesh's own node is turned,
/// which must have no effect.
fn skinned(influences: usize) -> File {
    let upper = json!({"translation": [0, HEIGHT_M / 2.0, 0]});
    let nodes = json!([{"mesh": 0, "skin": 0, "rotation": [1, 0, 0, 0]}, {"children": [2]}, upper]);
    let mut file = File::new(nodes, 2);
    add_column(&mut file);
    let columns = |y: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, y, 0.0, 1.0];
    let matrices = [columns(0.0), columns(-(HEIGHT_M as f32) / 2.0)].concat();
    let matrices = file.floats("MAT4", 16, &matrices);
    file.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": matrices}]);
    for set in 0..influences / 4 {
        let joints: Vec<u8> = column().flat_map(|_| [0, 1, 0, 1]).collect();
        let joints = file.accessor(&joints, 5121, "VEC4", RINGS * SIDES);
        let share = 4.0 / influences as f32;
        let weights = column().flat_map(|(height, ..)| {
            let upper = upper_weight(height) as f32 * share;
            [share - upper, upper / 2.0, 0.0, upper / 2.0]
        });
        let weights = file.floats("VEC4", 4, &weights.collect::<Vec<_>>());
        let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = json!(joints);
        attributes[format!("WEIGHTS_{set}")] = json!(weights);
    }
    let input = file.floats("SCALAR", 1, &[0.0, 1.0]);
    let keys = [rotation(DVec3::X, 0.0), rotation(DVec3::X, FRAC_PI_2)].concat();
    let output = file.floats("VEC4", 4, &keys);
    file.animate(2, "rotation", json!({"input": input, "output": output}));
    let output = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    file.animate(1, "translation", json!({"input": input, "output": output}));
    file
}

/// Returns how each joint of the skinned file moves the vertices at rest into the world, at a time from 0 to 1 s.
#[must_use]
pub fn skinned_joints(time_s: f64) -> [DAffine3; 2] {
    let moved = DAffine3::from_translation(DVec3::X * time_s);
    let middle = DVec3::Y * HEIGHT_M / 2.0;
    let turned = DAffine3::from_rotation_x(FRAC_PI_2 * time_s);
    let upper = moved
        * DAffine3::from_translation(middle)
        * turned
        * DAffine3::from_translation(DVec3::Y * -f64::from(HEIGHT_M as f32 / 2.0));
    [moved, upper]
}

fn skinned_vertices(time_s: f64) -> Vec<[DVec3; 2]> {
    let [moved, upper] = skinned_joints(time_s);
    let vertex = |(height, position, normal): (f64, DVec3, DVec3)| {
        let weight = upper_weight(height);
        let matrix = moved.matrix3 * (1.0 - weight) + upper.matrix3 * weight;
        let position =
            moved.transform_point3(position) * (1.0 - weight) + upper.transform_point3(position) * weight;
        [position, (matrix.inverse().transpose() * normal).normalize()]
    };
    column().map(vertex).collect()
}

/// Adds a square floor below the column, and a camera that sees both.
pub fn add_floor_and_camera(file: &mut File) {
    let corners =
        [[-20.0, 20.0], [20.0, 20.0], [20.0, -20.0], [-20.0, -20.0]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let positions = file.floats("VEC3", 3, &floats(corners.into_iter()));
    let normals = file.floats("VEC3", 3, &floats([DVec3::Y; 4].into_iter()));
    let indices: Vec<u8> = [0u16, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes).collect();
    let indices = file.accessor(&indices, 5123, "SCALAR", 6);
    let attributes = json!({"POSITION": positions, "NORMAL": normals});
    file.add_mesh(json!({"primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}));
    file.add_root(json!({"mesh": 1}));
    file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}]);
    // Turned down by 0.3 radians.
    let rotation = DQuat::from_rotation_x(-0.3).to_array();
    file.add_root(json!({"camera": 0, "translation": [0.5, 3.5, 8], "rotation": rotation}));
}

/// Moves the mesh of the skinned file at rest along X; its joints move it back.
pub fn move_rest(file: &mut File, distance_m: f64) {
    let moved = column().map(|(_, position, _)| position + DVec3::X * distance_m);
    let positions = file.floats("VEC3", 3, &floats(moved));
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
    let back = -distance_m as f32;
    let columns = |y: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, back, y, 0.0, 1.0];
    let matrices = [columns(0.0), columns(-(HEIGHT_M as f32) / 2.0)].concat();
    let matrices = file.floats("MAT4", 16, &matrices);
    file.json["skins"][0]["inverseBindMatrices"] = json!(matrices);
}

/// A column that a first target bends along X and a second makes thicker, on a node that stands at 1 m along Z.
fn morphed() -> File {
    let mut file = File::new(json!([{"mesh": 0, "translation": [0, 0, 1]}]), 1);
    add_column(&mut file);
    let bent = file.floats("VEC3", 3, &floats(column().map(|(height, ..)| bend(height))));
    let tilted = file.floats("VEC3", 3, &floats(column().map(|(height, ..)| tilt(height))));
    let thick = file.floats("VEC3", 3, &floats(column().map(|(.., normal)| normal * 0.25)));
    file.json["meshes"][0]["primitives"][0]["targets"] =
        json!([{"POSITION": bent, "NORMAL": tilted}, {"POSITION": thick}]);
    let input = file.floats("SCALAR", 1, &[0.0, 1.0]);
    let output = file.floats("SCALAR", 1, &[0.0, -0.5, 1.0, 1.0]);
    file.animate(0, "weights", json!({"input": input, "output": output}));
    file
}

fn bend(height: f64) -> DVec3 {
    DVec3::new(height * height * 1.5, 0.0, 0.0)
}

fn tilt(height: f64) -> DVec3 {
    DVec3::new(0.0, -height, 0.0)
}

fn morphed_vertices(time_s: f64) -> Vec<[DVec3; 2]> {
    let weights = [time_s, -0.5 + 1.5 * time_s];
    let vertex = |(height, position, normal): (f64, DVec3, DVec3)| {
        let moved = position + bend(height) * weights[0] + normal * 0.25 * weights[1];
        [moved + DVec3::Z, (normal + tilt(height) * weights[0]).normalize()]
    };
    column().map(vertex).collect()
}
