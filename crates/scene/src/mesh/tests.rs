#![allow(clippy::unwrap_used, reason = "tests")]

use glam::Vec3;

use super::*;
use crate::material::TextureRef;

/// A unit square in the xy plane that faces +Z, u to the right, v downwards.
fn square() -> Mesh {
    let corner = |x: f32, y: f32| Vertex { position: [x, y, 0.0], uv0: [x, 1.0 - y], ..Vertex::default() };
    let vertices = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
    Mesh::new("square", vertices, vec![0, 1, 2, 0, 2, 3])
}

#[test]
fn flat_normals_are_those_of_the_triangles() {
    let mut mesh = square();
    mesh.vertices[3].position = [0.0, 1.0, 1.0];
    mesh.flat_normals();
    assert_eq!((mesh.vertices.len(), mesh.indices.as_slice()), (6, &[0, 1, 2, 3, 4, 5][..]));
    assert_eq!(mesh.vertices[0].normal, [0.0, 0.0, 1.0]);
    assert_eq!(mesh.vertices[3].normal, mesh.vertices[5].normal);
    assert!(mesh.vertices[3].normal[1] < -0.5);
}

#[test]
fn smooth_normals_weigh_triangles_by_angle() {
    // Three faces of a cube meet in a corner, one of them as two triangles, which must not count twice.
    let at = |x: f32, y: f32, z: f32| Vertex { position: [x, y, z], ..Vertex::default() };
    let vertices =
        vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 1.0), at(1.0, 1.0, 0.0)];
    let mut mesh = Mesh::new("corner", vertices, vec![0, 4, 1, 0, 2, 4, 0, 1, 3, 0, 3, 2]);
    mesh.smooth_normals();
    let normal = Vec3::from(mesh.vertices[0].normal);
    assert!(normal.abs_diff_eq(-Vec3::ONE.normalize(), 1e-6), "{normal}");
}

#[test]
fn only_invalid_normals_are_replaced() {
    let mut mesh = square();
    mesh.vertices[0].normal = [f32::NAN, 0.0, 0.0];
    mesh.vertices[1].normal = [0.0; 3];
    mesh.vertices[2].normal = [0.0, 3e20, 0.0];
    mesh.vertices[3].normal = [1e-30, 0.0, 0.0];
    assert_eq!(mesh.repair_normals(), 2);
    let normals: Vec<_> = mesh.vertices.iter().map(|vertex| vertex.normal).collect();
    assert_eq!(normals, [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
}

#[test]
fn tangents_point_along_u_and_bitangents_up_the_image() {
    let mut mesh = square();
    mesh.generate_tangents(0, &TextureRef::UV_IDENTITY);
    assert!(mesh.vertices.iter().all(|vertex| vertex.tangent == [1.0, 0.0, 0.0, 1.0]));
    // Mirrored: u grows to the left, up stays up.
    mesh.generate_tangents(0, &[[-1.0, 0.0, 1.0], [0.0, 1.0, 0.0]]);
    assert!(mesh.vertices.iter().all(|vertex| vertex.tangent == [-1.0, 0.0, 0.0, -1.0]));
}

#[test]
fn tangents_without_texture_coordinates_are_perpendicular_to_the_normal() {
    let mut mesh = square();
    mesh.generate_tangents(1, &TextureRef::UV_IDENTITY);
    for vertex in &mesh.vertices {
        let [x, y, z, w] = vertex.tangent;
        let tangent = Vec3::new(x, y, z);
        assert!(tangent.is_normalized() && tangent.dot(Vec3::from(vertex.normal)).abs() < 1e-6 && w == 1.0);
    }
}

#[test]
fn only_invalid_tangents_are_computed() {
    let mut mesh = square();
    mesh.vertices[0].tangent = [0.0, 2.0, 0.0, -0.5];
    mesh.vertices[1].tangent = [f32::INFINITY, 0.0, 0.0, 1.0];
    assert_eq!(mesh.repair_tangents(0, &TextureRef::UV_IDENTITY), 1);
    assert_eq!(mesh.vertices[0].tangent, [0.0, 1.0, 0.0, -1.0]);
    assert_eq!(mesh.vertices[1].tangent, [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn meshes_without_triangles_or_with_indices_out_of_range_are_accepted() {
    let mut mesh = Mesh::new("wrong", vec![Vertex::default(); 2], vec![0, 1, 7, 1]);
    mesh.smooth_normals();
    mesh.generate_tangents(0, &TextureRef::UV_IDENTITY);
    mesh.flat_normals();
    assert!(mesh.vertices.is_empty() && mesh.indices.is_empty());
}
