// Light that thin fog scatters to the camera, with shadows: light shafts. Marches along each pixel's ray, with the phase
// function of Henyey and Greenstein (1941).
#import shadowgraph::view::{view, view_depth_of}
#import shadowgraph::lights::{light_at, light_count}
#import shadowgraph::frame_noise::noise_flags
#import shadowgraph::fullscreen::{FullscreenVertex, fullscreen_vertex}
#import shadowgraph::lighting::arriving_light
#import shadowgraph::light_list::next_light
#import shadowgraph::noise::pixel_noise
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT, RECEIVER_OFF_SCREEN}
#import shadowgraph::technique::shadow_visibility

struct Fog {
    // The fraction of the light that is scattered and not absorbed, by colour.
    albedo: vec3f,
    // Per metre, at `height`.
    density: f32,
    // Relative to the frame's origin, metres.
    height: f32,
    // Exponential falloff of the density above, per metre.
    falloff: f32,
    // -1 backward, 0 isotropic, 1 forward.
    anisotropy: f32,
    // Metres from the camera.
    distance: f32,
    steps: u32,
}

@group(2) @binding(0) var depth_texture: texture_depth_2d;
@group(2) @binding(1) var<uniform> fog: Fog;

const PI: f32 = 3.14159265358979;

@vertex
fn vs_fog(@builtin(vertex_index) vertex_index: u32) -> FullscreenVertex {
    return fullscreen_vertex(vertex_index);
}

fn at_depth(pixel: vec2f, depth: f32) -> vec3f {
    let ndc = pixel / view.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let position = view.world_from_clip * vec4f(ndc, depth, 1.0);
    return position.xyz / position.w;
}

fn phase(cosine: f32) -> f32 {
    let g = fog.anisotropy;
    let base = max(1.0 + g * g - 2.0 * g * cosine, 1e-4);
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}

// The light of all lights that a point scatters along the ray, per unit of scattered light.
fn scattered(position: vec3f, direction: vec3f, pixel: vec2f) -> vec3f {
    let view_depth = view_depth_of(position);
    let receiver = Receiver(
        position,
        view_depth,
        -direction,
        RECEIVER_TRANSPARENT | RECEIVER_OFF_SCREEN | noise_flags(pixel),
        -direction,
        pixel,
        vec3f(0.0),
        vec3f(0.0),
    );
    var sum = (view.ambient_sky + view.ambient_ground) * 0.5;
    var i = next_light(0u, pixel, view_depth);
    loop {
        let light = light_at(i);
        let arriving = arriving_light(light, position);
        if i < light_count() && arriving.attenuation > 0.0 {
            let visibility = shadow_visibility(i, receiver);
            sum += light.color * arriving.attenuation * visibility * phase(dot(direction, arriving.to_light));
        }
        i = next_light(i + 1u, pixel, view_depth);
        if i >= light_count() {
            break;
        }
    }
    return sum;
}

// Scattered light, and in alpha the fraction of the background that is lost.
@fragment
fn fs_fog(in: FullscreenVertex) -> @location(0) vec4f {
    let depth = textureLoad(depth_texture, vec2u(in.position.xy), 0);
    let near = at_depth(in.position.xy, 1.0);
    let far = at_depth(in.position.xy, 0.5);
    let direction = normalize(far - near);
    var ray_length = fog.distance;
    if depth > 0.0 {
        ray_length = min(ray_length, distance(at_depth(in.position.xy, depth), near));
    }
    let step = ray_length / f32(fog.steps);
    let noise = pixel_noise(in.position.xy);
    var light = vec3f(0.0);
    var transmittance = 1.0;
    for (var i = 0u; i < fog.steps; i++) {
        let position = near + direction * (f32(i) + noise) * step;
        let density = fog.density * exp(-max(position.y - fog.height, 0.0) * fog.falloff);
        let step_transmittance = exp(-density * step);
        if density > 0.0 {
            light += transmittance * (1.0 - step_transmittance) * scattered(position, direction, in.position.xy);
        }
        transmittance *= step_transmittance;
    }
    let seen = light * fog.albedo * view.exposure;
    return vec4f(min(seen, vec3f(60000.0)), 1.0 - transmittance);
}
