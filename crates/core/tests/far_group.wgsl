// A bind group that not every device has: only modules for those that do may name it.

@vertex
fn everywhere(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(vec2u(vertex & 2u, (vertex << 1u) & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

@group(5) @binding(0) var<uniform> far: vec4u;

@fragment
fn far_number() -> @location(0) u32 {
    return far.x;
}
