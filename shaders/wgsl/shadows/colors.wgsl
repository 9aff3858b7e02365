// The colours of cascades in debug images, display-encoded (sRGB).
#define_import_path shadowgraph::shadows::colors

// That of a tile of the atlas is the last one.
fn cascade_tint(cascade: u32) -> vec3f {
    switch cascade {
        case 0u: { return vec3f(1.0, 0.35, 0.3); }
        case 1u: { return vec3f(0.4, 0.9, 0.35); }
        case 2u: { return vec3f(0.35, 0.55, 1.0); }
        case 3u: { return vec3f(1.0, 0.85, 0.3); }
        case 4u: { return vec3f(0.3, 0.9, 0.9); }
        case 5u: { return vec3f(1.0, 0.6, 0.25); }
        case 6u: { return vec3f(0.6, 0.6, 0.6); }
        case 7u: { return vec3f(1.0, 0.5, 0.8); }
        default: { return vec3f(0.85, 0.5, 0.95); }
    }
}

fn to_linear(encoded: vec3f) -> vec3f {
    return select(pow((encoded + 0.055) / 1.055, vec3f(2.4)), encoded / 12.92, encoded <= vec3f(0.04045));
}
