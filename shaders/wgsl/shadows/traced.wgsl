// Whether a light's centre is seen, by a ray.
#define_import_path shadowgraph::shadows::traced
#import shadowgraph::view::{view, lights, LIGHT_DIRECTIONAL}
#import shadowgraph::rays::{ray_blocked, ray_origin, RAY_FAR, RAY_WAY_TO_LIGHT}

struct Traced {
    // The largest coordinate of the rays' scene.
    reach: f32,
    // For each light its layer of the screen mask, TRACED_UNMASKED, or TRACED_LIT.
    layers: array<u32>,
}

// Of lights that have rays but no layer: those beyond the most important ones.
const TRACED_UNMASKED: u32 = 0xfffffffeu;
// Of lights that cast no shadows.
const TRACED_LIT: u32 = 0xffffffffu;

@group(1) @binding(5) var<storage, read> traced: Traced;

// 1: the surface sees the light's centre, 0: something is between, or it faces away.
fn traced_visibility(light: u32, position: vec3f, geometric_normal: vec3f) -> f32 {
    let origin = ray_origin(position, geometric_normal, distance(position, view.position), traced.reach);
    var to_light = -lights[light].direction;
    var end = RAY_FAR;
    if lights[light].kind != LIGHT_DIRECTIONAL {
        let offset = lights[light].position - origin;
        let distance = length(offset);
        if distance == 0.0 {
            return 0.0;
        }
        to_light = offset / distance;
        end = distance * RAY_WAY_TO_LIGHT;
    }
    if dot(geometric_normal, to_light) <= 0.0 || ray_blocked(origin, to_light, 0.0, end) {
        return 0.0;
    }
    return 1.0;
}
