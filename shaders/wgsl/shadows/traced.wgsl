// How much of a light is seen, by rays.
#define_import_path shadowgraph::shadows::traced
#import shadowgraph::view::{view, lights, LIGHT_DIRECTIONAL}
#import shadowgraph::noise::pixel_noise
#import shadowgraph::rays::{ray_passed, ray_origin, RAY_FAR, RAY_WAY_TO_LIGHT}

struct Traced {
    // The largest coordinate of the rays' scene.
    max_coordinate: f32,
    // How many there are; one goes to the light's middle, several over its disc.
    rays: u32,
    // Of directional lights: the tangent of half the angle they take up in the sky.
    sun_radius: f32,
    // Of others, metres.
    punctual_radius: f32,
    // For each light its layer of the screen mask, TRACED_UNMASKED, or TRACED_LIT.
    layers: array<u32>,
}

// Of lights that have rays but no layer: those beyond the most important ones.
const TRACED_UNMASKED: u32 = 0xfffffffeu;
// Of lights that cast no shadows.
const TRACED_LIT: u32 = 0xffffffffu;

@group(1) @binding(5) var<storage, read> traced: Traced;

const GOLDEN_ANGLE: f32 = 2.39996323;
const TURN: f32 = 6.28318531;

// Two directions across one of unit length (Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
fn across(direction: vec3f) -> mat2x3f {
    let side = select(-1.0, 1.0, direction.z >= 0.0);
    let a = -1.0 / (side + direction.z);
    let b = direction.x * direction.y * a;
    return mat2x3f(
        vec3f(1.0 + side * direction.x * direction.x * a, side * b, -side * direction.x),
        vec3f(b, side + direction.y * direction.y * a, -direction.y),
    );
}

// The part of the light that a surface sees: none of it, if it faces away from its middle. Rays are turned from pixel to pixel.
fn traced_visibility(light: u32, position: vec3f, geometric_normal: vec3f, pixel: vec2f) -> vec3f {
    let origin = ray_origin(position, geometric_normal, distance(position, view.position), traced.max_coordinate);
    let is_sun = lights[light].kind == LIGHT_DIRECTIONAL;
    let to_middle = select(lights[light].position - origin, -lights[light].direction, is_sun);
    let distance = length(to_middle);
    if distance == 0.0 || dot(geometric_normal, to_middle) <= 0.0 {
        return vec3f(0.0);
    }
    let disc = across(to_middle / distance);
    let radius = select(traced.punctual_radius, traced.sun_radius, is_sun);
    let turn = TURN * pixel_noise(pixel);
    var seen = vec3f(0.0);
    for (var i = 0u; i < traced.rays; i++) {
        var way = to_middle;
        if traced.rays > 1u {
            let angle = f32(i) * GOLDEN_ANGLE + turn;
            let at = sqrt((f32(i) + 0.5) / f32(traced.rays)) * vec2f(cos(angle), sin(angle));
            way += radius * (disc * at);
        }
        let length = length(way);
        let end = select(length * RAY_WAY_TO_LIGHT, RAY_FAR, is_sun);
        if dot(geometric_normal, way) > 0.0 {
            seen += ray_passed(origin, way / length, 0.0, end);
        }
    }
    return seen / f32(traced.rays);
}
