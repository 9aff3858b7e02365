// An image with an overlay whose colours are stored display-encoded.
#import shadowgraph::shadows::colors::to_linear
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var overlay: texture_2d<f32>;
@group(0) @binding(2) var<uniform> strength: f32;

@fragment
fn fs_overlay(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let base = textureLoad(image, vec2u(position.xy), 0);
    let color = textureLoad(overlay, vec2u(position.xy), 0);
    return vec4f(mix(base.rgb, to_linear(color.rgb), strength * color.a), base.a);
}
