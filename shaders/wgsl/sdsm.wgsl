// Fits cascades to the visible surfaces (Lauritzen, Salvi and Lefohn, "Sample Distribution Shadow Maps", 2011): finds their depth
// range, splits it, and fits each cascade to the surfaces in its split. Nothing is read back.
#import shadowgraph::float_order::{decoded, encoded}
#import shadowgraph::view::{view, view_depth_of}
#import shadowgraph::shadows::lookup::light_axes
#import shadowgraph::shadows::types::{ShadowView, ShadowLight, NOT_A_CASCADE}

// The settings, and what the frame adds.
struct Fit {
    // 0: uniform splits, 1: logarithmic splits.
    lambda: f32,
    // Above 1 nearer cascades are shorter.
    nearness: f32,
    // Number of views; those of cascades come first.
    views: u32,
    // Number of cascades of each light that has any. The last cascade covers the whole view and is not fitted: the farthest
    // split is read from it.
    cascades: u32,
    // Number of lights with cascades.
    lights: u32,
    map_width_px: f32,
    map_height_px: f32,
    // View depths where the first cascade begins and shadows end, metres.
    nearest: f32,
    farthest: f32,
}

// Bounds of the surfaces in a cascade, on the light's axes; floats are encoded as integers of the same order.
struct Bounds {
    lowest: array<atomic<u32>, 3>,
    highest: array<atomic<u32>, 3>,
}

@group(1) @binding(0) var surfaces: texture_2d<f32>;
@group(1) @binding(1) var<storage, read> planned: array<ShadowView>;
@group(1) @binding(2) var<storage, read> shadow_lights: array<ShadowLight>;
@group(1) @binding(3) var<uniform> fit: Fit;
// The bits of the smallest and the largest view depth.
@group(1) @binding(4) var<storage, read_write> depths: array<atomic<u32>, 2>;
// One for each view of a cascade.
@group(1) @binding(5) var<storage, read_write> bounds: array<Bounds>;

@group(2) @binding(0) var<storage, read_write> fitted: array<ShadowView>;

const MAX_VIEWS: u32 = 32u;
const GROUP_SIZE: u32 = 8u;

var<workgroup> group_depths: array<atomic<u32>, 2>;
var<workgroup> group_bounds: array<atomic<u32>, 192>;

// The view depth of a pixel's surface, at least that where the first cascade begins; 0 where there is none within the shadow distance.
fn depth_at(pixel: vec2u) -> f32 {
    if any(pixel >= textureDimensions(surfaces)) {
        return 0.0;
    }
    let surface = textureLoad(surfaces, pixel, 0);
    let depth = view_depth_of(surface.xyz);
    return select(0.0, max(depth, fit.nearest), surface.w >= 1.0 && depth < fit.farthest);
}

@compute @workgroup_size(8, 8)
fn cs_depths(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    if local == 0u {
        atomicStore(&group_depths[0], 0xffffffffu);
        atomicStore(&group_depths[1], 0u);
    }
    workgroupBarrier();
    let depth = depth_at(id.xy);
    if depth > 0.0 {
        atomicMin(&group_depths[0], bitcast<u32>(depth));
        atomicMax(&group_depths[1], bitcast<u32>(depth));
    }
    workgroupBarrier();
    if local == 0u {
        atomicMin(&depths[0], atomicLoad(&group_depths[0]));
        atomicMax(&depths[1], atomicLoad(&group_depths[1]));
    }
}

// The view depth where cascade `index` ends, if it is fitted.
fn split(index: u32) -> f32 {
    let first = bitcast<f32>(atomicLoad(&depths[0]));
    let last = bitcast<f32>(atomicLoad(&depths[1])) * 1.0001;
    let fraction = pow(f32(index + 1u) / f32(fit.cascades), fit.nearness);
    let by_ratio = first * pow(last / first, fraction);
    return mix(mix(first, last, fraction), by_ratio, fit.lambda);
}

@compute @workgroup_size(8, 8)
fn cs_bounds(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    let slots = 6u * min(fit.cascades * fit.lights, MAX_VIEWS);
    for (var slot = local; slot < slots; slot += GROUP_SIZE * GROUP_SIZE) {
        atomicStore(&group_bounds[slot], select(0u, 0xffffffffu, slot % 6u < 3u));
    }
    workgroupBarrier();
    let depth = depth_at(id.xy);
    if depth > 0.0 {
        let position = textureLoad(surfaces, id.xy, 0).xyz;
        var cascade = 0u;
        while cascade + 1u < fit.cascades && depth >= split(cascade) {
            cascade++;
        }
        // Surfaces in the farthest split, and those in front of the first, are left to the cascade that covers the whole view.
        let is_fitted = cascade + 1u < fit.cascades && view_depth_of(position) >= fit.nearest;
        let lights = select(0u, fit.lights, is_fitted);
        for (var light = 0u; light < lights; light++) {
            let index = light * fit.cascades + cascade;
            let at = position * light_axes(planned[index]);
            for (var axis = 0u; axis < 3u; axis++) {
                let code = encoded(at[axis]);
                atomicMin(&group_bounds[6u * index + axis], code);
                atomicMax(&group_bounds[6u * index + 3u + axis], code);
            }
        }
    }
    workgroupBarrier();
    for (var slot = local; slot < slots; slot += GROUP_SIZE * GROUP_SIZE) {
        let code = atomicLoad(&group_bounds[slot]);
        if slot % 6u < 3u {
            atomicMin(&bounds[slot / 6u].lowest[slot % 3u], code);
        } else {
            atomicMax(&bounds[slot / 6u].highest[slot % 3u], code);
        }
    }
}

// Rounds up to one of 32 equal steps per factor of two, so that a small change of the view changes no texel.
fn rounded_up(x: f32) -> f32 {
    let step = exp2(floor(log2(x))) / 32.0;
    return ceil(x / step) * step;
}

fn fitted_view(old: ShadowView, index: u32, cascade: u32) -> ShadowView {
    var lowest: vec3f;
    var highest: vec3f;
    for (var axis = 0u; axis < 3u; axis++) {
        lowest[axis] = decoded(atomicLoad(&bounds[index].lowest[axis]));
        highest[axis] = decoded(atomicLoad(&bounds[index].highest[axis]));
    }
    var result = old;
    result.end_m = split(cascade);
    result.begin_m = fit.nearest;
    if cascade > 0u {
        result.begin_m = split(cascade - 1u);
    }
    // Surfaces extend up to a pixel beyond the sampled positions.
    let c = view.clip_from_world;
    let scale = length(vec3f(c[0].y, c[1].y, c[2].y));
    let pixel = 2.0 / (scale * view.size_px.y) * select(result.end_m, 1.0, view.orthographic == 1u);
    let half = 0.5 * (highest - lowest) + 2.0 * pixel;
    let center = 0.5 * (highest + lowest);

    let tile = vec4f(old.tile_px);
    let border = old.uv_min.x * fit.map_width_px - tile.x;
    var margin = 2.0 + border;
    for (var light = 0u; light < arrayLength(&shadow_lights); light++) {
        let first = shadow_lights[light].first_view;
        if shadow_lights[light].view_count > 0u && index >= first && index < first + shadow_lights[light].view_count {
            margin += shadow_lights[light].normal_bias_texels * max(old.bias_scale, 1.0);
        }
    }
    let texel = rounded_up(2.0 * max(half.x, half.y) / (tile.z - 2.0 * margin));
    let extent = 0.5 * texel * tile.z;
    let snapped = round(center.xy / texel);
    // Leaves a margin towards the light for steep slopes around a point.
    let far = center.z - half.z - 8.0 * texel;
    let range = rounded_up(2.0 * half.z + 128.0 * texel);

    let axes = light_axes(old);
    let x = vec4f(axes[0], -snapped.x * texel) / extent;
    let y = vec4f(axes[1], -snapped.y * texel) / extent;
    let z = vec4f(axes[2], -far) / range;
    result.clip_from_world = transpose(mat4x4f(x, y, z, vec4f(0.0, 0.0, 0.0, 1.0)));
    let u = (0.5 * tile.z * x + vec4f(0.0, 0.0, 0.0, tile.x + 0.5 * tile.z)) / fit.map_width_px;
    let v = (-0.5 * tile.w * y + vec4f(0.0, 0.0, 0.0, tile.y + 0.5 * tile.w)) / fit.map_height_px;
    result.map_from_world = transpose(mat4x4f(u, v, z, vec4f(0.0, 0.0, 0.0, 1.0)));
    result.center = axes * vec3f(snapped * texel, center.z);
    result.radius = length(half);
    result.texel_world = texel;
    result.texel_scale = vec2f(1.0);
    result.depth_per_texel = texel / range;
    result.axis_scale = extent;
    result.depth_range_m = range;
    let moved = vec2f(snapped.x, -snapped.y) - tile.xy - 0.5 * tile.zw;
    result.noise_px = vec2u(moved - 1024.0 * floor(moved / 1024.0));
    return result;
}

@compute @workgroup_size(64)
fn cs_fit(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    if index >= fit.views {
        return;
    }
    let old = planned[index];
    let cascade = old.cascade;
    let is_fitted = cascade != NOT_A_CASCADE && cascade + 1u < fit.cascades;
    if is_fitted && index < fit.cascades * fit.lights {
        // A cascade without surfaces in its split stays as planned.
        if atomicLoad(&bounds[index].highest[0]) != 0u {
            fitted[index] = fitted_view(old, index, cascade);
            return;
        }
    }
    fitted[index] = old;
}
