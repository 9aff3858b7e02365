// A torus, ray-marched from an eye a little to one side.

@group(0) @binding(0) var<uniform> eye: vec4f;

fn field(p: vec3f) -> f32 {
    let bent = vec2f(length(p.xz) - 1.0, p.y);
    return min(length(bent) - 0.35, p.y + 0.7);
}

@fragment fn march(@location(0) uv: vec2f) -> @location(0) vec4f {
    let origin = vec3f(eye.x, 1.6, 3.2);
    let forward = normalize(-origin);
    let right = normalize(cross(forward, vec3f(0.0, 1.0, 0.0)));
    let up = cross(right, forward);
    let ray = normalize(forward + (uv.x - 0.5) * right + (0.5 - uv.y) * up);
    var t = 0.0;
    for (var i = 0; i < 96; i++) {
        t += field(origin + t * ray);
    }
    if t > 20.0 {
        return vec4f(mix(vec3f(0.35, 0.5, 0.7), vec3f(0.1, 0.2, 0.4), 1.0 - uv.y), 1.0);
    }
    let p = origin + t * ray;
    let e = vec2f(0.001, 0.0);
    let normal = normalize(vec3f(field(p + e.xyy) - field(p - e.xyy), field(p + e.yxy) - field(p - e.yxy),
        field(p + e.yyx) - field(p - e.yyx)));
    let facing = 0.25 + 0.75 * max(dot(normal, normalize(vec3f(0.5, 0.9, 0.4))), 0.0);
    let stripes = step(0.5, fract(atan2(p.z, p.x) * 2.5465));
    let tint = select(vec3f(0.5), mix(vec3f(0.9, 0.4, 0.1), vec3f(0.9, 0.8, 0.5), stripes), p.y > -0.69);
    return vec4f(tint * facing, 1.0);
}
