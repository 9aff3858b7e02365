// Shows a texture in the viewport with nearest texels, for debugging and depth outputs. Greys are written without
// conversion: an sRGB target shows them lighter than a linear one.
//
//   vs_show_depth, fs_show_depth    the camera's depth: white near, dark far, black where nothing is drawn
//   vs_show_depth, fs_show_atlas    raw depth, stretched to the range in the texture; black where it is empty
//   vs_show_texture, fs_show_texture    any float texture
//   vs_show_texture, fs_show_grey       a single-channel texture
#import shadowgraph::view::view_depth_from_depth
#import shadowgraph::fullscreen::fullscreen_vertex

// Group 0 binding 0 is the view; fs_show_depth alone reads it. Each entry point reads one of the textures.
@group(1) @binding(0) var depth_texture: texture_depth_2d;
@group(1) @binding(0) var float_texture: texture_2d<f32>;

// The grey of the farthest depth, distinct from the background.
const DARKEST: f32 = 0.06;
// The depth range is sampled at this many texels a side.
const PROBES: u32 = 64u;

struct ShowVertex {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    // Smallest and largest drawn raw depth.
    @location(1) @interpolate(flat) depth_range: vec2f,
}

fn texel_at(uv: vec2f, size: vec2u) -> vec2u {
    return min(vec2u(uv * vec2f(size)), size - 1u);
}

fn drawn_depth_range() -> vec2f {
    let size = textureDimensions(depth_texture);
    var range = vec2f(1.0, 0.0);
    for (var y = 0u; y < PROBES; y++) {
        for (var x = 0u; x < PROBES; x++) {
            let uv = (vec2f(f32(x), f32(y)) + 0.5) / f32(PROBES);
            let depth = textureLoad(depth_texture, texel_at(uv, size), 0);
            if depth > 0.0 {
                range = vec2f(min(range.x, depth), max(range.y, depth));
            }
        }
    }
    return range;
}

@vertex
fn vs_show_depth(@builtin(vertex_index) vertex_index: u32) -> ShowVertex {
    let corner = fullscreen_vertex(vertex_index);
    return ShowVertex(corner.position, corner.uv, drawn_depth_range());
}

@vertex
fn vs_show_texture(@builtin(vertex_index) vertex_index: u32) -> ShowVertex {
    let corner = fullscreen_vertex(vertex_index);
    return ShowVertex(corner.position, corner.uv, vec2f(0.0, 1.0));
}

fn load_depth(uv: vec2f) -> f32 {
    return textureLoad(depth_texture, texel_at(uv, textureDimensions(depth_texture)), 0);
}

// 1 at `start`, DARKEST at `end` and past it.
fn grey_between(value: f32, start: f32, end: f32) -> f32 {
    let span = end - start;
    if abs(span) < 1e-6 {
        return 1.0;
    }
    return mix(1.0, DARKEST, saturate((value - start) / span));
}

@fragment
fn fs_show_depth(in: ShowVertex) -> @location(0) vec4f {
    let depth = load_depth(in.uv);
    if depth <= 0.0 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    let nearest = view_depth_from_depth(1.0);
    let farthest = view_depth_from_depth(in.depth_range.x);
    let grey = grey_between(view_depth_from_depth(depth), nearest, farthest);
    return vec4f(vec3f(grey), 1.0);
}

@fragment
fn fs_show_atlas(in: ShowVertex) -> @location(0) vec4f {
    let depth = load_depth(in.uv);
    if depth <= 0.0 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    return vec4f(vec3f(grey_between(depth, in.depth_range.y, in.depth_range.x)), 1.0);
}

@fragment
fn fs_show_texture(in: ShowVertex) -> @location(0) vec4f {
    let texel = textureLoad(float_texture, texel_at(in.uv, textureDimensions(float_texture)), 0);
    return vec4f(texel.rgb, 1.0);
}

@fragment
fn fs_show_grey(in: ShowVertex) -> @location(0) vec4f {
    let texel = textureLoad(float_texture, texel_at(in.uv, textureDimensions(float_texture)), 0);
    return vec4f(texel.rrr, 1.0);
}
