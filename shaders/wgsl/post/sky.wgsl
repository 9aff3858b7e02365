// A simple sky where nothing is drawn: the ambient light, and the discs of directional lights.
#import shadowgraph::view::{view, lights, LIGHT_DIRECTIONAL}

struct Settings {
    // Radius of the discs, radians.
    disc_rad: f32,
    // How much brighter the horizon is than the zenith.
    haze: f32,
}

@group(0) @binding(2) var<uniform> settings: Settings;

@fragment
fn fs_sky(@location(0) uv: vec2f) -> @location(0) vec4f {
    let ndc = uv * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let near = view.world_from_clip * vec4f(ndc, 1.0, 1.0);
    let far = view.world_from_clip * vec4f(ndc, 0.5, 1.0);
    let direction = normalize(far.xyz / far.w - near.xyz / near.w);
    let above = smoothstep(-0.02, 0.02, direction.y);
    let horizon = exp(-8.0 * abs(direction.y)) * settings.haze;
    var color = mix(view.ambient_ground, view.ambient_sky, above) * (1.0 + horizon);
    for (var i = 0u; i < view.light_count; i++) {
        let light = lights[i];
        if light.kind != LIGHT_DIRECTIONAL {
            break;
        }
        let angle_rad = acos(clamp(dot(direction, -light.direction), -1.0, 1.0));
        let disc = 1.0 - smoothstep(settings.disc_rad * 0.95, settings.disc_rad * 1.05, angle_rad);
        let halo = 0.02 * exp(-angle_rad * 18.0) + 0.002 * exp(-angle_rad * 3.0);
        color += light.color * (disc * 4.0 + halo) * above;
    }
    return vec4f(min(color * view.exposure, vec3f(60000.0)), 1.0);
}
