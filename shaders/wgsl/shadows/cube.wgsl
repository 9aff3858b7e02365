// The faces of a point light.
#define_import_path shadowgraph::shadows::cube

// The face of a direction from the light: +X, -X, +Y, -Y, +Z, -Z.
fn cube_face(direction: vec3f) -> u32 {
    let size = abs(direction);
    if size.x >= size.y && size.x >= size.z {
        return select(0u, 1u, direction.x < 0.0);
    }
    if size.y >= size.z {
        return select(2u, 3u, direction.y < 0.0);
    }
    return select(4u, 5u, direction.z < 0.0);
}
