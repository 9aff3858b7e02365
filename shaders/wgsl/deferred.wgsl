// Deferred lighting: shades each pixel of the G-buffer with every light.
#import shadowgraph::view::{view, view_depth_of, direction_to_camera, to_neighbour}
#import shadowgraph::frame_noise::noise_flags
#import shadowgraph::fullscreen::{FullscreenVertex, fullscreen_vertex}
#import shadowgraph::surface::unfold
#import shadowgraph::gbuffer_layout::{
    SURFACE_UNLIT, SURFACE_UNSHADOWED, SURFACE_BACK_FACE, flags_from_unorm,
}
#import shadowgraph::receiver::{Receiver, RECEIVER_BACK_FACE}
#import shadowgraph::lighting::surface_of
#import shadowgraph::environment::{HAS_BACKGROUND, background_light}
#import shadowgraph::shade::{shade_surface, visibility_output, debug_output}

override AOV: u32 = 0u;
override AOV_LIGHT: u32 = 0u;

const AOV_VISIBILITY: u32 = 1u;
const AOV_CASCADE: u32 = 2u;
const AOV_NORMAL: u32 = 3u;
const MAX_RADIANCE: f32 = 60000.0;

@group(2) @binding(0) var depth_texture: texture_depth_2d;
@group(2) @binding(1) var base_color_texture: texture_2d<f32>;
@group(2) @binding(2) var material_texture: texture_2d<f32>;
@group(2) @binding(3) var normal_texture: texture_2d<u32>;
@group(2) @binding(4) var emissive_texture: texture_2d<f32>;

@vertex
fn vs_deferred(@builtin(vertex_index) vertex_index: u32) -> FullscreenVertex {
    return fullscreen_vertex(vertex_index);
}

// The position relative to the camera of a pixel's centre at a depth.
fn camera_relative_position(pixel: vec2f, depth: f32) -> vec3f {
    let ndc = pixel / view.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let position = view.world_from_clip * vec4f(ndc, depth, 1.0);
    return position.xyz / position.w - view.position;
}

@fragment
fn fs_deferred(in: FullscreenVertex) -> @location(0) vec4f {
    let texel = vec2u(in.position.xy);
    let depth = textureLoad(depth_texture, texel, 0);
    if depth == 0.0 {
        if !HAS_BACKGROUND || AOV != 0u {
            discard;
        }
        return background_light(in.position.xy);
    }
    let base_color = textureLoad(base_color_texture, texel, 0);
    let material = textureLoad(material_texture, texel, 0);
    let normals = textureLoad(normal_texture, texel, 0);
    let emissive = textureLoad(emissive_texture, texel, 0).rgb;
    let flags = flags_from_unorm(base_color.a);
    let unshadowed = (flags & SURFACE_UNSHADOWED) != 0u;
    let from_camera = camera_relative_position(in.position.xy, depth);
    let to_camera = direction_to_camera(from_camera);
    let normal = unfold(unpack2x16snorm(normals.x));
    let flat_normal = unfold(unpack2x16snorm(normals.y));
    let position = from_camera + view.position;
    let view_depth = view_depth_of(position);
    let receiver = Receiver(
        position,
        view_depth,
        flat_normal,
        select(0u, RECEIVER_BACK_FACE, (flags & SURFACE_BACK_FACE) != 0u) | noise_flags(in.position.xy),
        normal,
        in.position.xy,
        to_neighbour(position, flat_normal, view_depth, 0),
        -to_neighbour(position, flat_normal, view_depth, 1),
    );
    if AOV == AOV_VISIBILITY {
        return visibility_output(AOV_LIGHT, receiver, unshadowed);
    }
    if AOV == AOV_CASCADE {
        return debug_output(AOV_LIGHT, receiver, to_camera, unshadowed);
    }
    if AOV == AOV_NORMAL {
        return vec4f(normal * 0.5 + 0.5, 1.0);
    }
    var radiance = emissive;
    if (flags & SURFACE_UNLIT) == 0u {
        let surface = surface_of(base_color.rgb, material.xy, material.z, normal, to_camera);
        radiance += shade_surface(surface, receiver, unshadowed) * view.exposure;
    }
    return vec4f(min(radiance, vec3f(MAX_RADIANCE)), 1.0);
}
