// Surface textures: the position of each pixel's surface, metres relative to the frame's origin, and its geometric normal
// as one number. All 0 where nothing is drawn.
#define_import_path shadowgraph::surface

// The unit octahedron, unfolded to the square from -1 to 1 (Cigolle et al. 2014).
fn octahedral(normal: vec3f) -> vec2f {
    let flat = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return select(folded, flat, normal.z >= 0.0);
}

// 12 bits an axis, as an integer from 1 that a float holds exactly.
fn pack_normal(normal: vec3f) -> f32 {
    let square = vec2u(round((octahedral(normal) * 0.5 + 0.5) * 4095.0));
    return f32(1u + square.x * 4096u + square.y);
}

// Unit length; zero for 0.
fn unpack_normal(packed: f32) -> vec3f {
    if packed < 1.0 {
        return vec3f(0.0);
    }
    let integer = u32(packed) - 1u;
    return unfold(vec2f(vec2u(integer / 4096u, integer % 4096u)) / 4095.0 * 2.0 - 1.0);
}

// The direction of a point of the unfolded octahedron, unit length.
fn unfold(flat: vec2f) -> vec3f {
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let folded = (1.0 - abs(flat.yx)) * select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return normalize(vec3f(select(folded, flat, z >= 0.0), z));
}
