// The optical density of translucent surfaces: -log2 of the transmittance of red, green and blue, in a word of three numbers of 10 bits.
// Surfaces are added in any order, with the same result.
#define_import_path shadowgraph::tint_density

// Of a halving of the light.
const STEPS: f32 = 128.0;
// Nothing passes.
const OPAQUE: u32 = 1023u;

fn density_of(transmittance: vec3f) -> vec3u {
    return vec3u(round(clamp(-STEPS * log2(max(transmittance, vec3f(1e-6))), vec3f(0.0), vec3f(f32(OPAQUE)))));
}

fn packed_density(density: vec3u) -> u32 {
    let bounded = min(density, vec3u(OPAQUE));
    return bounded.x | (bounded.y << 10u) | (bounded.z << 20u);
}

fn unpacked_density(word: u32) -> vec3u {
    return (vec3u(word) >> vec3u(0u, 10u, 20u)) & vec3u(OPAQUE);
}

fn density_transmittance(word: u32) -> vec3f {
    let density = unpacked_density(word);
    return select(exp2(-vec3f(density) / STEPS), vec3f(0.0), density == vec3u(OPAQUE));
}
