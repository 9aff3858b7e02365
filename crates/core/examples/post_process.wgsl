// A chain of fullscreen passes: bright points; pixels brighter than white, blurred, and added to the image.

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;
@group(0) @binding(2) var<uniform> step: vec2f;

fn hash(n: f32) -> f32 {
    return fract(sin(n) * 43758.5453);
}

@fragment fn points(@location(0) uv: vec2f) -> @location(0) vec4f {
    let at = vec2f(uv.x * 16.0 / 9.0, uv.y);
    var color = mix(vec3f(0.01, 0.02, 0.05), vec3f(0.06, 0.02, 0.05), uv.y);
    for (var i = 0.0; i < 40.0; i += 1.0) {
        let center = vec2f(hash(i * 3.1) * 16.0 / 9.0, hash(i * 7.7 + 0.5));
        let radius = 0.004 + 0.012 * hash(i * 1.3);
        let tint = 0.5 + 0.5 * cos(6.2832 * (hash(i * 5.3) + vec3f(0.0, 0.33, 0.67)));
        color += tint * 6.0 * (1.0 - smoothstep(radius * 0.6, radius, distance(at, center)));
    }
    return vec4f(color, 1.0);
}

@fragment fn bright(@location(0) uv: vec2f) -> @location(0) vec4f {
    return vec4f(max(textureSampleLevel(source, linear, uv, 0.0).rgb - 1.0, vec3f(0.0)), 1.0);
}

@fragment fn blur(@location(0) uv: vec2f) -> @location(0) vec4f {
    var sum = vec3f(0.0);
    var weights = 0.0;
    for (var i = -12.0; i <= 12.0; i += 1.0) {
        let weight = exp(-i * i / 50.0);
        sum += weight * textureSampleLevel(source, linear, uv + i * step, 0.0).rgb;
        weights += weight;
    }
    return vec4f(sum / weights, 1.0);
}
