// The technique `raytraced`: shadows by rays through the scene's triangles. Visible surfaces read the screen mask that
// raytrace.wgsl has written; everything else is traced in place.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT, RECEIVER_OFF_SCREEN}
#import shadowgraph::shadows::layers::{slot_layer, slot_visibility}
#import shadowgraph::shadows::traced::{traced, traced_visibility, TRACED_LIT, TRACED_UNMASKED}

@group(1) @binding(6) var shadow_mask: texture_2d_array<f32>;

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    if light >= arrayLength(&traced.slots) || traced.slots[light] == TRACED_LIT {
        return vec3f(1.0);
    }
    let slot = traced.slots[light];
    let on_mask = (receiver.flags & (RECEIVER_TRANSPARENT | RECEIVER_OFF_SCREEN)) == 0u;
    if on_mask && slot != TRACED_UNMASKED {
        return slot_visibility(textureLoad(shadow_mask, vec2u(receiver.pixel), slot_layer(slot), 0), slot);
    }
    return traced_visibility(light, receiver.position, receiver.geometric_normal, receiver.pixel);
}

fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    return vec3f(1.0);
}
