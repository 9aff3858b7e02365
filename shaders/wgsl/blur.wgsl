// Blurs a screen mask over surfaces with a Poisson disc, rotated per pixel and wider nearby, that skips samples on other
// surfaces. After Pranckevičius, "Deferred Cascaded Shadow Maps" (2009), and Mitchell, "Poisson Shadow Blur" (ShaderX3,
// 2005).
#import shadowgraph::view::{view_depth_of, pixels_per_metre}
#import shadowgraph::frame_noise::frame_noise
#import shadowgraph::surface::unpack_normal

// The settings of the modifier `screen`.
struct ScreenSettings {
    // The blur radius in metres, and its limit in pixels.
    blur_m: f32,
    blur_max_px: f32,
    // The distance of two surfaces, as a fraction of their view depth, above which they are not blurred together.
    depth_threshold: f32,
}

@group(1) @binding(0) var surfaces: texture_2d<f32>;
@group(1) @binding(1) var input_mask: texture_2d_array<f32>;
@group(1) @binding(2) var mask: texture_storage_2d_array<rgba8unorm, write>;
@group(1) @binding(4) var<uniform> settings: ScreenSettings;

const TAPS: u32 = 16u;
// Points of the unit disc, each at least 0.49 from the others.
const DISC = array<vec2f, TAPS>(
    vec2f(0.2857, 0.4246), vec2f(-0.1977, -0.8546), vec2f(-0.6936, 0.6417), vec2f(0.7984, -0.4879),
    vec2f(-0.9381, -0.2836), vec2f(-0.2460, -0.0367), vec2f(0.9650, 0.1553), vec2f(-0.1677, 0.9594),
    vec2f(0.4068, -0.0604), vec2f(0.4008, -0.8943), vec2f(-0.2267, 0.4629), vec2f(-0.6761, -0.7094),
    vec2f(-0.9559, 0.2160), vec2f(0.3309, 0.9224), vec2f(0.7644, 0.6133), vec2f(0.1279, -0.4753),
);

@compute @workgroup_size(8, 8)
fn cs_blur(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(surfaces);
    if any(id.xy >= size) {
        return;
    }
    let surface = textureLoad(surfaces, id.xy, 0);
    let normal = unpack_normal(surface.w);
    var sum = textureLoad(input_mask, id.xy, id.z, 0).rgb;
    var count = 1.0;
    if any(normal != vec3f(0.0)) {
        let depth = view_depth_of(surface.xyz);
        let radius_px = min(settings.blur_m * pixels_per_metre(depth), settings.blur_max_px);
        let max_distance = settings.depth_threshold * depth;
        let pixel = vec2f(id.xy);
        let angle = 6.2831853 * frame_noise(pixel);
        let rotation = mat2x2f(cos(angle), sin(angle), -sin(angle), cos(angle));
        // Within half a pixel there is nothing to blur.
        let taps = select(0u, TAPS, radius_px > 0.5);
        for (var tap = 0u; tap < taps; tap++) {
            let at = vec2i(round(pixel + rotation * DISC[tap] * radius_px));
            if any(at < vec2i(0)) || any(at >= vec2i(size)) {
                continue;
            }
            let other = textureLoad(surfaces, at, 0);
            // Skip samples behind an edge, or on a surface that only intersects this one.
            let off_plane = abs(dot(other.xyz - surface.xyz, normal));
            if other.w >= 1.0 && abs(view_depth_of(other.xyz) - depth) < max_distance && off_plane < 0.5 * max_distance {
                sum += textureLoad(input_mask, at, id.z, 0).rgb;
                count += 1.0;
            }
        }
    }
    textureStore(mask, id.xy, id.z, vec4f(sum / count, 1.0));
}
