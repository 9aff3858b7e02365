// Removes the noise of ambient occlusion: averages four by four pixels of the same surface.
#import shadowgraph::view::view
#import shadowgraph::ground_depth::{GroundPlane, surface_view_depth}

@group(0) @binding(1) var depth_texture: texture_depth_2d;
@group(0) @binding(2) var noisy: texture_2d<f32>;
@group(0) @binding(3) var<uniform> ground: GroundPlane;

@fragment
fn fs_blur(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2i(position.xy);
    let center_depth = surface_view_depth(textureLoad(depth_texture, texel, 0), position.xy, ground);
    if center_depth == 0.0 {
        return vec4f(1.0);
    }
    var sum = vec2f(0.0);
    for (var y = -2; y < 2; y++) {
        for (var x = -2; x < 2; x++) {
            let other = clamp(texel + vec2i(x, y), vec2i(0), vec2i(view.size_px) - 1);
            let other_depth = surface_view_depth(textureLoad(depth_texture, other, 0), vec2f(other) + 0.5, ground);
            let difference = abs(other_depth - center_depth) / center_depth;
            let weight = select(0.0, saturate(1.0 - difference * 20.0) + 1e-3, other_depth > 0.0);
            sum += vec2f(textureLoad(noisy, other, 0).r, 1.0) * weight;
        }
    }
    return vec4f(sum.x / max(sum.y, 1e-3));
}
