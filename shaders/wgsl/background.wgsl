// The background of a lit pass, at the far plane.
#import shadowgraph::fullscreen::{FullscreenVertex, fullscreen_vertex}
#import shadowgraph::environment::background_light

@vertex
fn vs_background(@builtin(vertex_index) vertex_index: u32) -> FullscreenVertex {
    return fullscreen_vertex(vertex_index);
}

@fragment
fn fs_background(in: FullscreenVertex) -> @location(0) vec4f {
    return background_light(in.position.xy);
}
