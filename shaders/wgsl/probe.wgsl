// Evaluates the technique at stored points, independent of the camera, for measurements.
#import shadowgraph::view::{view, view_depth_of}
#import shadowgraph::receiver::{Receiver, RECEIVER_OFF_SCREEN}
#import shadowgraph::surface::unpack_normal
#import shadowgraph::technique::shadow_visibility

struct Query {
    light: u32,
    // RECEIVER_* bits in addition to RECEIVER_OFF_SCREEN.
    flags: u32,
    // The size of a pixel 1 m away.
    pixel_world: f32,
}

@group(2) @binding(0) var<uniform> query: Query;
// A surface texture.
@group(2) @binding(1) var points: texture_2d<f32>;
@group(2) @binding(2) var results: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn cs_probe(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(points)) {
        return;
    }
    let point = textureLoad(points, id.xy, 0);
    let normal = unpack_normal(point.w);
    var result = 0.0;
    if any(normal != vec3f(0.0)) {
        let visibility = shadow_visibility(query.light, receiver(point.xyz, normal, id.xy));
        result = saturate(dot(visibility, vec3f(1.0 / 3.0)));
    }
    textureStore(results, id.xy, vec4f(result));
}

// The receiver of a surface as if it were seen by a pixel.
fn receiver(position: vec3f, normal: vec3f, pixel: vec2u) -> Receiver {
    let across = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(normal.x) > 0.5);
    let right = normalize(cross(across, normal));
    let side = query.pixel_world * view_depth_of(position);
    return Receiver(
        position,
        view_depth_of(position),
        normal,
        RECEIVER_OFF_SCREEN | query.flags,
        normal,
        vec2f(pixel) + 0.5,
        right * side,
        cross(normal, right) * side,
    );
}
