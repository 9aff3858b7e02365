// Writes the screen mask of the technique `raytraced`: the visibility of each light at each pixel.
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::layers::{MaskLayers, COLORED, with_visibility}
#import shadowgraph::shadows::traced::traced_visibility

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var mask: texture_storage_2d_array<rgba8unorm, write>;
@group(2) @binding(2) var<uniform> layers: MaskLayers;

@compute @workgroup_size(8, 8)
fn cs_raytrace(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = textureLoad(surfaces, id.xy, 0);
    let normal = unpack_normal(surface.w);
    var texel = vec4f(1.0);
    if any(normal != vec3f(0.0)) {
        let lights = layers.lights[id.z];
        for (var channel = 0u; channel < 4u && lights[channel] < COLORED; channel++) {
            let visibility = traced_visibility(lights[channel], surface.xyz, normal, vec2f(id.xy) + 0.5);
            texel = with_visibility(texel, lights, channel, visibility);
        }
    }
    textureStore(mask, id.xy, id.z, texel);
}
