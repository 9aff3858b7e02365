// A disc seen through noise, and its mean over frames.

@group(0) @binding(0) var<uniform> frame: vec4u;

fn hash(seed: u32) -> f32 {
    var x = seed * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    return f32((x >> 22u) ^ x) / 4294967295.0;
}

@fragment fn noisy(@builtin(position) at: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let seed = (u32(at.y) * 4096u + u32(at.x)) * 977u + frame.x * 7919u;
    let around = uv - 0.5 + 0.06 * (vec2f(hash(seed), hash(seed + 1u)) - 0.5);
    let ring = abs(length(around) - 0.3);
    let inside = select(0.0, 1.0, ring < 0.06);
    let is_lit = step(hash(seed + 2u), 0.15 + 0.7 * uv.x);
    return vec4f(vec3f(0.9, 0.6, 0.2) * inside * is_lit + vec3f(0.05, 0.1, 0.2) * 2.0 * hash(seed + 3u), 1.0);
}
