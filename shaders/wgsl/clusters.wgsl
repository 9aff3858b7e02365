// Finds the lights that reach each cluster, with one thread per cluster and 32 lights.
#import shadowgraph::view::view
#import shadowgraph::light::{Light, LIGHT_DIRECTIONAL}
#import shadowgraph::lights::light_at
#import shadowgraph::cluster_grid::{CLUSTERS, slice_begin, cluster_texel}

@group(0) @binding(2) var cluster_lights: texture_storage_2d<r32uint, write>;

struct Box {
    low: vec3f,
    high: vec3f,
}

// The size of one unit at depth 1, in halves of the image.
fn projection_scale(axis: i32) -> f32 {
    let c = view.clip_from_world;
    return length(vec3f(c[0][axis], c[1][axis], c[2][axis]));
}

// The box around a cluster in view space, the camera looking along -Z.
fn box_of(cluster: vec3u) -> Box {
    let scale = vec2f(projection_scale(0), projection_scale(1));
    let size = 2.0 / vec2f(CLUSTERS.xy);
    let left = -1.0 + f32(cluster.x) * size.x;
    let top = 1.0 - f32(cluster.y) * size.y;
    // A little wider, for pixels whose centre lies outside.
    let first = vec2f(left - 1e-3, top - size.y - 1e-3) / scale;
    let last = vec2f(left + size.x + 1e-3, top + 1e-3) / scale;
    let begin = select(slice_begin(cluster.z, view.near) * 0.999, 0.0, cluster.z == 0u);
    let end = select(slice_begin(cluster.z + 1u, view.near) * 1.001, 1e30, cluster.z + 1u == CLUSTERS.z);
    if view.orthographic == 1u {
        return Box(vec3f(first, -end), vec3f(last, -begin));
    }
    let low = min(first * begin, first * end);
    let high = max(last * begin, last * end);
    return Box(vec3f(low, -end), vec3f(high, -begin));
}

fn reaches(light: Light, box: Box) -> bool {
    if light.kind == LIGHT_DIRECTIONAL || light.range == 0.0 {
        return true;
    }
    let middle = (view.view_from_world * vec4f(light.position, 1.0)).xyz;
    let away = middle - clamp(middle, box.low, box.high);
    return dot(away, away) < light.range * light.range;
}

@compute @workgroup_size(64)
fn cs_clusters(@builtin(global_invocation_id) id: vec3u) {
    let words = (view.light_count + 31u) / 32u;
    let count = CLUSTERS.x * CLUSTERS.y * CLUSTERS.z;
    if words == 0u || id.x >= count * words {
        return;
    }
    let index = id.x / words;
    let word = id.x % words;
    let cluster = vec3u(index % CLUSTERS.x, index / CLUSTERS.x % CLUSTERS.y, index / (CLUSTERS.x * CLUSTERS.y));
    let box = box_of(cluster);
    var mask = 0u;
    for (var bit = 0u; bit < 32u; bit++) {
        let light = word * 32u + bit;
        if light < view.light_count && reaches(light_at(light), box) {
            mask |= 1u << bit;
        }
    }
    textureStore(cluster_lights, cluster_texel(cluster, word, view.light_count), vec4u(mask));
}
