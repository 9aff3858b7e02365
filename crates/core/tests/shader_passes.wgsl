// Entry points for tests of one-line passes.

override LEVEL: f32 = 0.2;

@fragment
fn gradient(@location(0) uv: vec2f) -> @location(0) vec4f {
    return vec4f(uv, 0.0, 1.0);
}

@fragment
fn level() -> @location(0) vec4f {
    return vec4f(LEVEL);
}

// Leaves the left half alone.
@fragment
fn right_half(@location(0) uv: vec2f) -> @location(0) vec4f {
    if uv.x < 0.5 {
        discard;
    }
    return vec4f(1.0);
}

struct Two {
    @location(0) first: vec4f,
    @location(1) second: vec4<u32>,
}

@fragment
fn two(@builtin(position) position: vec4f) -> Two {
    return Two(vec4f(0.2, 0.4, 0.6, 0.8), vec4u(vec2u(position.xy), 7u, 9u));
}

@fragment
fn wrong_type() -> @location(0) vec4u {
    return vec4u(1u);
}

@group(0) @binding(0) var finer: texture_2d<f32>;

@fragment
fn halve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureLoad(finer, 2u * vec2u(position.xy), 0);
}

@fragment
fn depth_of_uv(@location(0) uv: vec2f) -> @builtin(frag_depth) f32 {
    return select(0.0, 0.5, uv.x < 0.5);
}

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var nearest: sampler;
@group(0) @binding(2) var<uniform> factor: vec4f;

@fragment
fn scaled(@location(0) uv: vec2f) -> @location(0) vec4f {
    return factor * textureSample(source, nearest, uv);
}

@group(1) @binding(0) var<uniform> elsewhere: vec4f;

@fragment
fn other_group() -> @location(0) vec4f {
    return elsewhere;
}

@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;
@group(0) @binding(1) var<uniform> times: u32;

@compute @workgroup_size(4)
fn multiply(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&numbers) {
        numbers[id.x] *= times;
    }
}

@compute @workgroup_size(4)
fn double(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&numbers) {
        numbers[id.x] *= 2u;
    }
}

@group(0) @binding(0) var<storage, read> inputs: array<u32>;
@group(0) @binding(1) var outputs: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(1)
fn paint(@builtin(workgroup_id) at: vec3u) {
    textureStore(outputs, at.xy, vec4u(10u * inputs[at.x] + at.y));
}
