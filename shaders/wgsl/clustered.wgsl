// The lights to evaluate at a point: those of its cluster.
#define_import_path shadowgraph::light_list
#import shadowgraph::view::view
#import shadowgraph::cluster_grid::{CLUSTERS, slice_of, cluster_texel}

@group(0) @binding(2) var cluster_lights: texture_2d<u32>;

fn light_mask(word: u32, pixel: vec2f, view_depth: f32) -> u32 {
    let tile = vec2u(pixel / view.size_px * vec2f(CLUSTERS.xy));
    let cluster = vec3u(min(tile, CLUSTERS.xy - 1u), slice_of(view_depth, view.near));
    return textureLoad(cluster_lights, cluster_texel(cluster, word, view.light_count), 0).r;
}
