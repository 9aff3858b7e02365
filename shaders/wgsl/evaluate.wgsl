// Evaluates the technique for each light at each pixel, into a screen mask.
#import shadowgraph::view::{view_depth_of, to_neighbour}
#import shadowgraph::frame_noise::noise_flags
#import shadowgraph::receiver::Receiver
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::layers::{MaskLayers, COLORED, with_visibility}
#import shadowgraph::technique::shadow_visibility

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var mask: texture_storage_2d_array<rgba8unorm, write>;
@group(2) @binding(2) var<uniform> layers: MaskLayers;

@compute @workgroup_size(8, 8)
fn cs_evaluate(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(surfaces)) {
        return;
    }
    let surface = textureLoad(surfaces, id.xy, 0);
    let normal = unpack_normal(surface.w);
    var texel = vec4f(1.0);
    if any(normal != vec3f(0.0)) {
        let pixel = vec2f(id.xy) + 0.5;
        let depth = view_depth_of(surface.xyz);
        let right = to_neighbour(surface.xyz, normal, depth, 0);
        let down = -to_neighbour(surface.xyz, normal, depth, 1);
        let receiver = Receiver(surface.xyz, depth, normal, noise_flags(pixel), normal, pixel, right, down);
        let lights = layers.lights[id.z];
        for (var channel = 0u; channel < 4u && lights[channel] < COLORED; channel++) {
            texel = with_visibility(texel, lights, channel, shadow_visibility(lights[channel], receiver));
        }
    }
    textureStore(mask, id.xy, id.z, texel);
}
