// Shaders for the tests of the executor. Each entry point uses the bindings below it that it needs.

struct Vertex {
    @builtin(position) position: vec4f,
    @location(0) across: vec2f,
}

// A triangle over the whole viewport at depth 0.5; `across` goes from 0 to 1 within the viewport.
@vertex
fn everywhere(@builtin(vertex_index) vertex: u32) -> Vertex {
    let corner = vec2f(vec2u(vertex & 2u, (vertex << 1u) & 2u));
    return Vertex(vec4f(corner.x * 2.0 - 1.0, 1.0 - corner.y * 2.0, 0.5, 1.0), corner);
}

@group(0) @binding(0) var<uniform> block: vec4u;

@fragment
fn seven() -> @location(0) u32 {
    return 7u;
}

@fragment
fn number() -> @location(0) u32 {
    return block.x;
}

// Position in the viewport, in sixteenths: x + 100 y.
@fragment
fn place(vertex: Vertex) -> @location(0) u32 {
    let sixteenths = vec2u(vertex.across * 16.0);
    return sixteenths.x + 100u * sixteenths.y;
}

@fragment
fn white() -> @location(0) vec4f {
    return vec4f(1.0);
}

@group(0) @binding(0) var source: texture_2d<u32>;

@fragment
fn loaded(vertex: Vertex) -> @location(0) u32 {
    return textureLoad(source, vec2u(vertex.position.xy), 0).r + 1u;
}

@group(0) @binding(0) var samples: texture_multisampled_2d<u32>;

@fragment
fn last_sample(vertex: Vertex) -> @location(0) u32 {
    return textureLoad(samples, vec2u(vertex.position.xy), 3).r;
}

@group(0) @binding(0) var depth: texture_depth_2d;
@group(0) @binding(1) var stencil: texture_2d<u32>;

// Depth in hundredths, and a thousand times the stencil.
@fragment
fn aspects(vertex: Vertex) -> @location(0) u32 {
    let texel = vec2u(vertex.position.xy);
    return u32(round(textureLoad(depth, texel, 0) * 100.0)) + 1000u * textureLoad(stencil, texel, 0).r;
}

@fragment
fn hundredths(vertex: Vertex) -> @location(0) u32 {
    return u32(round(textureLoad(depth, vec2u(vertex.position.xy), 0) * 100.0));
}

@group(0) @binding(0) var<storage, read> words: array<u32>;
@group(0) @binding(1) var<storage, read_write> copied: array<u32>;

// Copies words, and counts them all in the thousands.
@compute @workgroup_size(64)
fn copy_words(@builtin(global_invocation_id) id: vec3u) {
    if id.x < min(arrayLength(&words), arrayLength(&copied)) {
        copied[id.x] = words[id.x] + 1000u * arrayLength(&words);
    }
}

@group(0) @binding(1) var<storage, read_write> noted: array<u32>;

// Adds the number to each word.
@compute @workgroup_size(64)
fn add_number(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&noted) {
        noted[id.x] += block.x;
    }
}
