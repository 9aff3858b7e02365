// The view depth of what each pixel shows, metres; 0 where that is neither a surface nor the ground.
#import shadowgraph::ground_depth::{GroundPlane, surface_view_depth}

@group(0) @binding(1) var depth_texture: texture_depth_2d;
@group(0) @binding(2) var<uniform> ground: GroundPlane;

@fragment
fn fs_view_depth(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let depth = textureLoad(depth_texture, vec2i(position.xy), 0);
    return vec4f(surface_view_depth(depth, position.xy, ground));
}
