// Collects shadows: asks the technique for each light and each surface that the picture shows, and writes a screen mask.
#import shadowgraph::view::{view, view_depth_of}
#import shadowgraph::receiver::Receiver
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::layers::MaskLayers
#import shadowgraph::technique::shadow_visibility

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var mask: texture_storage_2d_array<rgba8unorm, write>;
@group(2) @binding(2) var<uniform> layers: MaskLayers;

// From a point to where the next pixel right (axis 0) or up (1) meets the plane of its surface.
fn to_neighbour(position: vec3f, normal: vec3f, view_depth: f32, axis: i32) -> vec3f {
    let m = view.view_from_world;
    let across = vec3f(m[0][axis], m[1][axis], m[2][axis]);
    // That row of the projection: how many halves of the picture one unit is, at a depth of one.
    let c = view.clip_from_world;
    let scale = length(vec3f(c[0][axis], c[1][axis], c[2][axis]));
    let step = across * 2.0 / (view.size_px[axis] * scale);
    if view.orthographic == 1u {
        let forward = -vec3f(m[0].z, m[1].z, m[2].z);
        return step - forward * (dot(normal, step) / away_from_zero(dot(normal, forward)));
    }
    let way = position - view.position;
    let other = way + step * view_depth;
    return other * (dot(normal, way) / away_from_zero(dot(normal, other))) - way;
}

// Surfaces that are seen edge-on stretch over many pixels, but not without end.
fn away_from_zero(x: f32) -> f32 {
    return select(min(x, -1e-6), max(x, 1e-6), x >= 0.0);
}

@compute @workgroup_size(8, 8)
fn cs_collect(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = textureLoad(surfaces, id.xy, 0);
    let normal = unpack_normal(surface.w);
    var visibility = vec3f(1.0);
    if any(normal != vec3f(0.0)) {
        let pixel = vec2f(id.xy) + 0.5;
        let depth = view_depth_of(surface.xyz);
        let right = to_neighbour(surface.xyz, normal, depth, 0);
        let down = -to_neighbour(surface.xyz, normal, depth, 1);
        let receiver = Receiver(surface.xyz, depth, normal, 0u, normal, pixel, right, down);
        visibility = shadow_visibility(layers.light[id.z / 4u][id.z % 4u], receiver);
    }
    textureStore(mask, id.xy, id.z, vec4f(visibility, 1.0));
}
