// The shadow views and lights of a frame with few of them, in uniform blocks: in fragment shaders Mesa's software driver reads storage
// buffers pixel by pixel. They are read as vectors of four words: where a browser reads the members of an array's element in a uniform
// block, each of them costs a division.
#define_import_path shadowgraph::shadows::views
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
#import shadowgraph::shadows::variant::ONE_LIGHT

const FEW_VIEWS: u32 = 32u;
const FEW_LIGHTS: u32 = 32u;
// Vectors of a ShadowView and of a ShadowLight.
const VIEW_WORDS: u32 = 16u;
const LIGHT_WORDS: u32 = 10u;

@group(1) @binding(8) var<uniform> few_views: array<array<vec4u, VIEW_WORDS>, FEW_VIEWS>;
@group(1) @binding(9) var<uniform> few_lights: array<array<vec4u, LIGHT_WORDS>, FEW_LIGHTS>;

// The shadows of a light of the scene. The index is never constant: Mesa's software driver compiles a shader again for each value at a
// constant offset that a branch depends on, and corrupts memory if there are more than four in a block.
fn light_shadow(light: u32) -> ShadowLight {
    let zero = few_lights[0][9].z;
    let index = select(min(light + zero, FEW_LIGHTS - 1u), zero, ONE_LIGHT);
    let views = few_lights[index][0];
    let filters = few_lights[index][1];
    let bias = bitcast<vec4f>(few_lights[index][2]);
    let slope = bitcast<vec4f>(few_lights[index][3]);
    let fade = bitcast<vec4f>(few_lights[index][4]);
    let flags = few_lights[index][5];
    let eye = bitcast<vec4f>(few_lights[index][6]);
    let ends_m = array(bitcast<vec4f>(few_lights[index][7]), bitcast<vec4f>(few_lights[index][8]));
    let texel = few_lights[index][9];
    let is_known = light < select(FEW_LIGHTS, 1u, ONE_LIGHT);
    return ShadowLight(
        views.x, select(0u, views.y, is_known), views.z, views.w,
        filters.x, filters.y, filters.z, filters.w,
        bias.x, bias.y, bias.z, bias.w,
        slope.x, slope.y, slope.z, slope.w,
        fade.x, fade.y, fade.z, fade.w,
        flags.x, flags.y, flags.z, flags.w,
        eye.xyz, ends_m, bitcast<vec2f>(texel.xy), texel.z,
    );
}

// A view of a light, by its index among those of the light.
fn light_view(light: ShadowLight, index: u32) -> ShadowView {
    let view = light.first_view + index;
    let uv = bitcast<vec4f>(few_views[view][8]);
    let sphere = bitcast<vec4f>(few_views[view][10]);
    let texel = bitcast<vec4f>(few_views[view][11]);
    let range = few_views[view][12];
    let range_m = bitcast<vec4f>(range);
    let bias = few_views[view][14];
    let flags = few_views[view][15];
    return ShadowView(
        mat4x4f(
            bitcast<vec4f>(few_views[view][0]), bitcast<vec4f>(few_views[view][1]),
            bitcast<vec4f>(few_views[view][2]), bitcast<vec4f>(few_views[view][3]),
        ),
        mat4x4f(
            bitcast<vec4f>(few_views[view][4]), bitcast<vec4f>(few_views[view][5]),
            bitcast<vec4f>(few_views[view][6]), bitcast<vec4f>(few_views[view][7]),
        ),
        uv.xy, uv.zw, bitcast<vec4f>(few_views[view][9]), sphere.xyz, sphere.w,
        texel.x, texel.y, texel.z, texel.w,
        range_m.x, range.y, range_m.z, range_m.w, few_views[view][13],
        bitcast<f32>(bias.x), bitcast<f32>(bias.y), bias.zw, flags.x, flags.y, bitcast<vec2f>(flags.zw),
    );
}
