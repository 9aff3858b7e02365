// The technique `screen` where everything lit is covered by the screen mask: it reads one texel, independent of the inner
// technique.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::layers::{MaskLayers, mask_slot, slot_layer, slot_visibility, UNMASKED}

@group(1) @binding(MASK) var shadow_mask: texture_2d_array<f32>;
@group(1) @binding(LAYERS) var<uniform> mask_layers: MaskLayers;

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    let slot = mask_slot(mask_layers, light);
    if slot == UNMASKED {
        return vec3f(1.0);
    }
    return slot_visibility(textureLoad(shadow_mask, vec2u(receiver.pixel), slot_layer(slot), 0), slot);
}

fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    return vec3f(1.0);
}
