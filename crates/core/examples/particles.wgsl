// Particles in a flow around four centres.

struct Particle { position: vec2f, velocity: vec2f }

@group(0) @binding(0) var<storage, read_write> particles: array<Particle>;

fn hash(seed: u32) -> f32 {
    var x = seed * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    return f32((x >> 22u) ^ x) / 4294967295.0;
}

@compute @workgroup_size(64) fn scatter(@builtin(global_invocation_id) id: vec3u) {
    let place = vec2f(hash(id.x * 2u), hash(id.x * 2u + 1u)) * 2.0 - 1.0;
    particles[id.x] = Particle(place, vec2f(0.0));
}

@compute @workgroup_size(64) fn advance(@builtin(global_invocation_id) id: vec3u) {
    var own = particles[id.x];
    var force = -0.4 * own.position;
    for (var i = 0u; i < 4u; i++) {
        let center = vec2f(f32(i & 1u), f32(i >> 1u)) - 0.5;
        let away = own.position - center;
        let turn = select(-1.0, 1.0, (i == 0u) || (i == 3u));
        force += turn * vec2f(-away.y, away.x) / (dot(away, away) + 0.05);
    }
    own.velocity = own.velocity * 0.96 + force * 0.004;
    own.position += own.velocity * 0.1;
    particles[id.x] = own;
}
