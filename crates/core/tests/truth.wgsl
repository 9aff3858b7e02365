// The arithmetic of `execute/tests/truth`, which `interpret.rs` does on the CPU.

struct Params {
    constant: u32,
    textures: u32,
    buffers: u32,
    // 1: the earlier value is mixed in, 0: it is overwritten.
    preserve: u32,
    // Added to the index at which each texture, then each buffer, is read.
    shifts: array<vec4u, 2>,
    // Of the texels that a compute pass writes.
    origin: vec2u,
    size: vec2u,
    // Texels in a row of the target.
    stride: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var texture_0: texture_2d<u32>;
@group(0) @binding(2) var texture_1: texture_2d<u32>;
@group(0) @binding(3) var<storage, read> buffer_0: array<u32>;
@group(0) @binding(4) var<storage, read> buffer_1: array<u32>;
@group(0) @binding(5) var<storage, read_write> out_words: array<u32>;
@group(0) @binding(5) var out_texels: texture_storage_2d<r32uint, read_write>;

fn mixed(state: u32, value: u32) -> u32 {
    let product = (state ^ value) * 2654435761u;
    return (product << 13u) | (product >> 19u);
}

fn texel(source: texture_2d<u32>, coords: vec2u, shift: u32) -> u32 {
    return textureLoad(source, (coords + shift) % textureDimensions(source), 0).r;
}

fn value(coords: vec2u) -> u32 {
    var state = mixed(params.constant, coords.x + 4099u * coords.y);
    if params.textures > 0u {
        state = mixed(state, texel(texture_0, coords, params.shifts[0].x));
    }
    if params.textures > 1u {
        state = mixed(state, texel(texture_1, coords, params.shifts[0].y));
    }
    let word = coords.x + 16u * coords.y;
    if params.buffers > 0u {
        state = mixed(state, buffer_0[(word + params.shifts[1].x) % arrayLength(&buffer_0)]);
    }
    if params.buffers > 1u {
        state = mixed(state, buffer_1[(word + params.shifts[1].y) % arrayLength(&buffer_1)]);
    }
    return state;
}

@vertex
fn everywhere(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(vec2u(vertex & 2u, (vertex << 1u) & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn one_target(@builtin(position) position: vec4f) -> @location(0) u32 {
    return value(vec2u(position.xy));
}

struct Two {
    @location(0) first: u32,
    @location(1) second: u32,
}

@fragment
fn two_targets(@builtin(position) position: vec4f) -> Two {
    let first = value(vec2u(position.xy));
    return Two(first, mixed(first, 1u));
}

// Writes a word for each texel, besides the texel.
@fragment
fn target_and_words(@builtin(position) position: vec4f) -> @location(0) u32 {
    let coords = vec2u(position.xy);
    let state = value(coords);
    write_word(coords.x + params.stride * coords.y, mixed(state, 1u));
    return state;
}

fn write_word(word: u32, state: u32) {
    if params.preserve == 1u {
        out_words[word] = mixed(out_words[word], state);
    } else {
        out_words[word] = state;
    }
}

@compute @workgroup_size(64)
fn words(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&out_words) {
        write_word(id.x, value(vec2u(id.x, 0u)));
    }
}

@compute @workgroup_size(8, 8)
fn texels(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= params.size) {
        return;
    }
    let coords = params.origin + id.xy;
    var state = value(coords);
    if params.preserve == 1u {
        state = mixed(textureLoad(out_texels, coords).r, state);
    }
    textureStore(out_texels, coords, vec4u(state, 0u, 0u, 0u));
}
