// One triangle that covers the viewport: draw 3 vertices, no buffers.
#define_import_path shadowgraph::fullscreen

struct FullscreenVertex {
    @builtin(position) position: vec4f,
    // 0 to 1 over the viewport, top left first.
    @location(0) uv: vec2f,
}

fn fullscreen_vertex(vertex_index: u32) -> FullscreenVertex {
    let uv = vec2f(f32((vertex_index << 1u) & 2u), f32(vertex_index & 2u));
    return FullscreenVertex(vec4f(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.0, 1.0), uv);
}
