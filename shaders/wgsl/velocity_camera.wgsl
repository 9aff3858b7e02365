// Motion vectors of what stands still while the camera moves, from depth; see velocity.wgsl.
struct Settings {
    // From this frame's clip space to that of the previous frame, without jitter.
    previous_from_current: mat4x4f,
    // The same for what is infinitely far.
    background_previous_from_current: mat4x4f,
    // This frame's jitter, pixels.
    jitter_px: vec2f,
    px_from_ndc: vec2f,
}

@group(0) @binding(0) var depth_texture: texture_depth_2d;
@group(0) @binding(1) var<uniform> settings: Settings;

// What was behind the camera comes from far outside of the image.
const OUTSIDE = vec2f(32768.0);

@fragment
fn fs_velocity_camera(@builtin(position) position: vec4f) -> @location(0) vec2f {
    let depth = textureLoad(depth_texture, vec2i(position.xy), 0);
    let ndc = (position.xy - settings.jitter_px) / settings.px_from_ndc + vec2f(-1.0, 1.0);
    var previous = settings.previous_from_current * vec4f(ndc, depth, 1.0);
    if depth == 0.0 {
        previous = settings.background_previous_from_current * vec4f(ndc, 1.0, 1.0);
    }
    if previous.w <= 0.0 {
        return OUTSIDE;
    }
    return (previous.xy / previous.w - ndc) * settings.px_from_ndc;
}
