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

//: values
// Counts texels of a texture with values that they should not have, and copies single texels. TEXTURE, LOAD and SAMPLES are
// replaced for each kind of texture.
struct CheckedPart {
    // The first texel that was written, and their number along each side.
    written: vec4u,
    // The size of the mip level that was written, and of that of `image`.
    written_size: vec2u,
    size: vec2u,
    layers: u32,
    channels: u32,
    // The first word of the counts of what was written: see COUNTED_*.
    counts: u32,
    // The first word that `copy` writes: x, y, layer, and the bits of four channels.
    copied: u32,
    // The values that are allowed.
    low: f32,
    high: f32,
    padding: vec2u,
}

@group(0) @binding(0) var image: TEXTURE;
@group(0) @binding(1) var<storage, read_write> words: array<atomic<u32>>;
@group(0) @binding(2) var<uniform> part: CheckedPart;

const COUNTED_NAN: u32 = 0u;
const COUNTED_INFINITE: u32 = 1u;
const COUNTED_OUTSIDE: u32 = 2u;
// The largest u32 minus the first texel's number; 0: there is none.
const COUNTED_FIRST: u32 = 3u;

const GOOD: u32 = 3u;

// Compared as bits, as compilers may assume that there are no NaN.
fn kind_of(bits: vec4u) -> u32 {
    var kind = GOOD;
    for (var channel = 0u; channel < part.channels; channel++) {
        let magnitude = bits[channel] & 0x7fffffffu;
        if magnitude > 0x7f800000u {
            kind = min(kind, COUNTED_NAN);
        } else if magnitude == 0x7f800000u {
            kind = min(kind, COUNTED_INFINITE);
        } else {
            let value = bitcast<f32>(bits[channel]);
            if value < part.low || value > part.high {
                kind = min(kind, COUNTED_OUTSIDE);
            }
        }
    }
    return kind;
}

fn load(at: vec3u, sample: u32) -> vec4u {
    return LOAD;
}

// The bits of the texel, of its worst sample.
fn worst(at: vec3u) -> vec4u {
    var bits = load(at, 0u);
    for (var sample = 1u; sample < SAMPLES; sample++) {
        let other = load(at, sample);
        if kind_of(other) < kind_of(bits) {
            bits = other;
        }
    }
    return bits;
}

@compute @workgroup_size(8, 8)
fn count(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= part.written.zw) {
        return;
    }
    let kind = kind_of(worst(vec3u(part.written.xy + id.xy, id.z)));
    if kind != GOOD {
        atomicAdd(&words[part.counts + kind], 1u);
        let number = (id.z * part.written.w + id.y) * part.written.z + id.x;
        atomicMax(&words[part.counts + COUNTED_FIRST], 0xffffffffu - number);
    }
}

// Copies the texel at the place of the first one that was counted.
@compute @workgroup_size(1)
fn copy() {
    let first = atomicLoad(&words[part.counts + COUNTED_FIRST]);
    if first == 0u {
        return;
    }
    let number = 0xffffffffu - first;
    let row = number / part.written.z;
    let place = part.written.xy + vec2u(number % part.written.z, row % part.written.w);
    let at = vec3u(
        min(place * part.size / part.written_size, part.size - 1u),
        min(row / part.written.w, part.layers - 1u),
    );
    let bits = worst(at);
    for (var i = 0u; i < 3u; i++) {
        atomicStore(&words[part.copied + i], at[i]);
    }
    for (var i = 0u; i < 4u; i++) {
        atomicStore(&words[part.copied + 3u + i], bits[i]);
    }
}
