// The lights to evaluate at a point: those of its cluster.
#define_import_path shadowgraph::light_list
#import shadowgraph::view::view
#import shadowgraph::lights::light_count
#import shadowgraph::cluster_grid::{CLUSTERS, slice_of, cluster_texel}

@group(0) @binding(2) var cluster_lights: texture_2d<u32>;

// The first light, from `begin` on, that may reach the pixel's surface, `view_depth` metres in front of the camera; the number of
// lights or more if there is none.
fn next_light(begin: u32, pixel: vec2f, view_depth: f32) -> u32 {
    let tile = vec2u(pixel / view.size_px * vec2f(CLUSTERS.xy));
    let cluster = vec3u(min(tile, CLUSTERS.xy - 1u), slice_of(view_depth, view.near));
    // Bit i of word w: light 32 w + i.
    var word = begin / 32u;
    var lights = lights_in(cluster, word) & (0xffffffffu << (begin % 32u));
    while lights == 0u {
        word++;
        if word * 32u >= light_count() {
            return light_count();
        }
        lights = lights_in(cluster, word);
    }
    return word * 32u + firstTrailingBit(lights);
}

fn lights_in(cluster: vec3u, word: u32) -> u32 {
    return textureLoad(cluster_lights, cluster_texel(cluster, word, light_count()), 0).r;
}
