// The technique `screen` where everything lit is covered by the screen mask: it reads one texel, independent of the inner
// technique.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::layers::{MaskLayers, mask_layer, UNMASKED}

// One layer per light.
@group(1) @binding(MASK) var shadow_mask: texture_2d_array<f32>;
@group(1) @binding(LAYERS) var<uniform> mask_layers: MaskLayers;

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    let layer = mask_layer(mask_layers, light);
    if layer == UNMASKED {
        return vec3f(1.0);
    }
    return textureLoad(shadow_mask, vec2u(receiver.pixel), layer, 0).rgb;
}

fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    return vec3f(1.0);
}
