// The technique `screen`: visible surfaces read the screen mask that evaluate.wgsl has written; everything else evaluates the
// inner technique.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT, RECEIVER_OFF_SCREEN, RECEIVER_COARSER}
#import shadowgraph::shadows::layers::{MaskLayers, mask_slot, slot_layer, slot_visibility, UNMASKED}
#import shadowgraph::inner

@group(1) @binding(MASK) var shadow_mask: texture_2d_array<f32>;
@group(1) @binding(LAYERS) var<uniform> mask_layers: MaskLayers;

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    let off_mask = RECEIVER_TRANSPARENT | RECEIVER_OFF_SCREEN | RECEIVER_COARSER;
    if (receiver.flags & off_mask) == 0u {
        let slot = mask_slot(mask_layers, light);
        if slot != UNMASKED {
            return slot_visibility(textureLoad(shadow_mask, vec2u(receiver.pixel), slot_layer(slot), 0), slot);
        }
    }
    return inner::shadow_visibility(light, receiver);
}

fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    return inner::shadow_debug_color(light, receiver);
}
