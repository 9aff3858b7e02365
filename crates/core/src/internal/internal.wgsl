// The shaders of the graph's internal draws. A line `//: name` begins a section; `mod.rs` joins sections and replaces
// SCALAR by the scalar type of a format (f32, u32 or i32). A line that ends with `each` is repeated for every cleared
// attachment, with INDEX replaced by its index.

//: fullscreen
// A triangle that covers the viewport. Its depth is 0, so the stored depth is exactly the minimum of the viewport's depth
// range.
@vertex
fn fullscreen(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(vec2u(vertex & 2u, (vertex << 1u) & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

//: uv
// The same triangle for fullscreen shaders of users, with the position in the viewport, (0, 0) at its upper left corner.
struct Corner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn fullscreen(@builtin(vertex_index) vertex: u32) -> Corner {
    let corner = vec2f(vec2u(vertex & 2u, (vertex << 1u) & 2u));
    return Corner(vec4f(corner * 2.0 - 1.0, 0.0, 1.0), vec2f(corner.x, 1.0 - corner.y));
}

//: clear
// The bits of the values, so that one buffer works for all formats.
@group(0) @binding(0) var<uniform> values: array<vec4u, 8>;

struct Cleared {
    @location(INDEX) color_INDEX: vec4<SCALAR>, // each
}

@fragment
fn clear() -> Cleared {
    var cleared: Cleared;
    cleared.color_INDEX = bitcast<vec4<SCALAR>>(values[INDEX]); // each
    return cleared;
}

//: no-color
// Clears only depth or stencil.
@fragment
fn no_color() {}

//: resample
@group(0) @binding(0) var<uniform> target_size: vec2u;

// The source texel at the centre of a target texel, in integers: a centre between two texels selects the later one.
fn source_texel(position: vec4f, source_size: vec2u) -> vec2u {
    return (2u * vec2u(position.xy) + 1u) * source_size / (2u * target_size);
}

//: nearest
@group(0) @binding(1) var source: texture_2d<SCALAR>;

@fragment
fn nearest(@builtin(position) position: vec4f) -> @location(0) vec4<SCALAR> {
    return textureLoad(source, source_texel(position, textureDimensions(source)), 0);
}

//: depth
@group(0) @binding(1) var source: texture_depth_2d;

@fragment
fn depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(source, source_texel(position, textureDimensions(source)), 0);
}

//: filtered
@group(0) @binding(1) var source: texture_2d<f32>;
@group(0) @binding(2) var bilinear: sampler;

@fragment
fn filtered(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureSampleLevel(source, bilinear, position.xy / vec2f(target_size), 0.0);
}
