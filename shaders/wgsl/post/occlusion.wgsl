// Ground-truth ambient occlusion: how much of the hemisphere above each pixel is unoccluded, from the horizons in slices of
// the screen (Jimenez et al., "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016).
#import shadowgraph::view::view

struct Settings {
    // Radius within which occluders count, metres; 0: RADIUS_HEIGHTS of the image's height at the pixel's depth.
    radius_m: f32,
    // Exponent: 1 is physical, more is darker.
    power: f32,
    slices: u32,
    steps: u32,
}

// 0 where nothing is.
@group(0) @binding(1) var view_depth_texture: texture_2d<f32>;
@group(0) @binding(2) var<uniform> settings: Settings;

const PI: f32 = 3.14159265358979;
// The largest radius on the screen, pixels.
const MAX_RADIUS_PX: f32 = 96.0;
const RADIUS_HEIGHTS: f32 = 0.1;

fn projection_scale() -> vec2f {
    let c = view.clip_from_world;
    return vec2f(length(vec3f(c[0].x, c[1].x, c[2].x)), length(vec3f(c[0].y, c[1].y, c[2].y)));
}

// In view space, the camera looking along -Z.
fn position_at(texel: vec2i) -> vec3f {
    let size = vec2i(view.size_px);
    let inside = clamp(texel, vec2i(0), size - 1);
    let found = textureLoad(view_depth_texture, inside, 0).r;
    let view_depth = select(1e6, found, found > 0.0);
    let ndc = (vec2f(inside) + 0.5) / view.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let depth_scale = select(view_depth, 1.0, view.orthographic == 1u);
    return vec3f(ndc / projection_scale() * depth_scale, -view_depth);
}

// The slope towards the nearer of both neighbours: the other may be behind an edge.
fn slope(texel: vec2i, along: vec2i, center: vec3f) -> vec3f {
    let next = position_at(texel + along) - center;
    let previous = center - position_at(texel - along);
    // Outside the image the clamped position is the centre's, so the difference is 0.
    let has_next = any(next != vec3f(0.0));
    let has_previous = any(previous != vec3f(0.0));
    return select(previous, next, has_next && (!has_previous || abs(next.z) < abs(previous.z)));
}

@fragment
fn fs_occlusion(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2i(position.xy);
    if textureLoad(view_depth_texture, texel, 0).r == 0.0 {
        return vec4f(1.0);
    }
    let center = position_at(texel);
    let to_camera = select(normalize(-center), vec3f(0.0, 0.0, 1.0), view.orthographic == 1u);
    let normal = normalize(cross(slope(texel, vec2i(1, 0), center), slope(texel, vec2i(0, -1), center)));
    let depth_scale = select(-center.z, 1.0, view.orthographic == 1u);
    let image_height = 2.0 * depth_scale / projection_scale().y;
    let radius_m = select(settings.radius_m, image_height * RADIUS_HEIGHTS, settings.radius_m == 0.0);
    let radius_px = clamp(radius_m * projection_scale().x / depth_scale * view.size_px.x * 0.5, 1.0, MAX_RADIUS_PX);
    // Each block of four by four pixels has all rotations and offsets, which occlusion_blur.wgsl averages.
    let rotation = f32((((texel.x + texel.y) & 3) << 2u) + (texel.x & 3)) / 16.0;
    let step_offset = (f32((texel.y - texel.x) & 3) + 0.5) / 4.0;
    var visibility = 0.0;
    for (var slice = 0u; slice < settings.slices; slice++) {
        let angle = (f32(slice) + rotation) * PI / f32(settings.slices);
        let direction = vec2f(cos(angle), sin(angle));
        // The slice's plane contains this direction and the direction to the camera.
        let direction_view = vec3f(direction.x, -direction.y, 0.0);
        let side = normalize(cross(direction_view, to_camera));
        let projected = normal - side * dot(normal, side);
        let length_projected = max(length(projected), 1e-4);
        let tangent = cross(to_camera, side);
        let cos_normal = clamp(dot(projected, to_camera) / length_projected, -1.0, 1.0);
        let normal_angle = sign(dot(projected, tangent)) * acos(cos_normal);
        var horizons = vec2f(-1.0);
        for (var step = 0u; step < settings.steps; step++) {
            let fraction = (f32(step) + step_offset) / f32(settings.steps);
            let offset = direction * max(fraction * fraction * radius_px, f32(step) + 1.0);
            for (var end = 0; end < 2; end++) {
                let other = position_at(texel + vec2i(round(offset * select(1.0, -1.0, end == 1))));
                let delta = other - center;
                let distance = max(length(delta), 1e-5);
                // Occluders fade out with distance.
                let weight = saturate(1.0 - (distance - 0.5 * radius_m) / (0.5 * radius_m));
                let horizon = mix(-1.0, dot(delta / distance, to_camera), weight);
                horizons[end] = max(horizons[end], horizon);
            }
        }
        // The arc between both horizons, clipped to the hemisphere of the normal.
        let first = normal_angle + min(acos(clamp(horizons.x, -1.0, 1.0)) - normal_angle, PI * 0.5);
        let second = normal_angle + max(-acos(clamp(horizons.y, -1.0, 1.0)) - normal_angle, -PI * 0.5);
        let arc = 2.0 * cos_normal
            + (2.0 * first * sin(normal_angle) - cos(2.0 * first - normal_angle))
            + (2.0 * second * sin(normal_angle) - cos(2.0 * second - normal_angle));
        visibility += length_projected * arc * 0.25;
    }
    return vec4f(pow(saturate(visibility / f32(settings.slices)), settings.power));
}
