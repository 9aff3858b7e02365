// Contact shadows, for which maps are too coarse: marches through the depth of the screen from each surface towards the light,
// until a visible surface occludes it. After Sousa, "Secrets of CryENGINE 3 Graphics Technology" (SIGGRAPH 2011), *screen
// space self-shadowing*.
#import shadowgraph::view::{view, view_depth_of, pixels_per_metre}
#import shadowgraph::light::LIGHT_DIRECTIONAL
#import shadowgraph::lights::light_at
#import shadowgraph::frame_noise::frame_noise
#import shadowgraph::receiver::Receiver
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::layers::{MaskLayers, COLORED, channel_visibility, with_visibility}
#import shadowgraph::shadows::tiles::find
#import shadowgraph::shadows::views::{light_shadow, light_view}

// The settings of the modifier `contact`.
struct ContactSettings {
    // Length of the march, in texels of the map or pixels, whichever are wider.
    length_texels: f32,
    // Assumed thickness of surfaces, relative to the length: rays that pass farther behind them are not occluded.
    thickness: f32,
    max_steps: u32,
}

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var input_mask: texture_2d_array<f32>;
@group(2) @binding(2) var mask: texture_storage_2d_array<rgba8unorm, write>;
@group(2) @binding(3) var<uniform> layers: MaskLayers;
@group(2) @binding(4) var<uniform> settings: ContactSettings;

// The last fraction of the march, over which contact shadows fade out in favour of the maps.
const FADE: f32 = 0.25;
// The least height of an occluder above the surface's plane, as a fraction of view depth.
const MIN_HEIGHT: f32 = 0.0005;

// The width of the texels that the light's shadow at a point is read from, metres; 0 without a map.
fn texel_width(position: vec3f, normal: vec3f, view_depth: f32, light: u32) -> f32 {
    let shadow = light_shadow(light);
    if shadow.view_count == 0u {
        return 0.0;
    }
    var receiver: Receiver;
    receiver.position = position;
    receiver.view_depth = view_depth;
    receiver.geometric_normal = normal;
    let lookup = find(shadow, receiver, 0u);
    let texel = light_view(shadow, lookup.view).texel_world * lookup.w;
    return select(0.0, texel, lookup.covered);
}

// A position in the image, pixels; outside of it where the point is behind the camera.
fn pixel_of(position: vec3f, size: vec2f) -> vec2f {
    let clip = view.clip_from_world * vec4f(position, 1.0);
    return select(vec2f(-1.0), (clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5) * size, clip.w > 0.0);
}

// 1: not occluded.
fn contact_visibility(position: vec3f, normal: vec3f, light: u32, pixel: vec2u) -> f32 {
    let view_depth = view_depth_of(position);
    let texel = texel_width(position, normal, view_depth, light);
    var length_world = settings.length_texels * max(texel, 1.0 / pixels_per_metre(view_depth));
    let source = light_at(light);
    var to_light = -source.direction;
    if source.kind != LIGHT_DIRECTIONAL {
        let offset = source.position - position;
        let distance = length(offset);
        to_light = offset / max(distance, 1e-6);
        length_world = min(length_world, 0.9 * distance);
    }
    if dot(normal, to_light) <= 0.0 {
        return 1.0;
    }
    let size = vec2f(textureDimensions(surfaces));
    let height = MIN_HEIGHT * view_depth;
    // A step for each pixel that the ray passes; where those are too many, neighbouring pixels sample different steps.
    let length_px = distance(pixel_of(position + to_light * length_world, size), vec2f(pixel) + 0.5);
    let steps = u32(clamp(ceil(length_px), 1.0, f32(settings.max_steps)));
    let jitter = select(0.0, 0.5 * frame_noise(vec2f(pixel)), length_px > f32(steps));
    for (var step = 0u; step < steps; step++) {
        let fraction = (f32(step) + 0.5 + jitter) / f32(steps);
        let point = position + to_light * (fraction * length_world);
        let at = pixel_of(point, size);
        if any(at < vec2f(0.0)) || any(at >= size) {
            break;
        }
        let other = textureLoad(surfaces, vec2u(at), 0);
        if other.w < 1.0 {
            continue;
        }
        // Only what rises above the surface's plane can occlude it.
        let is_above = dot(other.xyz - position, normal) > height;
        let behind = view_depth_of(point) - view_depth_of(other.xyz);
        if is_above && behind > 0.0 && behind < settings.thickness * length_world {
            return saturate((fraction - 1.0) / FADE + 1.0);
        }
    }
    return 1.0;
}

@compute @workgroup_size(8, 8)
fn cs_contact(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = textureLoad(surfaces, id.xy, 0);
    let normal = unpack_normal(surface.w);
    var texel = textureLoad(input_mask, id.xy, id.z, 0);
    if any(normal != vec3f(0.0)) {
        let lights = layers.lights[id.z];
        for (var channel = 0u; channel < 4u && lights[channel] < COLORED; channel++) {
            let visibility = channel_visibility(texel, lights, channel);
            if any(visibility > vec3f(0.0)) {
                let contact = contact_visibility(surface.xyz, normal, lights[channel], id.xy);
                texel = with_visibility(texel, lights, channel, min(visibility, vec3f(contact)));
            }
        }
    }
    textureStore(mask, id.xy, id.z, texel);
}
