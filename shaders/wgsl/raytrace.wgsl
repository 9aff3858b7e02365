// Writes the screen mask of the technique `raytraced`: for each light and pixel how much of the light the surface sees.
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
    var lit = vec3f(1.0);
    if any(normal != vec3f(0.0)) {
        lit = traced_visibility(light_of(id.z), surface.xyz, normal, vec2f(id.xy) + 0.5);
    }
    textureStore(mask, id.xy, id.z, vec4f(lit, 1.0));
}

// The light that has a layer.
fn light_of(layer: u32) -> u32 {
    for (var light = 0u; light < arrayLength(&traced.layers); light++) {
        if traced.layers[light] == layer {
            return light;
        }
    }
    return 0u;
}
