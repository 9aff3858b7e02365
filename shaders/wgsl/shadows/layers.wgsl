// The layers of a screen mask and their lights.
#define_import_path shadowgraph::shadows::layers

// 80 bytes.
struct MaskLayers {
    count: u32,
    // The light of each layer.
    light: array<vec4u, 4>,
}

const UNMASKED: u32 = 0xffffffffu;

fn mask_layer(layers: MaskLayers, light: u32) -> u32 {
    for (var layer = 0u; layer < layers.count; layer++) {
        if layers.light[layer / 4u][layer % 4u] == light {
            return layer;
        }
    }
    return UNMASKED;
}
