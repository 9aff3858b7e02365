// This frame's light with that of the frames before, followed to where it is now (Karis, "High Quality Temporal Supersampling",
// 2014; the box of neighbours by Salvi, "An Excursion in Temporal Supersampling", 2016).
struct Settings {
    // From this frame's clip space, without its shift, to that of the frame before.
    before_from_now: mat4x4f,
    // This frame's shift, pixels.
    shift_px: vec2f,
    // The part of the new frame.
    fresh: f32,
    // 0: there is nothing before.
    valid: f32,
}

@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var before: texture_2d<f32>;
@group(0) @binding(2) var depth_texture: texture_depth_2d;
@group(0) @binding(3) var linear: sampler;
@group(0) @binding(4) var<uniform> settings: Settings;

fn to_ycocg(color: vec3f) -> vec3f {
    return vec3f(
        dot(color, vec3f(0.25, 0.5, 0.25)), dot(color, vec3f(0.5, 0.0, -0.5)), dot(color, vec3f(-0.25, 0.5, -0.25)));
}

fn from_ycocg(color: vec3f) -> vec3f {
    return vec3f(color.x + color.y - color.z, color.x + color.z, color.x - color.y - color.z);
}

// Bright light is weighed down while it is mixed, or a spark would outshine all else.
fn calm(color: vec3f) -> vec3f {
    return color / (1.0 + max(color.r, max(color.g, color.b)));
}

fn uncalm(color: vec3f) -> vec3f {
    return color / max(1.0 - max(color.r, max(color.g, color.b)), 1e-3);
}

@fragment
fn fs_temporal(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let size = vec2i(textureDimensions(light));
    let texel = vec2i(position.xy);
    var nearest = vec3f(0.0, 0.0, -1.0);
    var mean = vec3f(0.0);
    var square = vec3f(0.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let other = clamp(texel + vec2i(x, y), vec2i(0), size - 1);
            let color = to_ycocg(calm(textureLoad(light, other, 0).rgb));
            mean += color;
            square += color * color;
            // Edges move with what is in front.
            let depth = textureLoad(depth_texture, other, 0);
            if depth > nearest.z {
                nearest = vec3f(vec2f(f32(x), f32(y)), depth);
            }
        }
    }
    mean /= 9.0;
    let deviation = sqrt(max(square / 9.0 - mean * mean, vec3f(0.0)));
    let own = textureLoad(light, texel, 0);
    let fresh = calm(own.rgb);
    let pixel = position.xy + nearest.xy - settings.shift_px;
    let ndc = vec3f(pixel / vec2f(size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), nearest.z);
    let clip = settings.before_from_now * vec4f(ndc, 1.0);
    let was = clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5;
    let moved = was - (pixel / vec2f(size));
    let earlier = uv + moved;
    let inside = all(earlier >= vec2f(0.0)) && all(earlier <= vec2f(1.0)) && clip.w > 0.0;
    if settings.valid == 0.0 || !inside {
        return own;
    }
    let old = to_ycocg(calm(textureSampleLevel(before, linear, earlier, 0.0).rgb));
    let clipped = from_ycocg(clamp(old, mean - 1.25 * deviation, mean + 1.25 * deviation));
    return vec4f(uncalm(mix(clipped, fresh, settings.fresh)), own.a);
}
