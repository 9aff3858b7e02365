// The light of a sky and of the ground below it.
#define_import_path shadowgraph::environment
#import shadowgraph::view::{view, ViewRay, view_depth_of, view_ray, to_neighbour}
#import shadowgraph::lights::{light_at, light_count}
#import shadowgraph::lighting::{Surface, arriving_light, environment_reflectance}
#import shadowgraph::receiver::{Receiver, RECEIVER_OFF_SCREEN}
#import shadowgraph::screen_occlusion::screen_occlusion
#import shadowgraph::light_list::next_light
#import shadowgraph::frame_noise::noise_flags
#import shadowgraph::technique::shadow_visibility

// 368 bytes. Radiance is before exposure.
struct Sky {
    // The coefficients A to I of the distribution of radiance in red, green and blue (Hosek and Wilkie, "An Analytic Model for
    // Full Spectral Sky-Dome Radiance", 2012).
    distribution: array<vec4f, 9>,
    // Irradiance over π, in spherical harmonics (Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance
    // Environment Maps", 2001).
    irradiance: array<vec4f, 9>,
    // The factor of the distribution.
    radiance: vec3f,
    // Cosine of the angular radius of the sun's disc.
    cos_disc: f32,
    to_sun: vec3f,
    // BACKDROP_*
    backdrop: u32,
    // Radiance of the sun's disc.
    disc: vec3f,
    // Height of the plane, metres relative to the frame's origin.
    ground_height: f32,
    // Radiance of the ground in full light.
    ground: vec3f,
    ground_albedo: vec3f,
}

// What is drawn where there is no geometry: the sky and the ground, or only the shadows on the ground, as alpha.
const BACKDROP_SKY: u32 = 0u;

const PI: f32 = 3.14159265358979;
const MAX_RADIANCE: f32 = 60000.0;
// What ambient occlusion darkens of a plane with nothing on it, at most: it has 8 bits, and depth far away few digits.
const UNOCCLUDED: f32 = 0.04;
// How quickly the ground turns into the sky at the horizon.
const HORIZON_HAZE: f32 = 7.0;

const HAS_BACKGROUND: bool = true;
// Whether there is a plane that receives shadows.
const HAS_GROUND: bool = true;

@group(0) @binding(ENVIRONMENT) var<uniform> sky: Sky;

// The sky in all directions.
struct Dome {
    to_sun: vec3f,
    radiance: vec3f,
    distribution: array<vec3f, 9>,
    // Irradiance of the ground over π, without lights.
    ground_irradiance: vec3f,
}

fn sky_dome() -> Dome {
    let d = &sky.distribution;
    let distribution = array(
        (*d)[0].xyz, (*d)[1].xyz, (*d)[2].xyz, (*d)[3].xyz, (*d)[4].xyz, (*d)[5].xyz, (*d)[6].xyz, (*d)[7].xyz, (*d)[8].xyz,
    );
    return Dome(sky.to_sun, sky.radiance, distribution, irradiance(vec3f(0.0, 1.0, 0.0)));
}

// The radiance of the sky without the sun's disc, for a direction with y not below 0.
fn dome_radiance(dome: Dome, direction: vec3f) -> vec3f {
    let cos_theta = max(direction.y, 0.0);
    let cos_gamma = clamp(dot(direction, dome.to_sun), -1.0, 1.0);
    let gamma = acos(cos_gamma);
    let d = dome.distribution;
    let h = d[8];
    let mie = (1.0 + cos_gamma * cos_gamma) / pow(max(1.0 + h * h - 2.0 * h * cos_gamma, vec3f(1e-4)), vec3f(1.5));
    let by_height = 1.0 + d[0] * exp(d[1] / (cos_theta + 0.01));
    let by_angle = d[2] + d[3] * exp(d[4] * gamma) + d[5] * (cos_gamma * cos_gamma) + d[6] * mie + d[7] * sqrt(cos_theta);
    return max(by_height * by_angle * dome.radiance, vec3f(0.0));
}

// The share of the ground in a direction below the horizon; the rest is the sky at the horizon.
fn ground_share(y: f32) -> f32 {
    return 1.0 - exp(HORIZON_HAZE * min(y, 0.0));
}

fn at_horizon(direction: vec3f) -> vec3f {
    return normalize(vec3f(direction.x, 0.0, direction.z) + vec3f(1e-6, 0.0, 0.0));
}

// Irradiance over π on a surface with this normal.
fn irradiance(n: vec3f) -> vec3f {
    let s = &sky.irradiance;
    let sum = (*s)[0].xyz + (*s)[1].xyz * n.y + (*s)[2].xyz * n.z + (*s)[3].xyz * n.x + (*s)[4].xyz * (n.x * n.y)
        + (*s)[5].xyz * (n.y * n.z) + (*s)[6].xyz * (3.0 * n.z * n.z - 1.0) + (*s)[7].xyz * (n.x * n.z)
        + (*s)[8].xyz * (n.x * n.x - n.y * n.y);
    return max(sum, vec3f(0.0));
}

fn environment_light(surface: Surface) -> vec3f {
    let diffuse_light = irradiance(surface.normal);
    let direction = reflect(-surface.to_camera, surface.normal);
    // Rougher surfaces reflect a wider part of the environment.
    let width = 0.02 + 0.5 * surface.roughness;
    let above = dome_radiance(sky_dome(), normalize(vec3f(direction.x, max(direction.y, 0.0), direction.z) + vec3f(0.0, 1e-6, 0.0)));
    let mirrored = mix(sky.ground, above, smoothstep(-width, width, direction.y));
    let reflected_light = mix(mirrored, irradiance(direction), smoothstep(0.0, 0.7, surface.roughness));
    let specular = environment_reflectance(surface.specular_color, surface.roughness, surface.n_dot_v);
    return (surface.diffuse_color * diffuse_light + specular * reflected_light) * surface.occlusion;
}

// The light that the plane reflects at a point, and what it would reflect without shadows and occlusion.
fn ground_light(position: vec3f, pixel: vec2f, dome: Dome) -> array<vec3f, 2> {
    let up = vec3f(0.0, 1.0, 0.0);
    let depth = view_depth_of(position);
    let receiver = Receiver(
        position,
        depth,
        up,
        RECEIVER_OFF_SCREEN | noise_flags(pixel),
        up,
        pixel,
        to_neighbour(position, up, depth, 0),
        -to_neighbour(position, up, depth, 1),
    );
    let from_sky = dome.ground_irradiance * PI;
    var shadowed = from_sky * screen_occlusion(pixel, false);
    var full = from_sky;
    var i = next_light(0u, pixel, depth);
    loop {
        let light = light_at(i);
        let arriving = arriving_light(light, position);
        if i < light_count() && arriving.to_light.y > 0.0 && arriving.attenuation > 0.0 {
            let illuminance = light.color * (arriving.attenuation * arriving.to_light.y);
            full += illuminance;
            shadowed += illuminance * shadow_visibility(i, receiver);
        }
        i = next_light(i + 1u, pixel, depth);
        if i >= light_count() {
            break;
        }
    }
    return array(shadowed * sky.ground_albedo / PI, full * sky.ground_albedo / PI);
}

fn background_light(pixel: vec2f) -> vec4f {
    return background_along(view_ray(pixel), pixel, sky_dome());
}

// The background of a pixel with this ray, exposure applied.
fn background_along(ray: ViewRay, pixel: vec2f, dome: Dome) -> vec4f {
    let direction = ray.direction;
    let shows_sky = sky.backdrop == BACKDROP_SKY;
    var ground = sky.ground;
    var darkened = 0.0;
    let share = ground_share(direction.y);
    if HAS_GROUND {
        let distance = (sky.ground_height - ray.start.y) / direction.y;
        if direction.y < 0.0 && distance > 0.0 {
            let light = ground_light(ray.start + direction * distance, pixel, dome);
            ground = light[0];
            let luminance = vec3f(0.2126, 0.7152, 0.0722);
            darkened = share * (1.0 - dot(light[0], luminance) / max(dot(light[1], luminance), 1e-9));
        }
    }
    if !shows_sky {
        return vec4f(0.0, 0.0, 0.0, saturate((darkened - UNOCCLUDED) / (1.0 - UNOCCLUDED)));
    }
    var color = dome_radiance(dome, select(at_horizon(direction), direction, direction.y > 0.0));
    if direction.y > 0.0 {
        let disc = smoothstep(sky.cos_disc, mix(sky.cos_disc, 1.0, 0.2), dot(direction, dome.to_sun));
        color += sky.disc * disc;
    } else {
        color = mix(color, ground, share);
    }
    return vec4f(min(color * view.exposure, vec3f(MAX_RADIANCE)), 1.0);
}
