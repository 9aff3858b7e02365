// Depth, and the colour of light behind translucent casters: the prepass and the shadow maps.
//
//   opaque        vs_depth, no fragment stage
//   with holes    vs_depth, fs_mask
//   dithered      vs_depth, fs_dither
//   translucent   vs_depth, fs_tint: its colour multiplies the target, its depth is not written
//   casters before the near plane are kept at depth 1:
//     the device clamps (unclipped_depth)      as above
//     it does not                              vs_depth_clamp with fs_clamp, fs_mask_clamp, fs_dither_clamp or fs_tint_clamp
#import shadowgraph::noise::pixel_noise
#import shadowgraph::draw::{Vertex, world_position, clip_position}
#import shadowgraph::material::{TextureCoordinates, base_color, hole_cutoff}

// What is read of a ShadowView, or of a View where nothing is dithered: bound at a dynamic offset.
struct DepthView {
    clip_from_world: mat4x4f,
    @size(168) of_shadows: vec4f,
    noise_px: vec2u,
}

@group(0) @binding(0) var<storage, read> depth_view: DepthView;

// fs_clamp and fs_mask_clamp write the depth themselves, which the pipeline's own slope bias does not reach:
// they add this times the depth's steepest change per pixel. Reversed depth: negative pushes away.
override SLOPE_BIAS: f32 = 0.0;

struct DepthVertex {
    @invariant @builtin(position) position: vec4f,
    @location(0) uv_first: vec2f,
    @location(1) uv_second: vec2f,
    @location(2) color: vec4f,
    // z and w as they were before clamping.
    @location(3) unclamped: vec2f,
}

@vertex
fn vs_depth(vertex: Vertex) -> DepthVertex {
    let position = world_position(vertex.instance, vertex.position);
    let clip = clip_position(depth_view.clip_from_world, position);
    return DepthVertex(clip, vertex.uv_first, vertex.uv_second, vertex.color, clip.zw);
}

@vertex
fn vs_depth_clamp(vertex: Vertex) -> DepthVertex {
    let position = world_position(vertex.instance, vertex.position);
    let clip = clip_position(depth_view.clip_from_world, position);
    // Halfway between the planes nothing is clipped; the fragment stage puts the depth back.
    let kept = vec4f(clip.xy, 0.5 * clip.w, clip.w);
    return DepthVertex(kept, vertex.uv_first, vertex.uv_second, vertex.color, clip.zw);
}

fn color_of(in: DepthVertex) -> vec4f {
    return base_color(TextureCoordinates(in.uv_first, in.uv_second), in.color);
}

fn alpha_of(in: DepthVertex) -> f32 {
    return color_of(in).a;
}

// What of the light passes: what gets past the surface, in its colour the more the denser it is.
fn passed(in: DepthVertex) -> vec4f {
    let color = color_of(in);
    let alpha = saturate(color.a);
    return vec4f((1.0 - alpha) * mix(vec3f(1.0), saturate(color.rgb), alpha * (2.0 - alpha)), 1.0);
}

fn covers(in: DepthVertex) -> bool {
    return alpha_of(in) >= hole_cutoff();
}

// As many pixels as alpha says.
fn covers_by_chance(in: DepthVertex) -> bool {
    // Texels of the world: the pattern stays where it is while the tile moves.
    let texel = vec2f((vec2u(in.position.xy) + depth_view.noise_px) & vec2u(1023u));
    let noise = pixel_noise(texel);
    return alpha_of(in) > noise;
}

// Takes derivatives: call in uniform control flow.
fn clamped_depth(in: DepthVertex) -> f32 {
    let depth = in.unclamped.x / in.unclamped.y;
    let slope = max(abs(dpdx(depth)), abs(dpdy(depth)));
    return saturate(depth + SLOPE_BIAS * slope);
}

@fragment
fn fs_mask(in: DepthVertex) {
    if !covers(in) {
        discard;
    }
}

@fragment
fn fs_dither(in: DepthVertex) {
    if !covers_by_chance(in) {
        discard;
    }
}

@fragment
fn fs_clamp(in: DepthVertex) -> @builtin(frag_depth) f32 {
    return clamped_depth(in);
}

@fragment
fn fs_mask_clamp(in: DepthVertex) -> @builtin(frag_depth) f32 {
    let depth = clamped_depth(in);
    if !covers(in) {
        discard;
    }
    return depth;
}

@fragment
fn fs_dither_clamp(in: DepthVertex) -> @builtin(frag_depth) f32 {
    let depth = clamped_depth(in);
    if !covers_by_chance(in) {
        discard;
    }
    return depth;
}

@fragment
fn fs_tint(in: DepthVertex) -> @location(0) vec4f {
    return passed(in);
}

struct ClampedTint {
    @builtin(frag_depth) depth: f32,
    @location(0) passed: vec4f,
}

@fragment
fn fs_tint_clamp(in: DepthVertex) -> ClampedTint {
    return ClampedTint(clamped_depth(in), passed(in));
}
