// Temporal anti-aliasing: blends this frame with the reprojected history (Karis, "High Quality Temporal Supersampling", 2014;
// clipped to the neighbourhood as by Salvi, "An Excursion in Temporal Supersampling", 2016).
struct Settings {
    // From this frame's unjittered clip space to that of the previous frame.
    previous_from_current: mat4x4f,
    // This frame's jitter, pixels.
    jitter_px: vec2f,
    // The weight of this frame.
    current_weight: f32,
    // 0: there is no history.
    history_valid: f32,
}

@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var history: texture_2d<f32>;
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

// Weights bright colours down while they are blended, so that single bright samples do not dominate.
fn luma_weighted(color: vec3f) -> vec3f {
    return color / (1.0 + max(color.r, max(color.g, color.b)));
}

fn luma_unweighted(color: vec3f) -> vec3f {
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
            let color = to_ycocg(luma_weighted(textureLoad(light, other, 0).rgb));
            mean += color;
            square += color * color;
            // Edges move with the nearest surface.
            let depth = textureLoad(depth_texture, other, 0);
            if depth > nearest.z {
                nearest = vec3f(vec2f(f32(x), f32(y)), depth);
            }
        }
    }
    mean /= 9.0;
    let deviation = sqrt(max(square / 9.0 - mean * mean, vec3f(0.0)));
    let current = textureLoad(light, texel, 0);
    let weighted = luma_weighted(current.rgb);
    let pixel = position.xy + nearest.xy - settings.jitter_px;
    let ndc = vec3f(pixel / vec2f(size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), nearest.z);
    let clip = settings.previous_from_current * vec4f(ndc, 1.0);
    let previous_uv = clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5;
    let motion_uv = previous_uv - (pixel / vec2f(size));
    let history_uv = uv + motion_uv;
    let inside = all(history_uv >= vec2f(0.0)) && all(history_uv <= vec2f(1.0)) && clip.w > 0.0;
    if settings.history_valid == 0.0 || !inside {
        return current;
    }
    let old = to_ycocg(luma_weighted(textureSampleLevel(history, linear, history_uv, 0.0).rgb));
    let clipped = from_ycocg(clamp(old, mean - 1.25 * deviation, mean + 1.25 * deviation));
    return vec4f(luma_unweighted(mix(clipped, weighted, settings.current_weight)), current.a);
}
