// Tonemaps scene-linear light with exposure applied. The target must have an sRGB format, which encodes the output.
#import shadowgraph::fullscreen::{FullscreenVertex, fullscreen_vertex}

struct Settings {
    // Shown where nothing is drawn: linear RGB times alpha, and alpha.
    background: vec4f,
    // 1: shows the background.
    has_background: u32,
}

// Has the size of the target. Colours are multiplied by alpha.
@group(0) @binding(0) var hdr_texture: texture_2d<f32>;
@group(0) @binding(1) var<uniform> settings: Settings;
// One texel: a factor of all light.
@group(0) @binding(2) var exposure: texture_2d<f32>;

@vertex
fn vs_tonemap(@builtin(vertex_index) vertex_index: u32) -> FullscreenVertex {
    return fullscreen_vertex(vertex_index);
}

// Krzysztof Narkowicz' fit of the ACES filmic curve ("ACES Filmic Tone Mapping Curve", 2016), with its input
// scaled by 0.6, as the fit brightens more than ACES does.
fn filmic(color: vec3f) -> vec3f {
    let x = color * 0.6;
    return saturate((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14));
}

// Moves very bright colours towards white, as film does; otherwise a bright red stays a flat red.
fn desaturate_highlights(color: vec3f) -> vec3f {
    let peak = max(color.r, max(color.g, color.b));
    return mix(color, vec3f(peak), 0.3 * smoothstep(1.0, 12.0, peak));
}

fn opaque(light: vec4f) -> vec4f {
    return vec4f(filmic(desaturate_highlights(max(light.rgb, vec3f(0.0)))), 1.0);
}

// Without a branch: Mesa's software driver compiles a shader again for each draw if a branch depends on a uniform.
fn over_background(light: vec4f) -> vec4f {
    let alpha = select(1.0, saturate(light.a), settings.has_background == 1u);
    let color = filmic(desaturate_highlights(max(light.rgb, vec3f(0.0)) / max(alpha, 1e-3)));
    return vec4f(color * alpha, alpha) + settings.background * (1.0 - alpha);
}

@fragment
fn fs_tonemap(in: FullscreenVertex) -> @location(0) vec4f {
    return opaque(textureLoad(hdr_texture, vec2u(in.position.xy), 0));
}

@fragment
fn fs_tonemap_background(in: FullscreenVertex) -> @location(0) vec4f {
    return over_background(textureLoad(hdr_texture, vec2u(in.position.xy), 0));
}

@fragment
fn fs_tonemap_exposed(in: FullscreenVertex) -> @location(0) vec4f {
    let light = textureLoad(hdr_texture, vec2u(in.position.xy), 0);
    return over_background(vec4f(light.rgb * textureLoad(exposure, vec2u(0u), 0).r, light.a));
}
