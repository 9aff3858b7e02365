// Finds how the pages of a frame store depths, and adds static casters to the layers of composite pages, into which moving casters have been
// drawn.
//
//   cs_static     finds the ranges of static pages
//   cs_composite  adds them to composite pages, rounded as they are stored: the same whether the static page is drawn in this frame or kept
#import shadowgraph::layer_views::{CASTERS_MOVING, LayerViews}
#import shadowgraph::shadows::page_depths::{LAST_STEP, PageDepths, depth_of_step, page_depths, stored_step}
#import shadowgraph::shadows::pages::{IS_LAYER, PAGE_PX, PhysicalPage, Projection, depth_at_infinity, place_texel}

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> depths: array<u32>;
// Size of the pool, and pages along its width.
@group(0) @binding(2) var<uniform> pool: vec4u;
@group(0) @binding(3) var page_pool: texture_depth_2d;
@group(0) @binding(4) var<storage, read_write> physical_pages: array<PhysicalPage>;
@group(0) @binding(5) var<storage, read> projections: array<Projection>;

const THREADS: u32 = 256u;
const LAYER_TEXELS: u32 = PAGE_PX * PAGE_PX;

// The least and the greatest depth of a layer, as the bits of floats above 0.
var<workgroup> first: atomic<u32>;
var<workgroup> last: atomic<u32>;

// Those of the texels of a thread.
struct Range {
    first: u32,
    last: u32,
}

const NO_CASTER: Range = Range(0xffffffffu, 0u);

fn with_texel(range: Range, bits: u32) -> Range {
    return Range(min(range.first, select(bits, 0xffffffffu, bits == 0u)), max(range.last, bits));
}

@compute @workgroup_size(256)
fn cs_static(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var layer = group.x; layer < layers.drawn; layer += groups.x) {
        if layers.views[layer].casters != CASTERS_MOVING {
            var range = NO_CASTER;
            for (var texel = local; texel < LAYER_TEXELS; texel += THREADS) {
                range = with_texel(range, depths[layer * LAYER_TEXELS + texel]);
            }
            keep_range(layer, range, local);
        }
    }
}

@compute @workgroup_size(256)
fn cs_composite(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var layer = group.x; layer < layers.drawn; layer += groups.x) {
        if layers.views[layer].casters == CASTERS_MOVING {
            keep_range(layer, add_static(layer, local), local);
        }
    }
}

fn add_static(layer: u32, local: u32) -> Range {
    let source = layers.views[layer].tag.y;
    let is_layer = (source & IS_LAYER) != 0u;
    let source_layer = source & ~IS_LAYER;
    var place = source;
    if is_layer {
        place = layers.views[source_layer].tag.x;
    }
    let static_depths = physical_pages[place].depths;
    let first_texel = place_texel(place, pool.z);
    var range = NO_CASTER;
    for (var texel = local; texel < LAYER_TEXELS; texel += THREADS) {
        var step = 0.0;
        if is_layer {
            let bits = depths[source_layer * LAYER_TEXELS + texel];
            step = select(0.0, stored_step(static_depths, bitcast<f32>(bits)), bits != 0u);
        } else {
            let at = first_texel + vec2u(texel % PAGE_PX, texel / PAGE_PX);
            step = round(textureLoad(page_pool, at, 0) * LAST_STEP);
        }
        let at = layer * LAYER_TEXELS + texel;
        let bits = max(depths[at], bitcast<u32>(depth_of_step(static_depths, step)));
        depths[at] = bits;
        range = with_texel(range, bits);
    }
    return range;
}

// Keeps how a page stores depths, with the ranges of all threads.
fn keep_range(layer: u32, range: Range, local: u32) {
    if local == 0u {
        atomicStore(&first, NO_CASTER.first);
        atomicStore(&last, NO_CASTER.last);
    }
    workgroupBarrier();
    if range.last > 0u {
        atomicMin(&first, range.first);
        atomicMax(&last, range.last);
    }
    workgroupBarrier();
    if local == 0u && atomicLoad(&last) > 0u {
        let place = layers.views[layer].tag.x;
        let projection = projections[physical_pages[place].page.projection];
        physical_pages[place].depths = page_depths(
            bitcast<f32>(atomicLoad(&first)), bitcast<f32>(atomicLoad(&last)), projection.is_perspective == 1u,
            depth_at_infinity(projection),
        );
    }
    workgroupBarrier();
}
