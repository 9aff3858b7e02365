// Tonemaps scene-linear light with exposure applied. The target must have an sRGB format, which encodes the output.
#import shadowgraph::fullscreen::{FullscreenVertex, fullscreen_vertex}

// Has the size of the target.
@group(0) @binding(0) var hdr_texture: texture_2d<f32>;

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

@fragment
fn fs_tonemap(in: FullscreenVertex) -> @location(0) vec4f {
    let color = max(textureLoad(hdr_texture, vec2u(in.position.xy), 0).rgb, vec3f(0.0));
    return vec4f(filmic(desaturate_highlights(color)), 1.0);
}
