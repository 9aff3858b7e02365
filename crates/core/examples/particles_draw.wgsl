struct Particle { position: vec2f, velocity: vec2f }

@group(0) @binding(0) var<storage, read> particles: array<Particle>;

struct Dot { @builtin(position) position: vec4f, @location(0) color: vec3f }

@vertex fn dots(@builtin(vertex_index) corner: u32, @builtin(instance_index) index: u32) -> Dot {
    let own = particles[index];
    let offset = (vec2f(f32(corner & 1u), f32(corner >> 1u)) - 0.5) * 2.0 / 360.0;
    let speed = min(length(own.velocity) * 4.0, 1.0);
    let color = mix(vec3f(0.05, 0.12, 0.35), vec3f(0.5, 0.22, 0.05), speed);
    return Dot(vec4f(own.position * 0.85 + offset, 0.0, 1.0), color);
}

@fragment fn color(dot: Dot) -> @location(0) vec4f {
    return vec4f(dot.color, 1.0);
}
