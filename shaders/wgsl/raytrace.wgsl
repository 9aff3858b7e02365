// Writes the screen mask of the technique `raytraced`: the visibility of each light at each pixel.
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::traced::{traced, traced_visibility}

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var mask: texture_storage_2d_array<rgba8unorm, write>;

@compute @workgroup_size(8, 8)
fn cs_raytrace(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = textureLoad(surfaces, id.xy, 0);
    let normal = unpack_normal(surface.w);
    var visibility = vec3f(1.0);
    if any(normal != vec3f(0.0)) {
        visibility = traced_visibility(light_of_layer(id.z), surface.xyz, normal, vec2f(id.xy) + 0.5);
    }
    textureStore(mask, id.xy, id.z, vec4f(visibility, 1.0));
}

// The light of a layer.
fn light_of_layer(layer: u32) -> u32 {
    for (var light = 0u; light < arrayLength(&traced.layers); light++) {
        if traced.layers[light] == layer {
            return light;
        }
    }
    return 0u;
}
