// The moments of the technique `msm`: the first four powers of depth, in 16 bits each (Peters and Klein, "Moment Shadow Mapping",
// 2015). The sharpest bound that four moments allow gives the fraction of the filter that is farther away than the point.
#define_import_path shadowgraph::shadows::encoding

// The settings of the technique.
struct MomentSettings {
    // The fraction of visibility that is treated as light bleeding.
    bleed: f32,
    // The weight of the moments of an arbitrary depth.
    bias: f32,
    // Depth texels per moment texel along each axis.
    downscale: u32,
    // Blur radius in moment texels.
    blur_texels: u32,
    mips: u32,
}

// `depth`: 0 nearest to the light, 1 farthest.
fn moments_of(settings: MomentSettings, depth: f32) -> vec4f {
    let z = saturate(depth);
    let square = z * z;
    return vec4f(z, square, square * z, square * square);
}

// The paper's transform: combinations of moments that use the range from 0 to 1 well, to reduce rounding errors.
const QUANTIZED_FROM_MOMENTS = mat4x4f(
    vec4f(-2.07224649, 13.7948857237, 0.105877704, 9.7924062118),
    vec4f(32.23703778, -59.4683975703, -1.9077466311, -33.7652110555),
    vec4f(-68.571074599, 82.0359750338, 9.3496555107, 47.9456096605),
    vec4f(39.3703274134, -35.364903257, -6.6543490743, -23.9728048165),
);
const MOMENTS_FROM_QUANTIZED = mat4x4f(
    vec4f(0.2227744146, 0.1549679261, 0.1451988946, 0.163127443),
    vec4f(0.0771972861, 0.1394629426, 0.2120202157, 0.2591432266),
    vec4f(0.7926986636, 0.7963415838, 0.7258694464, 0.6539092497),
    vec4f(0.0319417555, -0.1722823173, -0.2758014811, -0.3376131734),
);
const QUANTIZED_OFFSET = vec4f(0.035955884801, 0.0, 0.0, 0.0);

// The encoding in a texel.
fn packed(moments: vec4f) -> vec4u {
    let quantized = QUANTIZED_FROM_MOMENTS * moments + QUANTIZED_OFFSET;
    return vec4u(pack2x16unorm(quantized.xy), pack2x16unorm(quantized.zw), 0u, 0u);
}

fn unpacked(texel: vec4u) -> vec4f {
    let quantized = vec4f(unpack2x16unorm(texel.x), unpack2x16unorm(texel.y));
    return MOMENTS_FROM_QUANTIZED * (quantized - QUANTIZED_OFFSET);
}

const EPSILON: f32 = 1e-12;

// The paper's algorithm 4, *Hamburger four moment shadow mapping*.
fn visibility_of(settings: MomentSettings, moments: vec4f, depth: f32) -> f32 {
    // Biases the moments against rounding errors, towards moments that are always valid.
    let b = mix(moments, vec4f(0.5), settings.bias);
    // The Cholesky factors of the moments' matrix.
    let l32_d22 = b.z - b.x * b.y;
    let d22 = b.y - b.x * b.x;
    let variance_of_square = b.w - b.y * b.y;
    // It is 0 for a single depth at an end of the range.
    let d33_d22 = max(variance_of_square * d22 - l32_d22 * l32_d22, EPSILON);
    let l32 = l32_d22 / d22;
    // Coefficients of the polynomial whose roots are the depths that shadow the point as much as the moments allow.
    var c = vec3f(1.0, depth, depth * depth);
    c.y -= b.x;
    c.z -= b.y + l32 * c.y;
    c.y /= d22;
    c.z *= d22 / d33_d22;
    c.y -= l32 * c.z;
    c.x -= dot(c.yz, b.xy);
    let highest = select(c.z, EPSILON, abs(c.z) < EPSILON);
    let p = c.y / highest;
    let q = c.x / highest;
    let root = sqrt(max(0.25 * p * p - q, 0.0));
    let z1 = -0.5 * p - root;
    let z2 = -0.5 * p + root;
    // The fraction that is nearer to the light than the point.
    var blocked = 0.0;
    if z2 < depth {
        blocked = 1.0 + (z1 * z2 - b.x * (z1 + z2) + b.y) / min((z2 - depth) * (depth - z1), -EPSILON);
    } else if z1 < depth {
        blocked = (depth * z2 - b.x * (depth + z2) + b.y) / max((z2 - z1) * (depth - z1), EPSILON);
    }
    return saturate(1.0 - blocked / (1.0 - settings.bleed));
}
