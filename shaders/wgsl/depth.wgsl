// Depth, and the transmittance of translucent casters, for the prepass and shadow maps.
//
//   opaque        vs_depth, no fragment stage
//   with holes    vs_depth, fs_mask; for casters vs_alpha, fs_mask
//   dithered      vs_alpha, fs_dither
//   translucent   vs_depth, fs_tint: its colour multiplies the target, its depth is not written
//   casters in front of the near plane are kept at depth 1:
//     the device clamps (unclipped_depth)      as above
//     it does not                              vs_depth_clamp or vs_alpha_clamp with fs_clamp, fs_mask_clamp, fs_dither_clamp or fs_tint_clamp
#import shadowgraph::noise::pixel_noise
#import shadowgraph::draw::{Vertex, world_position, clip_position}
#import shadowgraph::material::{
    BASE_COLOR, TextureCoordinates, base_color, caster_alpha, caster_cutoff, hole_cutoff, texture_uv, transmittance,
}

// The used members of a ShadowView, or of a View if nothing is dithered; bound at a dynamic offset.
struct DepthView {
    clip_from_world: mat4x4f,
    @size(168) of_shadows: vec4f,
    noise_px: vec2u,
}

@group(0) @binding(0) var<storage, read> depth_view: DepthView;

// fs_clamp and fs_mask_clamp write the depth themselves, so the pipeline's slope bias does not apply: they add this times the
// depth's steepest change per pixel. Depth is reversed: negative pushes away.
override SLOPE_BIAS: f32 = 0.0;
// Whether holes are those of casters, not those that cameras see. The texture of the base colour then has one channel, the alpha.
override CASTS: bool = false;

struct DepthVertex {
    @invariant @builtin(position) position: vec4f,
    @location(0) uv_first: vec2f,
    @location(1) uv_second: vec2f,
    @location(2) color: vec4f,
    // z and w as they were before clamping.
    @location(3) unclamped: vec2f,
}

fn projected(vertex: Vertex, uv_first: vec2f) -> DepthVertex {
    let position = world_position(vertex.instance, vertex.position);
    let clip = clip_position(depth_view.clip_from_world, position);
    return DepthVertex(clip, uv_first, vertex.uv_second, vertex.color, clip.zw);
}

// Halfway between the planes nothing is clipped; the fragment stage restores the depth.
fn kept(out: DepthVertex) -> DepthVertex {
    var halfway = out;
    halfway.position.z = 0.5 * out.position.w;
    return halfway;
}

// The texture coordinates that caster_alpha expects.
fn alpha_uv(vertex: Vertex) -> vec2f {
    return texture_uv(BASE_COLOR, TextureCoordinates(vertex.uv_first, vertex.uv_second));
}

@vertex
fn vs_depth(vertex: Vertex) -> DepthVertex {
    return projected(vertex, vertex.uv_first);
}

@vertex
fn vs_depth_clamp(vertex: Vertex) -> DepthVertex {
    return kept(projected(vertex, vertex.uv_first));
}

@vertex
fn vs_alpha(vertex: Vertex) -> DepthVertex {
    return projected(vertex, alpha_uv(vertex));
}

@vertex
fn vs_alpha_clamp(vertex: Vertex) -> DepthVertex {
    return kept(projected(vertex, alpha_uv(vertex)));
}

fn color_of(in: DepthVertex) -> vec4f {
    return base_color(TextureCoordinates(in.uv_first, in.uv_second), in.color);
}

fn alpha_of(in: DepthVertex) -> f32 {
    if CASTS {
        return caster_alpha(in.uv_first, in.color.a);
    }
    return color_of(in).a;
}

fn transmitted(in: DepthVertex) -> vec4f {
    return vec4f(transmittance(color_of(in)), 1.0);
}

fn covers(in: DepthVertex) -> bool {
    return alpha_of(in) >= select(hole_cutoff(), caster_cutoff(), CASTS);
}

// Whether the dithered alpha covers a pixel.
fn covers_dithered(in: DepthVertex) -> bool {
    // World-aligned texels: the pattern does not move with the tile.
    let texel = vec2f((vec2u(in.position.xy) + depth_view.noise_px) & vec2u(1023u));
    let noise = pixel_noise(texel);
    return alpha_of(in) > noise;
}

// Uses derivatives: call in uniform control flow.
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
    if !covers_dithered(in) {
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
    if !covers_dithered(in) {
        discard;
    }
    return depth;
}

@fragment
fn fs_tint(in: DepthVertex) -> @location(0) vec4f {
    return transmitted(in);
}

struct ClampedTint {
    @builtin(frag_depth) depth: f32,
    @location(0) transmitted: vec4f,
}

@fragment
fn fs_tint_clamp(in: DepthVertex) -> ClampedTint {
    return ClampedTint(clamped_depth(in), transmitted(in));
}
