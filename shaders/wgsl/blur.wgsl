// Blurs a screen mask with a Poisson disc on the plane of each surface, rotated per pixel, that skips samples on other surfaces
// (Pranckevičius, "Deferred Cascaded Shadow Maps", 2009, and Mitchell, "Poisson Shadow Blur", ShaderX3, 2005). Then averages
// neighbouring pixels, whose discs are rotated differently, so that no grain is left.
#import shadowgraph::view::{view, view_depth_of, pixels_per_metre}
#import shadowgraph::frame_noise::frame_noise
#import shadowgraph::surface::unpack_normal

// The settings of the modifier `screen`.
struct ScreenSettings {
    // The blur radius in metres, and its limit in pixels.
    blur_m: f32,
    blur_max_px: f32,
    // The distance from the surface's plane, as a fraction of its view depth, above which a point is not blurred into it.
    plane_threshold: f32,
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

// A surface that is blurred.
struct Blurred {
    position: vec3f,
    normal: vec3f,
    // View depth.
    depth: f32,
    // The radius of the blur in pixels; 0 where there is no surface.
    radius_px: f32,
}

fn blurred(pixel: vec2u) -> Blurred {
    let surface = textureLoad(surfaces, pixel, 0);
    let normal = unpack_normal(surface.w);
    let depth = view_depth_of(surface.xyz);
    let radius_px = min(settings.blur_m * pixels_per_metre(depth), settings.blur_max_px);
    return Blurred(surface.xyz, normal, depth, select(0.0, radius_px, any(normal != vec3f(0.0))));
}

// Whether a pixel is in the image and shows a point on the plane of a surface.
fn is_on_plane(surface: Blurred, pixel: vec2i) -> bool {
    if any(pixel < vec2i(0)) || any(pixel >= vec2i(textureDimensions(surfaces))) {
        return false;
    }
    let other = textureLoad(surfaces, pixel, 0);
    let distance = abs(dot(other.xyz - surface.position, surface.normal));
    return other.w >= 1.0 && distance < settings.plane_threshold * surface.depth;
}

// Where a short way from a point leads in the image, pixels.
fn in_image(way: vec3f, point_clip: vec4f) -> vec2f {
    let way_clip = view.clip_from_world * vec4f(way, 0.0);
    let ndc = (way_clip.xy - point_clip.xy * (way_clip.w / point_clip.w)) / point_clip.w;
    return ndc * vec2f(0.5, -0.5) * view.size_px;
}

@compute @workgroup_size(8, 8)
fn cs_blur(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = blurred(id.xy);
    var sum = textureLoad(input_mask, id.xy, id.z, 0);
    var count = 1.0;
    // Within half a pixel there is nothing to blur.
    if surface.radius_px > 0.5 {
        let radius_m = surface.radius_px / pixels_per_metre(surface.depth);
        let is_level = abs(surface.normal.y) > 0.7;
        let side = normalize(cross(surface.normal, select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), is_level))) * radius_m;
        let across = cross(surface.normal, side);
        let angle = 6.2831853 * frame_noise(vec2f(id.xy));
        let clip = view.clip_from_world * vec4f(surface.position, 1.0);
        let disc = mat2x2f(
            in_image(cos(angle) * side + sin(angle) * across, clip),
            in_image(cos(angle) * across - sin(angle) * side, clip),
        );
        for (var tap = 0u; tap < TAPS; tap++) {
            let at = vec2i(round(vec2f(id.xy) + disc * DISC[tap]));
            if is_on_plane(surface, at) {
                sum += textureLoad(input_mask, at, id.z, 0);
                count += 1.0;
            }
        }
    }
    textureStore(mask, id.xy, id.z, sum / count);
}

@compute @workgroup_size(8, 8)
fn cs_smooth(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = blurred(id.xy);
    var sum = vec4f(0.0);
    var count = 0.0;
    // A narrow disc has little grain.
    let half = i32(clamp(0.5 * surface.radius_px, 0.0, 2.0));
    for (var y = -half; y <= half; y++) {
        for (var x = -half; x <= half; x++) {
            let at = vec2i(id.xy) + vec2i(x, y);
            if (x == 0 && y == 0) || is_on_plane(surface, at) {
                sum += textureLoad(input_mask, at, id.z, 0);
                count += 1.0;
            }
        }
    }
    textureStore(mask, id.xy, id.z, sum / count);
}
