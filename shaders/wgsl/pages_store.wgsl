// Stores drawn pages in the pool: a quad for each, which takes the depth from its layer and clears it for the next frame.
#import shadowgraph::layer_views::LayerViews
#import shadowgraph::shadows::page_depths::{LAST_STEP, PageDepths, stored_step}
#import shadowgraph::shadows::pages::{PAGE_PX, PhysicalPage, place_texel}

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> depths: array<atomic<u32>>;
// Size of the pool, and pages along its width.
@group(0) @binding(2) var<uniform> pool: vec4u;
@group(0) @binding(3) var<storage, read> physical_pages: array<PhysicalPage>;

struct StoreVertex {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) layer: u32,
    @location(1) @interpolate(flat) first_texel: vec2u,
    // PageDepths.
    @location(2) @interpolate(flat) depths: vec3f,
}

@vertex
fn vs_store(@builtin(vertex_index) vertex: u32, @builtin(instance_index) layer: u32) -> StoreVertex {
    // Two triangles, of the corners 0 1 2 and 1 2 3.
    let number = vertex - select(0u, 2u, vertex > 2u);
    let corner = vec2u(number & 1u, number >> 1u);
    let place = layers.views[layer].tag.x;
    let first_texel = place_texel(place, pool.z);
    let page = physical_pages[place].depths;
    let at = vec2f(first_texel + corner * PAGE_PX) / vec2f(pool.xy);
    let position = vec4f(at * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0), 0.0, 1.0);
    return StoreVertex(position, layer, first_texel, vec3f(page.first, page.scale, page.curve));
}

@fragment
fn fs_store(in: StoreVertex) -> @builtin(frag_depth) f32 {
    let at = vec2u(in.position.xy) - in.first_texel;
    let depth = atomicExchange(&depths[(in.layer * PAGE_PX + at.y) * PAGE_PX + at.x], 0u);
    let step = stored_step(PageDepths(in.depths.x, in.depths.y, in.depths.z), bitcast<f32>(depth));
    return select(0.0, step / LAST_STEP, depth != 0u);
}
