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
    // Added to depth, it makes it inversely proportional to view depth (perspective).
    depth_offset: f32,
}

@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var history: texture_2d<f32>;
@group(0) @binding(2) var depth_texture: texture_depth_2d;
@group(0) @binding(3) var linear: sampler;
@group(0) @binding(4) var<uniform> settings: Settings;
// Only with motion vectors: the motion of each pixel back to the previous frame, pixels; and what was written there as `surface`.
@group(0) @binding(5) var velocity: texture_2d<f32>;
@group(0) @binding(6) var previous_surface: texture_2d<f32>;

// A surface that was nearer by more than this factor hid what lies behind it.
const HIDING_FACTOR: f32 = 1.1;
// The history is clipped to this many standard deviations around the mean of the neighbourhood. With fewer, the mean of noise in
// smooth shadows is clipped as well.
const CLIP_DEVIATIONS: f32 = 2.0;

fn to_ycocg(color: vec3f) -> vec3f {
    return vec3f(
        dot(color, vec3f(0.25, 0.5, 0.25)), dot(color, vec3f(0.5, 0.0, -0.5)), dot(color, vec3f(-0.25, 0.5, -0.25)));
}

fn from_ycocg(color: vec3f) -> vec3f {
    return vec3f(color.x + color.y - color.z, color.x + color.z, color.x - color.y - color.z);
}

// Compresses colours brighter than white while they are blended, so that single bright samples do not dominate. Up to white
// nothing is compressed: the mean of noise would be too dark.
fn luma_weighted(color: vec3f) -> vec3f {
    let brightest = max(1.0, max(color.r, max(color.g, color.b)));
    return color * (2.0 - 1.0 / brightest) / brightest;
}

fn luma_unweighted(color: vec3f) -> vec3f {
    let brightest = max(1.0, max(color.r, max(color.g, color.b)));
    return color / (brightest * max(2.0 - brightest, 1e-3));
}

// The 3x3 pixels around a pixel.
struct Neighbourhood {
    // Of the weighted colours, in YCoCg.
    mean: vec3f,
    deviation: vec3f,
    // The offset to the pixel with the nearest surface, and its depth: edges move with the nearest surface.
    nearest: vec3f,
}

fn neighbourhood_of(texel: vec2i, size: vec2i) -> Neighbourhood {
    var nearest = vec3f(0.0, 0.0, -1.0);
    var mean = vec3f(0.0);
    var square = vec3f(0.0);
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let other = clamp(texel + vec2i(x, y), vec2i(0), size - 1);
            let color = to_ycocg(luma_weighted(textureLoad(light, other, 0).rgb));
            mean += color;
            square += color * color;
            let depth = textureLoad(depth_texture, other, 0);
            if depth > nearest.z {
                nearest = vec3f(vec2f(f32(x), f32(y)), depth);
            }
        }
    }
    mean /= 9.0;
    let deviation = sqrt(max(square / 9.0 - mean * mean, vec3f(0.0)));
    return Neighbourhood(mean, deviation, nearest);
}

// The clip space position in the previous frame of a surface that stands still, from its unjittered position in this one, pixels.
fn previous_clip(pixel: vec2f, depth: f32, size: vec2i) -> vec4f {
    let ndc = vec3f(pixel / vec2f(size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), depth);
    return settings.previous_from_current * vec4f(ndc, 1.0);
}

// Whether a position in the image is inside of it.
fn is_inside(uv: vec2f) -> bool {
    return all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0));
}

// The history at a position, clipped to the neighbourhood and blended with this frame's colour.
fn blended(current: vec3f, history_uv: vec2f, around: Neighbourhood, weight: f32) -> vec3f {
    let weighted = luma_weighted(current);
    let old = to_ycocg(luma_weighted(textureSampleLevel(history, linear, history_uv, 0.0).rgb));
    // With this frame's colour within the range, an image that does not change stays as it is.
    let own = to_ycocg(weighted);
    let lowest = min(own, around.mean - CLIP_DEVIATIONS * around.deviation);
    let highest = max(own, around.mean + CLIP_DEVIATIONS * around.deviation);
    return luma_unweighted(mix(from_ycocg(clamp(old, lowest, highest)), weighted, weight));
}

@fragment
fn fs_temporal(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let size = vec2i(textureDimensions(light));
    let texel = vec2i(position.xy);
    let around = neighbourhood_of(texel, size);
    let current = textureLoad(light, texel, 0);
    let pixel = position.xy + around.nearest.xy - settings.jitter_px;
    let clip = previous_clip(pixel, around.nearest.z, size);
    let previous_uv = clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5;
    let motion_uv = previous_uv - (pixel / vec2f(size));
    let history_uv = uv + motion_uv;
    if settings.history_valid == 0.0 || !is_inside(history_uv) || clip.w <= 0.0 {
        return current;
    }
    return vec4f(blended(current.rgb, history_uv, around, settings.current_weight), current.a);
}

// The surface of a pixel around `texel` that is nearest to the camera: of those that move by `motion_px` too.
fn nearest_moving_along(texel: vec2i, size: vec2i, motion_px: vec2f) -> f32 {
    let tolerance_px = max(0.2, 0.1 * length(motion_px));
    var nearest = 0.0;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let other = clamp(texel + vec2i(x, y), vec2i(0), size - 1);
            let difference_px = textureLoad(velocity, other, 0).xy - motion_px;
            if length(difference_px) <= tolerance_px {
                nearest = max(nearest, textureLoad(depth_texture, other, 0));
            }
        }
    }
    return nearest;
}

// Whether the history at a position is that of another surface, which hid this one in the previous frame. `depth` is this
// surface's depth at that time.
fn was_hidden(texel: vec2i, size: vec2i, from_px: vec2f, motion_px: vec2f, depth: f32) -> bool {
    // Pixels next to a surface took over its motion and its history, so they are not of use either.
    var hiding = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let other = clamp(vec2i(from_px) + vec2i(x, y), vec2i(0), size - 1);
            hiding = max(hiding, textureLoad(previous_surface, other, 0).x);
        }
    }
    let limit = hiding + settings.depth_offset;
    if limit <= HIDING_FACTOR * (depth + settings.depth_offset) {
        return false;
    }
    // An edge that moves along: jitter and rounding move it by up to two pixels.
    return limit > HIDING_FACTOR * (nearest_moving_along(texel, size, motion_px) + settings.depth_offset);
}

struct Accumulated {
    @location(0) light: vec4f,
    // The depth, and the number of frames in the light, at most 256.
    @location(1) surface: vec2f,
}

@fragment
fn fs_temporal_velocity(@builtin(position) position: vec4f) -> Accumulated {
    let size = vec2i(textureDimensions(light));
    let texel = vec2i(position.xy);
    let around = neighbourhood_of(texel, size);
    let current = textureLoad(light, texel, 0);
    let depth = textureLoad(depth_texture, texel, 0);
    let edge = clamp(texel + vec2i(around.nearest.xy), vec2i(0), size - 1);
    let motion_px = textureLoad(velocity, edge, 0).xy;
    let from_px = position.xy + motion_px;
    let history_uv = from_px / vec2f(size);
    let clip = previous_clip(position.xy + around.nearest.xy - settings.jitter_px, around.nearest.z, size);
    if settings.history_valid == 0.0
        || !is_inside(history_uv)
        || was_hidden(texel, size, from_px, motion_px, clip.z / clip.w)
    {
        return Accumulated(current, vec2f(depth, 1.0));
    }
    let frames = 1.0 + textureLoad(previous_surface, min(vec2i(from_px), size - 1), 0).y;
    let weight = max(settings.current_weight, 1.0 / frames);
    let mixed = vec4f(blended(current.rgb, history_uv, around, weight), current.a);
    return Accumulated(mixed, vec2f(depth, min(frames, 256.0)));
}
