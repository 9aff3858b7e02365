// A light.
#define_import_path shadowgraph::light

const LIGHT_DIRECTIONAL: u32 = 0u;
const LIGHT_SPOT: u32 = 1u;
const LIGHT_POINT: u32 = 2u;

// 64 bytes, the last 12 of them padding. Positions are metres relative to the frame's origin.
struct Light {
    position: vec3f,
    kind: u32,
    // The direction in which the light travels, unit length.
    direction: vec3f,
    // Metres; 0: unlimited.
    range: f32,
    // Linear colour times lux (directional) or candela (spot, point).
    color: vec3f,
    // Spot cone: saturate(cos(angle) * spot_scale + spot_offset) squared.
    spot_scale: f32,
    spot_offset: f32,
}
