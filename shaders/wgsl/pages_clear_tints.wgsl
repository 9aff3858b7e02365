// Clears the tints of the pages that are drawn: no translucent caster.
#import shadowgraph::layer_views::LayerViews
#import shadowgraph::shadows::pages::PAGE_PX

@group(0) @binding(0) var<storage, read> layers: LayerViews;
@group(0) @binding(1) var<storage, read_write> tint_depths: array<u32>;
@group(0) @binding(2) var<storage, read_write> tint_densities: array<u32>;

const THREADS: u32 = 256u;

@compute @workgroup_size(256)
fn cs_clear(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var layer = group.x; layer < layers.drawn; layer += groups.x) {
        let first = layers.views[layer].tint_layer * PAGE_PX * PAGE_PX;
        for (var texel = local; texel < PAGE_PX * PAGE_PX; texel += THREADS) {
            tint_depths[first + texel] = 0u;
            tint_densities[first + texel] = 0u;
        }
    }
}
