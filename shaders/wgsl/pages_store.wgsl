// Stores drawn pages in the pool: a quad for each, which takes the depth from its layer and clears it for the next frame.
#import shadowgraph::layer_views::LayerViews
#import shadowgraph::shadows::pages::{PAGE_PX, place_texel}

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> depths: array<atomic<u32>>;
// Size of the pool, and pages along its width.
@group(0) @binding(2) var<uniform> pool: vec4u;

struct StoreVertex {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) layer: u32,
}

fn first_texel(layer: u32) -> vec2u {
    return place_texel(layers.views[layer].tag.x, pool.z);
}

@vertex
fn vs_store(@builtin(vertex_index) vertex: u32, @builtin(instance_index) layer: u32) -> StoreVertex {
    // Two triangles, of the corners 0 1 2 and 1 2 3.
    let number = vertex - select(0u, 2u, vertex > 2u);
    let corner = vec2u(number & 1u, number >> 1u);
    let at = vec2f(first_texel(layer) + corner * PAGE_PX) / vec2f(pool.xy);
    return StoreVertex(vec4f(at * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0), layer);
}

@fragment
fn fs_store(in: StoreVertex) -> @builtin(frag_depth) f32 {
    let at = vec2u(in.position.xy) - first_texel(in.layer);
    return bitcast<f32>(atomicExchange(&depths[(in.layer * PAGE_PX + at.y) * PAGE_PX + at.x], 0u));
}
