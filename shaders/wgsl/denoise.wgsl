// Averages the noise of a screen mask over a few pixels of the same surface: neighbours with other noise values count as
// additional rays. Pixels whose rays all agree are outside penumbrae: they are unchanged and not averaged in.
#import shadowgraph::view::view_depth_of
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::raytraced_settings::RaytracedSettings

@group(1) @binding(0) var surfaces: texture_2d<f32>;
@group(1) @binding(1) var input_mask: texture_2d_array<f32>;
@group(1) @binding(2) var mask: texture_storage_2d_array<rgba8unorm, write>;
@group(1) @binding(4) var<uniform> settings: RaytracedSettings;

// The distance from a surface's plane, as a fraction of its view depth, above which samples belong to another surface.
const MAX_PLANE_DISTANCE: f32 = 0.002;

// The channels within a penumbra.
fn is_edge(visibility: vec4f) -> vec4<bool> {
    return (visibility > vec4f(0.0)) & (visibility < vec4f(1.0));
}

@compute @workgroup_size(8, 8)
fn cs_denoise(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2i(textureDimensions(surfaces));
    let pixel = vec2i(id.xy);
    if any(pixel >= size) {
        return;
    }
    let surface = textureLoad(surfaces, pixel, 0);
    let normal = unpack_normal(surface.w);
    let center = textureLoad(input_mask, pixel, id.z, 0);
    var sum = center;
    var count = vec4f(1.0);
    if any(normal != vec3f(0.0)) && any(is_edge(center)) {
        let max_distance = MAX_PLANE_DISTANCE * view_depth_of(surface.xyz);
        let radius = i32(settings.denoise_px);
        for (var y = -radius; y <= radius; y++) {
            for (var x = -radius; x <= radius; x++) {
                let at = pixel + vec2i(x, y);
                if (x == 0 && y == 0) || any(at < vec2i(0)) || any(at >= size) {
                    continue;
                }
                let other = textureLoad(surfaces, at, 0);
                if other.w >= 1.0 && abs(dot(other.xyz - surface.xyz, normal)) < max_distance {
                    let visibility = textureLoad(input_mask, at, id.z, 0);
                    let counted = vec4f(is_edge(visibility));
                    sum += counted * visibility;
                    count += counted;
                }
            }
        }
    }
    textureStore(mask, id.xy, id.z, select(center, sum / count, is_edge(center)));
}
