// Depth of casters in many views at once, each in a layer of a buffer: 1 nearest, 0 farthest, as the bits of floats. Instances are pairs of an
// instance and a view; the viewport is as large as a layer, so that geometry is cut at its edges.
#import shadowgraph::noise::pixel_noise
#import shadowgraph::draw::{Vertex, clip_position, drawn, world_position}
#import shadowgraph::layer_views::LayerViews
#import shadowgraph::material::{BASE_COLOR, TextureCoordinates, caster_alpha, caster_cutoff, texture_uv}

// The arguments of a draw of a batch, at a dynamic offset: see cull_layers.wgsl.
struct BatchDraw {
    arguments: array<u32, 5>,
    first_pair: u32,
}

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> depths: array<atomic<u32>>;
@group(0) @binding(2) var<storage, read> batch: BatchDraw;

// Whether draws begin with the instance of their arguments.
override FIRST_INSTANCE: bool = true;

struct LayerVertex {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) uv_second: vec2f,
    @location(2) alpha: f32,
    // Before z is moved between the planes, where nothing is clipped.
    @location(3) depth: vec2f,
    @location(4) @interpolate(flat) layer: u32,
}

fn projected(vertex: Vertex, uv: vec2f) -> LayerVertex {
    let pair = 2u * (vertex.instance + select(batch.first_pair, 0u, FIRST_INSTANCE));
    let layer = drawn[pair + 1u];
    let clip = clip_position(layers.views[layer].clip_from_world, world_position(pair, vertex.position));
    let position = vec4f(clip.xy, 0.5 * clip.w, clip.w);
    return LayerVertex(position, uv, vertex.uv_second, vertex.color.a, clip.zw, layer);
}

@vertex
fn vs_layer(vertex: Vertex) -> LayerVertex {
    return projected(vertex, vertex.uv_first);
}

@vertex
fn vs_layer_alpha(vertex: Vertex) -> LayerVertex {
    return projected(vertex, texture_uv(BASE_COLOR, TextureCoordinates(vertex.uv_first, vertex.uv_second)));
}

fn keep_nearest(in: LayerVertex) {
    let at = vec2u(in.position.xy);
    let index = (in.layer * layers.side_px + at.y) * layers.side_px + at.x;
    atomicMax(&depths[index], bitcast<u32>(saturate(in.depth.x / in.depth.y)));
}

@fragment
fn fs_layer(in: LayerVertex) {
    keep_nearest(in);
}

@fragment
fn fs_layer_clip(in: LayerVertex) {
    if caster_alpha(in.uv, in.alpha) >= caster_cutoff() {
        keep_nearest(in);
    }
}

@fragment
fn fs_layer_dither(in: LayerVertex) {
    // World-aligned texels: the pattern does not move with the layer.
    let texel = vec2f((vec2u(in.position.xy) + layers.views[in.layer].noise_px) & vec2u(1023u));
    if caster_alpha(in.uv, in.alpha) > pixel_noise(texel) {
        keep_nearest(in);
    }
}
