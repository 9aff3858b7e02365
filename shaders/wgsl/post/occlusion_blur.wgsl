// Removes the noise of ambient occlusion: averages four by four pixels of the same plane, so each rotation counts once.
#import shadowgraph::view::view

// 0 where nothing is.
@group(0) @binding(1) var view_depth_texture: texture_2d<f32>;
@group(0) @binding(2) var noisy: texture_2d<f32>;

// What is linear on the screen along a plane: the inverse of view depth, in an orthographic view the depth; 0 without a surface.
fn linear_depth(texel: vec2i, is_orthographic: bool) -> f32 {
    let depth = textureLoad(view_depth_texture, texel, 0).r;
    return select(1.0 / max(depth, 1e-6), depth, depth == 0.0 || is_orthographic);
}

// The change to the next pixel along an axis, on the plane of the nearer of both neighbours.
fn slope(previous: vec2f, next: vec2f, center: f32) -> vec2f {
    let is_next = next > vec2f(0.0) & (previous == vec2f(0.0) | abs(next - center) < abs(center - previous));
    return select(select(vec2f(0.0), center - previous, previous > vec2f(0.0)), next - center, is_next);
}

@fragment
fn fs_blur(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = vec2i(position.xy);
    let last = vec2i(view.size_px) - 1;
    let is_orthographic = view.orthographic == 1u;
    // Left, up, right and down, then the pixel itself. One loop, as drivers inline each call.
    var around = vec4f(0.0);
    var center = 0.0;
    var i = 0;
    loop {
        let axis = select(vec2i(1, 0), vec2i(0, 1), (i & 1) == 1);
        let offset = select(select(axis, -axis, i < 2), vec2i(0), i == 4);
        let depth = linear_depth(clamp(texel + offset, vec2i(0), last), is_orthographic);
        around = select(around, vec4f(depth), vec4i(0, 1, 2, 3) == vec4i(i));
        center = depth;
        i++;
        if i >= 5 {
            break;
        }
    }
    if center == 0.0 {
        return vec4f(1.0);
    }
    let slopes = slope(around.xy, around.zw, center);
    var sum = vec2f(0.0);
    i = 0;
    loop {
        let other = clamp(texel + vec2i(i & 3, i >> 2u) - 2, vec2i(0), last);
        let depth = linear_depth(other, is_orthographic);
        let difference = abs(depth - center - dot(slopes, vec2f(other - texel))) / center;
        let weight = select(0.0, saturate(1.5 - difference * 30.0) + 1e-3, depth > 0.0);
        sum += vec2f(textureLoad(noisy, other, 0).r, 1.0) * weight;
        i++;
        if i >= 16 {
            break;
        }
    }
    return vec4f(sum.x / max(sum.y, 1e-3));
}
