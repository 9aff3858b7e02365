// The visibility of lights by rays.
#define_import_path shadowgraph::shadows::traced
#import shadowgraph::view::view
#import shadowgraph::light::LIGHT_DIRECTIONAL
#import shadowgraph::lights::light_at
#import shadowgraph::frame_noise::frame_noise
#import shadowgraph::rays::{ray_passed, ray_origin, RAY_FAR, RAY_LIGHT_FRACTION}
#import shadowgraph::shadows::raytraced_settings::RaytracedSettings

struct Traced {
    settings: RaytracedSettings,
    // The tangent of settings.sun_radius_rad.
    sun_tangent: f32,
    // The largest coordinate of the rays' scene.
    max_coordinate: f32,
    // The place of each light in the screen mask, TRACED_UNMASKED, or TRACED_LIT.
    slots: array<u32>,
}

// For lights with rays but without a place: those beyond the first ones.
const TRACED_UNMASKED: u32 = 0xfffffffeu;
// For lights that cast no shadows.
const TRACED_LIT: u32 = 0xffffffffu;

@group(1) @binding(5) var<storage, read> traced: Traced;

const GOLDEN_ANGLE: f32 = 2.39996323;
const TAU: f32 = 6.28318531;

// Two directions perpendicular to one of unit length (Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
fn perpendicular(direction: vec3f) -> mat2x3f {
    let side = select(-1.0, 1.0, direction.z >= 0.0);
    let a = -1.0 / (side + direction.z);
    let b = direction.x * direction.y * a;
    return mat2x3f(
        vec3f(1.0 + side * direction.x * direction.x * a, side * b, -side * direction.x),
        vec3f(b, side + direction.y * direction.y * a, -direction.y),
    );
}

// The visible fraction of the light from a surface: 0 if it faces away from the light's centre. Rays are rotated per pixel.
fn traced_visibility(light: u32, position: vec3f, geometric_normal: vec3f, pixel: vec2f) -> vec3f {
    let origin = ray_origin(position, geometric_normal, distance(position, view.position), traced.max_coordinate);
    let source = light_at(light);
    let is_sun = source.kind == LIGHT_DIRECTIONAL;
    let to_center = select(source.position - origin, -source.direction, is_sun);
    let distance = length(to_center);
    if distance == 0.0 || dot(geometric_normal, to_center) <= 0.0 {
        return vec3f(0.0);
    }
    let disc = perpendicular(to_center / distance);
    let radius = select(traced.settings.light_radius_m, traced.sun_tangent, is_sun);
    let rotation = TAU * frame_noise(pixel);
    var visibility = vec3f(0.0);
    for (var i = 0u; i < traced.settings.rays; i++) {
        var direction_to_sample = to_center;
        if traced.settings.rays > 1u {
            let angle = f32(i) * GOLDEN_ANGLE + rotation;
            let at = sqrt((f32(i) + 0.5) / f32(traced.settings.rays)) * vec2f(cos(angle), sin(angle));
            direction_to_sample += radius * (disc * at);
        }
        let length = length(direction_to_sample);
        let end = select(length * RAY_LIGHT_FRACTION, RAY_FAR, is_sun);
        if dot(geometric_normal, direction_to_sample) > 0.0 {
            visibility += ray_passed(origin, direction_to_sample / length, 0.0, end, traced.max_coordinate);
        }
    }
    return visibility / f32(traced.settings.rays);
}
