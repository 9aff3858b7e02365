// A metallic-roughness material: group 2. Absent textures are 1x1 placeholders: white, or flat normals.
#define_import_path shadowgraph::material
#import shadowgraph::material_features::{TEXTURES, UV_TRANSFORMS}

const MATERIAL_MASK: u32 = 1u;
const MATERIAL_BLEND: u32 = 2u;
const MATERIAL_UNLIT: u32 = 4u;
const MATERIAL_DOUBLE_SIDED: u32 = 8u;
// If not set, the normal texture is not read.
const MATERIAL_NORMAL_MAP: u32 = 16u;
// It receives no shadows.
const MATERIAL_UNSHADOWED: u32 = 32u;
// With MATERIAL_BLEND: highlights do not fade with alpha, and what is behind is tinted by the colour.
const MATERIAL_TRANSMIT: u32 = 64u;

const BASE_COLOR: u32 = 0u;
const METALLIC_ROUGHNESS: u32 = 1u;
const NORMAL: u32 = 2u;
const OCCLUSION: u32 = 3u;
const EMISSIVE: u32 = 4u;

// 256 bytes.
struct Material {
    base_color: vec4f,
    // Factor times strength.
    emissive: vec3f,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    // Fragments of a masked material below this alpha are holes.
    alpha_cutoff: f32,
    // Bit i: texture i reads the second uv set.
    uv_sets: u32,
    // The element of `flags` to read: 0.
    flags_index: u32,
    // Where the material clips its shadow, surfaces below this alpha cast none.
    caster_cutoff: f32,
    // Two rows a texture (w unused): uv' = (dot(row, (u, v, 1)), dot(next row, (u, v, 1))).
    uv_transforms: array<vec4f, 10>,
    // x: MATERIAL_* bits. Read them with material_flags.
    flags: array<vec4u, 2>,
}

@group(2) @binding(0) var<uniform> material: Material;
// base_color and emissive are sRGB formats, the others are not.
@group(2) @binding(1) var base_color_texture: texture_2d<f32>;
@group(2) @binding(2) var metallic_roughness_texture: texture_2d<f32>;
@group(2) @binding(3) var normal_texture: texture_2d<f32>;
@group(2) @binding(4) var occlusion_texture: texture_2d<f32>;
@group(2) @binding(5) var emissive_texture: texture_2d<f32>;
@group(2) @binding(6) var base_color_sampler: sampler;
@group(2) @binding(7) var metallic_roughness_sampler: sampler;
@group(2) @binding(8) var normal_sampler: sampler;
@group(2) @binding(9) var occlusion_sampler: sampler;
@group(2) @binding(10) var emissive_sampler: sampler;

struct TextureCoordinates {
    first: vec2f,
    second: vec2f,
}

// MATERIAL_* bits, uniform over a draw. Where a branch depends on a uniform at a constant offset, Mesa's software driver
// compiles the shader again whenever the value changes from draw to draw; so the offset is not constant.
fn material_flags() -> u32 {
    return material.flags[material.flags_index].x;
}

// Whether all of `bits` (MATERIAL_*) are set. The result is uniform over a draw.
fn material_has(bits: u32) -> bool {
    return (material_flags() & bits) == bits;
}

// Whether some material of the scene has a texture.
fn has_texture(slot: u32) -> bool {
    return (TEXTURES & (1u << slot)) != 0u;
}

fn texture_uv(slot: u32, uv: TextureCoordinates) -> vec2f {
    if !UV_TRANSFORMS {
        return uv.first;
    }
    let use_second = ((material.uv_sets >> slot) & 1u) == 1u;
    let p = vec3f(select(uv.first, uv.second, use_second), 1.0);
    return vec2f(
        dot(material.uv_transforms[2u * slot].xyz, p),
        dot(material.uv_transforms[2u * slot + 1u].xyz, p),
    );
}

// The functions below sample with implicit derivatives: call them in uniform control flow.

// Linear colour and alpha; `vertex_color` is that of the mesh.
fn base_color(uv: TextureCoordinates, vertex_color: vec4f) -> vec4f {
    let color = material.base_color * vertex_color;
    if !has_texture(BASE_COLOR) {
        return color;
    }
    return color * textureSample(base_color_texture, base_color_sampler, texture_uv(BASE_COLOR, uv));
}

// The alpha of casters, for passes whose texture of the base colour has one channel. `uv` is that of texture_uv.
fn caster_alpha(uv: vec2f, vertex_alpha: f32) -> f32 {
    return material.base_color.a * vertex_alpha * textureSample(base_color_texture, base_color_sampler, uv).r;
}

// x: metallic, y: perceptual roughness, both 0 to 1.
fn metallic_roughness(uv: TextureCoordinates) -> vec2f {
    let factors = vec2f(material.metallic, material.roughness);
    if !has_texture(METALLIC_ROUGHNESS) {
        return saturate(factors);
    }
    let texel = textureSample(
        metallic_roughness_texture, metallic_roughness_sampler, texture_uv(METALLIC_ROUGHNESS, uv));
    return saturate(factors * texel.bg);
}

// In tangent space, unit length.
fn normal_in_tangent_space(uv: TextureCoordinates) -> vec3f {
    let texel = textureSample(normal_texture, normal_sampler, texture_uv(NORMAL, uv)).xyz;
    let scaled = (texel * 2.0 - 1.0) * vec3f(material.normal_scale, material.normal_scale, 1.0);
    // A filtered texel can be as short as 0.
    return scaled * inverseSqrt(max(dot(scaled, scaled), 1e-8));
}

// 1: not occluded.
fn occlusion(uv: TextureCoordinates) -> f32 {
    if !has_texture(OCCLUSION) {
        return 1.0;
    }
    let texel = textureSample(occlusion_texture, occlusion_sampler, texture_uv(OCCLUSION, uv)).r;
    return 1.0 + material.occlusion_strength * (texel - 1.0);
}

// Emitted radiance, before exposure.
fn emissive(uv: TextureCoordinates) -> vec3f {
    if !has_texture(EMISSIVE) {
        return material.emissive;
    }
    return material.emissive * textureSample(emissive_texture, emissive_sampler, texture_uv(EMISSIVE, uv)).rgb;
}

// Whether an alpha below the cutoff makes a hole. Blended surfaces are cut at one half where they must be either opaque or
// a hole (in depth).
fn is_hole(alpha: f32) -> bool {
    return (material_flags() & (MATERIAL_MASK | MATERIAL_BLEND)) != 0u && alpha < hole_cutoff();
}

fn hole_cutoff() -> f32 {
    return select(0.5, material.alpha_cutoff, material_has(MATERIAL_MASK));
}

// The fraction of the light that passes a translucent surface, tinted more by denser surfaces, and wholly by glass.
fn transmittance(color: vec4f) -> vec3f {
    let alpha = saturate(color.a);
    let density = select(alpha * (2.0 - alpha), 1.0, material_has(MATERIAL_TRANSMIT));
    return (1.0 - alpha) * mix(vec3f(1.0), saturate(color.rgb), density);
}

fn caster_cutoff() -> f32 {
    return material.caster_cutoff;
}
