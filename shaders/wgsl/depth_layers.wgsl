// Depth of casters in many views at once, each in a layer of a buffer: 1 nearest, 0 farthest, as the bits of floats. Instances are pairs of an
// instance and a view; the viewport is as large as a layer, so that geometry is cut at its edges. Translucent casters are drawn into layers of
// their own, where casters of the layers of depth do not hide them.
#import shadowgraph::noise::pixel_noise
#import shadowgraph::draw::{Vertex, clip_position, drawn, world_position}
#import shadowgraph::layer_views::LayerViews
#import shadowgraph::material::{
    BASE_COLOR, TextureCoordinates, base_color, caster_alpha, caster_cutoff, texture_uv, transmittance,
}
#import shadowgraph::tint_density::{density_of, packed_density, unpacked_density}

// The arguments of a draw of a batch, at a dynamic offset: see cull_layers.wgsl.
struct BatchDraw {
    arguments: array<u32, 5>,
    first_pair: u32,
}

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> depths: array<atomic<u32>>;
@group(0) @binding(2) var<storage, read> batch: BatchDraw;
// The depth of the translucent caster nearest to the light, and the density of all.
@group(0) @binding(3) var<storage, read_write> tint_depths: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> tint_densities: array<atomic<u32>>;

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

// The depth that a layer keeps. Uses derivatives: call in uniform control flow.
fn layer_depth(in: LayerVertex) -> u32 {
    let depth = in.depth.x / in.depth.y;
    let slope = max(abs(dpdx(depth)), abs(dpdy(depth)));
    let bias = layers.views[in.layer].slope_bias;
    // Beyond the triangle, where derivatives look too, the depth may be infinite.
    return bitcast<u32>(saturate(select(depth - bias * slope, depth, bias == 0.0)));
}

fn keep_nearest(in: LayerVertex, depth: u32) {
    let at = vec2u(in.position.xy);
    let index = (in.layer * layers.side_px + at.y) * layers.side_px + at.x;
    atomicMax(&depths[index], depth);
}

@fragment
fn fs_layer(in: LayerVertex) {
    keep_nearest(in, layer_depth(in));
}

@fragment
fn fs_layer_clip(in: LayerVertex) {
    let depth = layer_depth(in);
    if caster_alpha(in.uv, in.alpha) >= caster_cutoff() {
        keep_nearest(in, depth);
    }
}

@fragment
fn fs_layer_dither(in: LayerVertex) {
    let depth = layer_depth(in);
    // World-aligned texels: the pattern does not move with the layer.
    let texel = vec2f((vec2u(in.position.xy) + layers.views[in.layer].noise_px) & vec2u(1023u));
    if caster_alpha(in.uv, in.alpha) > pixel_noise(texel) {
        keep_nearest(in, depth);
    }
}

struct TintVertex {
    @builtin(position) position: vec4f,
    @location(0) uv_first: vec2f,
    @location(1) uv_second: vec2f,
    @location(2) color: vec4f,
    @location(3) depth: vec2f,
    @location(4) @interpolate(flat) layer: u32,
}

@vertex
fn vs_layer_tint(vertex: Vertex) -> TintVertex {
    let out = projected(vertex, vertex.uv_first);
    return TintVertex(out.position, out.uv, out.uv_second, vertex.color, out.depth, out.layer);
}

// Other threads may write the same texel. Helper invocations write nothing, so there are at most 64 attempts.
fn add_density(index: u32, density: vec3u) {
    var old = atomicLoad(&tint_densities[index]);
    for (var attempt = 0u; attempt < 64u; attempt++) {
        let sum = packed_density(unpacked_density(old) + density);
        let result = atomicCompareExchangeWeak(&tint_densities[index], old, sum);
        if result.exchanged {
            break;
        }
        old = result.old_value;
    }
}

@fragment
fn fs_layer_tint(in: TintVertex) {
    let density = density_of(transmittance(base_color(TextureCoordinates(in.uv_first, in.uv_second), in.color)));
    let at = vec2u(in.position.xy);
    let texel = at.y * layers.side_px + at.x;
    let layer_texels = layers.side_px * layers.side_px;
    let depth = bitcast<u32>(saturate(in.depth.x / in.depth.y));
    if depth >= atomicLoad(&depths[in.layer * layer_texels + texel]) {
        let index = layers.views[in.layer].tint_layer * layer_texels + texel;
        atomicMax(&tint_depths[index], depth);
        add_density(index, density);
    }
}
