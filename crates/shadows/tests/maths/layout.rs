//! The structs of Rust and WGSL have the same layout.

use std::mem::offset_of;

use shadowgraph_shaders::{MAPPED, ModuleSource, builtin, check_layout, compose, compose_source};
use shadowgraph_shadows::{
    BIAS_GRADIENT, BIAS_PLANE, BIAS_RASTER, BIAS_SLOPE, BLEND_DITHER, BLEND_HARD, BLEND_SOFT, MAP_ATLAS,
    MAP_CASCADES, NOT_A_CASCADE, SELECT_DEPTH, SELECT_FACE, SELECT_MAP, SELECT_SPHERE, ShadowLight,
    ShadowView,
};

const ENTRY: &str = "
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
@group(1) @binding(0) var<storage, read> all_views: array<ShadowView>;
@group(1) @binding(1) var<storage, read> all_lights: array<ShadowLight>;
@compute @workgroup_size(1) fn touch() {
    _ = all_views[0].radius + all_lights[0].strength;
}";

#[test]
fn structs_have_the_same_layout_in_wgsl_and_rust() {
    let module = compose_source(&ModuleSource::new("touch.wgsl", ENTRY), &[]).unwrap();
    check_layout!(&module, "ShadowView", ShadowView:
        clip_from_world, map_from_world, uv_min, uv_max, light, center, radius, texel_world, depth_per_texel,
        axis_scale, depth_range_m, near_m, cascade, begin_m, end_m, tile_px, bias_scale, depth_step, noise_px,
        is_tinted, is_open, texel_scale,
    )
    .unwrap();
    assert_eq!(size_of::<ShadowView>(), 256);
    // `depth.wgsl` declares these two offsets.
    assert_eq!((offset_of!(ShadowView, clip_from_world), offset_of!(ShadowView, noise_px)), (0, 232));
    check_layout!(&module, "ShadowLight", ShadowLight:
        first_view, view_count, map, select, blend, filter_taps, bias_method, normal_sine, strength,
        normal_bias_texels, slope_bias, min_slope, max_slope, depth_bias_texels, fade_end_m, fade_per_m,
        blend_fraction, edge_fade, filter_half, filter_falloff, supersample, close_creases, fades_by_radius,
        branch_free, eye, ends_m, texel_uv, zero,
    )
    .unwrap();
}

#[test]
fn constants_are_the_same_in_wgsl_and_rust() {
    let types = builtin("shadows/types.wgsl").unwrap().source;
    for (name, value) in [
        ("MAP_CASCADES", MAP_CASCADES),
        ("MAP_ATLAS", MAP_ATLAS),
        ("SELECT_MAP", SELECT_MAP),
        ("SELECT_SPHERE", SELECT_SPHERE),
        ("SELECT_DEPTH", SELECT_DEPTH),
        ("SELECT_FACE", SELECT_FACE),
        ("BLEND_HARD", BLEND_HARD),
        ("BLEND_SOFT", BLEND_SOFT),
        ("BLEND_DITHER", BLEND_DITHER),
        ("BIAS_PLANE", BIAS_PLANE),
        ("BIAS_SLOPE", BIAS_SLOPE),
        ("BIAS_GRADIENT", BIAS_GRADIENT),
        ("BIAS_RASTER", BIAS_RASTER),
    ] {
        assert!(types.contains(&format!("const {name}: u32 = {value}u;")), "{name}");
    }
    assert!(types.contains(&format!("const NOT_A_CASCADE: u32 = {NOT_A_CASCADE:#x}u;")));
}

#[test]
fn technique_composes_into_the_lit_pass_and_into_compute() {
    let technique = MAPPED;
    compose("forward.wgsl", std::slice::from_ref(&technique)).unwrap();
    // In a compute shader, implicit derivatives would be a validation error.
    let entry = "
        #import shadowgraph::receiver::Receiver
        #import shadowgraph::technique::{shadow_visibility, shadow_debug_color}
        @group(0) @binding(0) var<storage, read_write> result: array<vec4f>;
        @compute @workgroup_size(1) fn evaluate() {
            let receiver = Receiver();
            result[0] = vec4f(shadow_visibility(0u, receiver), 1.0);
            result[1] = vec4f(shadow_debug_color(0u, receiver), 1.0);
        }";
    compose_source(&ModuleSource::new("evaluate.wgsl", entry), &[technique]).unwrap();
}
