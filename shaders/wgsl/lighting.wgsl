// How light meets a surface: glTF's metallic-roughness model and KHR_lights_punctual.
#define_import_path shadowgraph::lighting
#import shadowgraph::light::{Light, LIGHT_DIRECTIONAL, LIGHT_SPOT}

const PI: f32 = 3.14159265358979;
// Below this the highlight of a strong light exceeds a half float target.
const MIN_ROUGHNESS: f32 = 0.089;
// Reflectance of glass and stone at normal incidence.
const DIELECTRIC_REFLECTANCE: f32 = 0.04;
// The least distance of a light, in metres, since the inverse square is unbounded.
const MIN_LIGHT_DISTANCE: f32 = 0.01;

struct Surface {
    // Reflected diffusely: black for metals.
    diffuse_color: vec3f,
    // Perceptual, MIN_ROUGHNESS to 1.
    roughness: f32,
    // Reflectance at normal incidence.
    specular_color: vec3f,
    occlusion: f32,
    normal: vec3f,
    n_dot_v: f32,
    to_camera: vec3f,
}

struct ArrivingLight {
    // Unit length.
    to_light: vec3f,
    // 0 outside the cone and beyond the range.
    attenuation: f32,
}

fn surface_of(
    base_color: vec3f, metallic_roughness: vec2f, occlusion: f32, normal: vec3f, to_camera: vec3f,
) -> Surface {
    let metallic = metallic_roughness.x;
    return Surface(
        base_color * (1.0 - metallic),
        clamp(metallic_roughness.y, MIN_ROUGHNESS, 1.0),
        mix(vec3f(DIELECTRIC_REFLECTANCE), base_color, metallic),
        occlusion,
        normal,
        // Interpolated normals can point away from the camera.
        clamp(dot(normal, to_camera), 1e-4, 1.0),
        to_camera,
    );
}

// The window that takes the inverse square to 0 at the range, as KHR_lights_punctual recommends.
fn range_window(distance: f32, range: f32) -> f32 {
    if range == 0.0 {
        return 1.0;
    }
    let relative = distance / range;
    return saturate(1.0 - relative * relative * relative * relative);
}

fn arriving_light(light: Light, position: vec3f) -> ArrivingLight {
    if light.kind == LIGHT_DIRECTIONAL {
        return ArrivingLight(-light.direction, 1.0);
    }
    let offset = light.position - position;
    let distance = max(length(offset), MIN_LIGHT_DISTANCE);
    let to_light = offset / distance;
    var attenuation = range_window(distance, light.range) / (distance * distance);
    if light.kind == LIGHT_SPOT {
        let cone = saturate(dot(-to_light, light.direction) * light.spot_scale + light.spot_offset);
        attenuation *= cone * cone;
    }
    return ArrivingLight(to_light, attenuation);
}

// Trowbridge-Reitz (GGX).
fn distribution(alpha: f32, n_dot_h: f32) -> f32 {
    let a_squared = alpha * alpha;
    let denominator = (n_dot_h * a_squared - n_dot_h) * n_dot_h + 1.0;
    return a_squared / (PI * denominator * denominator);
}

// Smith's masking and shadowing, height correlated, over 4 (n·l)(n·v).
fn visibility_term(alpha: f32, n_dot_l: f32, n_dot_v: f32) -> f32 {
    let a_squared = alpha * alpha;
    let masked = n_dot_l * sqrt((n_dot_v - n_dot_v * a_squared) * n_dot_v + a_squared);
    let shadowed = n_dot_v * sqrt((n_dot_l - n_dot_l * a_squared) * n_dot_l + a_squared);
    return 0.5 / max(masked + shadowed, 1e-6);
}

// Schlick.
fn fresnel(specular_color: vec3f, v_dot_h: f32) -> vec3f {
    return specular_color + (1.0 - specular_color) * pow(1.0 - v_dot_h, 5.0);
}

// Radiance towards the camera per unit of illuminance perpendicular to `to_light`.
fn reflected(surface: Surface, to_light: vec3f, n_dot_l: f32) -> vec3f {
    // If the light is directly opposite the camera, the two directions cancel out.
    let sum = surface.to_camera + to_light;
    let half_way = sum * inverseSqrt(max(dot(sum, sum), 1e-8));
    let n_dot_h = saturate(dot(surface.normal, half_way));
    let v_dot_h = saturate(dot(surface.to_camera, half_way));
    let alpha = surface.roughness * surface.roughness;
    let f = fresnel(surface.specular_color, v_dot_h);
    let specular = f * distribution(alpha, n_dot_h) * visibility_term(alpha, n_dot_l, surface.n_dot_v);
    let diffuse = (1.0 - f) * surface.diffuse_color / PI;
    return (diffuse + specular) * n_dot_l;
}

// The fraction of a uniform environment that a surface reflects specularly: Karis' polynomial, "Physically Based
// Shading on Mobile" (2014), after Lazarov's "Getting More Physical in Call of Duty: Black Ops II" (2013).
fn environment_reflectance(specular_color: vec3f, roughness: f32, n_dot_v: f32) -> vec3f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
    let scale_bias = vec2f(-1.04, 1.04) * a + r.zw;
    return specular_color * scale_bias.x + scale_bias.y;
}

// Ambient light: a sky above and a ground below.
fn ambient(surface: Surface, sky: vec3f, ground: vec3f) -> vec3f {
    let diffuse_ambient = mix(ground, sky, surface.normal.y * 0.5 + 0.5);
    let reflected_direction = reflect(-surface.to_camera, surface.normal);
    // Rougher surfaces reflect a wider part of the environment.
    let specular_ambient = mix(
        mix(ground, sky, smoothstep(-0.3, 0.3, reflected_direction.y)), diffuse_ambient, surface.roughness);
    let specular = environment_reflectance(surface.specular_color, surface.roughness, surface.n_dot_v);
    return (surface.diffuse_color * diffuse_ambient + specular * specular_ambient) * surface.occlusion;
}
