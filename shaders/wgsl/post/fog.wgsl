// Light that thin fog scatters to the camera, shadows included: shafts of light. Steps along each pixel's way, with the phase
// function of Henyey and Greenstein (1941).
#import shadowgraph::view::{view, lights, view_depth_of, to_neighbour, LIGHT_DIRECTIONAL}
#import shadowgraph::fullscreen::{FullscreenVertex, fullscreen_vertex}
#import shadowgraph::lighting::arriving_light
#import shadowgraph::light_list::light_mask
#import shadowgraph::noise::pixel_noise
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT, RECEIVER_OFF_SCREEN}
#import shadowgraph::technique::shadow_visibility

struct Fog {
    // The part of the light that is scattered and not swallowed, by colour.
    albedo: vec3f,
    // Per metre, at `height`.
    density: f32,
    // Relative to the frame's origin, metres.
    height: f32,
    // How fast it gets thinner above, per metre.
    falloff: f32,
    // -1 back to the light, 0 evenly, 1 onwards.
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

// The light of all lights that a point scatters along `way`, per unit of what is scattered.
fn scattered(position: vec3f, way: vec3f, pixel: vec2f) -> vec3f {
    let view_depth = view_depth_of(position);
    let receiver = Receiver(
        position,
        view_depth,
        -way,
        RECEIVER_TRANSPARENT | RECEIVER_OFF_SCREEN,
        -way,
        pixel,
        to_neighbour(position, -way, view_depth, 0),
        -to_neighbour(position, -way, view_depth, 1),
    );
    var sum = (view.ambient_sky + view.ambient_ground) * 0.5;
    for (var word = 0u; word * 32u < view.light_count; word++) {
        var mask = light_mask(word, pixel, view_depth);
        while mask != 0u {
            let i = word * 32u + firstTrailingBit(mask);
            mask &= mask - 1u;
            if i >= view.light_count {
                break;
            }
            let arriving = arriving_light(lights[i], position);
            if arriving.attenuation > 0.0 {
                let visibility = shadow_visibility(i, receiver);
                let onwards = phase(dot(way, arriving.to_light));
                sum += lights[i].color * arriving.attenuation * visibility * onwards;
            }
        }
    }
    return sum;
}

// What is added, and in alpha what part of the light behind is lost.
@fragment
fn fs_fog(in: FullscreenVertex) -> @location(0) vec4f {
    let depth = textureLoad(depth_texture, vec2u(in.position.xy), 0);
    let near = at_depth(in.position.xy, 1.0);
    let beyond = at_depth(in.position.xy, 0.5);
    let way = normalize(beyond - near);
    var reach = fog.distance;
    if depth > 0.0 {
        reach = min(reach, distance(at_depth(in.position.xy, depth), near));
    }
    let step = reach / f32(fog.steps);
    let noise = pixel_noise(in.position.xy);
    var light = vec3f(0.0);
    var passing = 1.0;
    for (var i = 0u; i < fog.steps; i++) {
        let position = near + way * (f32(i) + noise) * step;
        let density = fog.density * exp(-max(position.y - fog.height, 0.0) * fog.falloff);
        let kept = exp(-density * step);
        if density > 0.0 {
            light += passing * (1.0 - kept) * scattered(position, way, in.position.xy);
        }
        passing *= kept;
    }
    let seen = light * fog.albedo * view.exposure;
    return vec4f(min(seen, vec3f(60000.0)), 1.0 - passing);
}
