// Adds the depths of static pages to the layers of composite pages, into which moving casters have been drawn.
#import shadowgraph::layer_views::{CASTERS_MOVING, LayerViews}
#import shadowgraph::shadows::pages::{IS_LAYER, PAGE_PX, place_texel}

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> depths: array<u32>;
// Size of the pool, and pages along its width.
@group(0) @binding(2) var<uniform> pool: vec4u;
@group(0) @binding(3) var page_pool: texture_depth_2d;

const THREADS: u32 = 256u;

@compute @workgroup_size(256)
fn cs_combine(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var layer = group.x; layer < layers.drawn; layer += groups.x) {
        if layers.views[layer].casters != CASTERS_MOVING {
            continue;
        }
        let source = layers.views[layer].tag.y;
        for (var texel = local; texel < PAGE_PX * PAGE_PX; texel += THREADS) {
            let at = layer * PAGE_PX * PAGE_PX + texel;
            depths[at] = max(depths[at], static_depth(source, texel));
        }
    }
}

// The bits of the depth of a static page.
fn static_depth(source: u32, texel: u32) -> u32 {
    if (source & IS_LAYER) != 0u {
        return depths[(source & ~IS_LAYER) * PAGE_PX * PAGE_PX + texel];
    }
    let at = place_texel(source, pool.z) + vec2u(texel % PAGE_PX, texel / PAGE_PX);
    return bitcast<u32>(textureLoad(page_pool, at, 0));
}
