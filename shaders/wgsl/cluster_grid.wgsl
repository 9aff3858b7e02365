// The grid of clusters that a view frustum is divided into for light culling (Olsson, Billeter and Assarsson, "Clustered
// Deferred and Forward Shading", 2012).
#define_import_path shadowgraph::cluster_grid

// Across, down, and away from the camera.
const CLUSTERS: vec3u = vec3u(16u, 9u, 24u);
// Where the last, unbounded slice begins, in multiples of the near plane's distance.
const LAST_SLICE_NEARS: f32 = 10000.0;

// View depth where a slice begins, metres; slices grow with the distance.
fn slice_begin(slice: u32, near: f32) -> f32 {
    return near * pow(LAST_SLICE_NEARS, f32(slice) / f32(CLUSTERS.z));
}

fn slice_of(view_depth: f32, near: f32) -> u32 {
    let slice = log(max(view_depth / near, 1.0)) / log(LAST_SLICE_NEARS) * f32(CLUSTERS.z);
    return min(u32(slice), CLUSTERS.z - 1u);
}

// The texel that holds a word of a cluster's lights.
fn cluster_texel(cluster: vec3u, word: u32, light_count: u32) -> vec2u {
    let words = (light_count + 31u) / 32u;
    return vec2u(cluster.y * CLUSTERS.x + cluster.x, cluster.z * words + word);
}
