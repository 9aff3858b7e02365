// The layers of a screen mask and their lights.
//
// A layer holds the visibility of one light in red, green and blue, or that of up to four lights, one in each channel.
#define_import_path shadowgraph::shadows::layers

// 272 bytes.
struct MaskLayers {
    count: u32,
    // The light of each channel of each layer, or NO_LIGHT; COLORED in green where the layer has one light.
    lights: array<vec4u, 16>,
}

const NO_LIGHT: u32 = 0xffffffffu;
const COLORED: u32 = 0xfffffffeu;

// The place of a light in the mask is SLOTS_PER_LAYER times its layer, plus its channel, or COLORED_SLOT where it is alone.
const SLOTS_PER_LAYER: u32 = 8u;
const COLORED_SLOT: u32 = 4u;
// For lights without a place.
const UNMASKED: u32 = 0xffffffffu;

fn has_one_light(lights: vec4u) -> bool {
    return lights.y == COLORED;
}

fn mask_slot(layers: MaskLayers, light: u32) -> u32 {
    for (var layer = 0u; layer < layers.count; layer++) {
        let lights = layers.lights[layer];
        let is_here = lights == vec4u(light);
        if any(is_here) {
            let channel = dot(vec4u(0u, 1u, 2u, 3u), vec4u(is_here));
            return layer * SLOTS_PER_LAYER + select(channel, COLORED_SLOT, has_one_light(lights));
        }
    }
    return UNMASKED;
}

fn slot_layer(slot: u32) -> u32 {
    return slot / SLOTS_PER_LAYER;
}

// The visibility of the light at a place, from a texel of its layer.
fn slot_visibility(texel: vec4f, slot: u32) -> vec3f {
    return select(vec3f(texel[slot & 3u]), texel.rgb, (slot & COLORED_SLOT) != 0u);
}

// The visibility of the light of a channel; that of a layer with one light is in channel 0.
fn channel_visibility(texel: vec4f, lights: vec4u, channel: u32) -> vec3f {
    return select(vec3f(texel[channel]), texel.rgb, has_one_light(lights));
}

// A texel with another visibility of the light of a channel.
fn with_visibility(texel: vec4f, lights: vec4u, channel: u32, visibility: vec3f) -> vec4f {
    let packed = select(texel, vec4f(visibility.g), vec4u(0u, 1u, 2u, 3u) == vec4u(channel));
    return select(packed, vec4f(visibility, 1.0), has_one_light(lights));
}
