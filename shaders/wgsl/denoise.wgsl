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

@compute @workgroup_size(8, 8)
fn cs_denoise(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2i(textureDimensions(surfaces));
    let pixel = vec2i(id.xy);
    if any(pixel >= size) {
        return;
    }
    let surface = textureLoad(surfaces, pixel, 0);
    let normal = unpack_normal(surface.w);
    var sum = textureLoad(input_mask, pixel, id.z, 0).rgb;
    var count = 1.0;
    if any(normal != vec3f(0.0)) && any(sum > vec3f(0.0)) && any(sum < vec3f(1.0)) {
        let max_distance = MAX_PLANE_DISTANCE * view_depth_of(surface.xyz);
        let radius = i32(settings.denoise_px);
        for (var y = -radius; y <= radius; y++) {
            for (var x = -radius; x <= radius; x++) {
                let at = pixel + vec2i(x, y);
                if (x == 0 && y == 0) || any(at < vec2i(0)) || any(at >= size) {
                    continue;
                }
                let other = textureLoad(surfaces, at, 0);
                let visibility = textureLoad(input_mask, at, id.z, 0).rgb;
                let is_edge = any(visibility > vec3f(0.0)) && any(visibility < vec3f(1.0));
                if is_edge && other.w >= 1.0 && abs(dot(other.xyz - surface.xyz, normal)) < max_distance {
                    sum += visibility;
                    count += 1.0;
                }
            }
        }
    }
    textureStore(mask, id.xy, id.z, vec4f(sum / count, 1.0));
}
