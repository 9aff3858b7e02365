// The technique `screen` where all that is lit is on the screen mask: one texel is read, and nothing is known of how it came
// about.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::layers::{MaskLayers, mask_layer, UNMASKED}

// A layer a light.
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
