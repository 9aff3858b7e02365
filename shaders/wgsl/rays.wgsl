#define_import_path shadowgraph::rays
#import shadowgraph::ray_surfaces::{CUTOUTS, TINTS}
// Shadow rays through a BVH of instances, each of which has a BVH of its mesh's triangles, with the same arithmetic as the CPU
// implementation.

// A node of a BVH, 32 bytes. With a count above 0, `first` is the first of its triangles; otherwise it is the first of its two children, or
// with the bit RAY_INSTANCE an instance, or 0 if the node is empty.
struct RayNode {
    lowest: vec3f,
    first: u32,
    highest: vec3f,
    count: u32,
}

// 48 bytes, in the space of its mesh.
struct RayTriangle {
    a: vec3f,
    // Counted within the mesh.
    index: u32,
    b: vec3f,
    unused_b: u32,
    c: vec3f,
    unused_c: u32,
}

// A mesh in the world, relative to the frame's origin, 128 bytes.
struct RayInstance {
    // Rows of world_from_mesh.
    world_x: vec4f,
    world_y: vec4f,
    world_z: vec4f,
    // Rows of mesh_from_world.
    mesh_x: vec4f,
    mesh_y: vec4f,
    mesh_z: vec4f,
    // Around the mesh's boxes, per metre of the ray's and the scene's coordinates.
    margin: vec3f,
    root: u32,
    // The surface of triangle 0, or RAY_NONE if all are opaque.
    first_surface: u32,
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
}

// Transmission of light through a triangle, 64 bytes.
struct RaySurface {
    uv_a: vec2f,
    uv_b: vec2f,
    uv_c: vec2f,
    // The word where its texture begins: alpha, followed by red, green and blue if it tints. RAY_NONE: only the factor.
    texture: u32,
    // Alpha below this is a hole. RAY_TINT: no holes, but light is tinted.
    cutoff: f32,
    // The factor of each corner.
    alpha: vec3f,
    // If not 0, light is tinted wholly, not by alpha.
    transmits: u32,
    // The factor of each corner: red in the lowest byte, green, blue.
    color: vec3u,
    unused_color: u32,
}

// A channel of a texture: four words.
struct RayTexture {
    first_texel: u32,
    width: u32,
    height: u32,
    // Bits 0 and 1: RAY_WRAP_* along u; 2 and 3: along v; 4: bilinear.
    sampling: u32,
}

@group(1) @binding(0) var<storage, read> ray_nodes: array<RayNode>;
@group(1) @binding(1) var<storage, read> ray_triangles: array<RayTriangle>;
@group(1) @binding(2) var<storage, read> ray_instances: array<RayInstance>;
@group(1) @binding(3) var<storage, read> ray_surfaces: array<RaySurface>;
// Textures: the description of each channel, then the texels of all, four to a word, the first in its lowest byte.
@group(1) @binding(4) var<storage, read> ray_words: array<u32>;

const RAY_NONE: u32 = 0xffffffffu;
const RAY_TINT: f32 = -1.0;
const RAY_WRAP_REPEAT: u32 = 0u;
const RAY_WRAP_MIRROR: u32 = 1u;
const RAY_BILINEAR: u32 = 16u;
const RAY_INSTANCE: u32 = 0x80000000u;
// The largest depth of the two levels together.
const RAY_STACK: u32 = 96u;
// Margin around the boxes of instances, per metre of the ray's and the scene's coordinates.
const RAY_MARGIN: f32 = 1.0 / 262144.0;
// The end of an unlimited ray.
const RAY_FAR: f32 = 3.0e38;
const RAY_MISS: f32 = 3.4e38;
// The fraction of the distance to a point light that its rays cover.
const RAY_LIGHT_FRACTION: f32 = 1.0 - 1.0 / 4096.0;

struct ShadowRay {
    origin: vec3f,
    min_t: f32,
    // The shear that maps the direction to (0, 0, 1), after its longest axis (0 to 2) was permuted to z.
    shear: vec3f,
    max_t: f32,
    axis: u32,
}

// A ray in the space of some boxes, which are widened by a margin. Its direction is not normalized, so that distances are those of the world.
struct RaySlabs {
    to_lowest: vec3f,
    to_highest: vec3f,
    // 1 / direction, finite.
    inverse: vec3f,
}

// Where a receiver's rays start. `max_coordinate` is the largest coordinate of the scene; both distances in metres.
fn ray_origin(position: vec3f, geometric_normal: vec3f, view_distance: f32, max_coordinate: f32) -> vec3f {
    let size = abs(position);
    let coordinates = 2.0 * max(size.x, max(size.y, size.z)) + 1.5 * max_coordinate;
    return position + geometric_normal * (coordinates / 1048576.0 + view_distance / 131072.0);
}

fn ray_permuted(p: vec3f, axis: u32) -> vec3f {
    return select(select(p, p.zxy, axis == 1u), p.yzx, axis == 0u);
}

fn ray_new(origin: vec3f, direction: vec3f, min_t: f32, max_t: f32) -> ShadowRay {
    let size = abs(direction);
    let axis = select(select(2u, 1u, size.y >= size.z), 0u, size.x >= size.y && size.x >= size.z);
    let permuted = ray_permuted(direction, axis);
    let shear = vec3f(permuted.x / permuted.z, permuted.y / permuted.z, 1.0 / permuted.z);
    return ShadowRay(origin, min_t, shear, max_t, axis);
}

fn ray_slabs(origin: vec3f, direction: vec3f, margin: vec3f) -> RaySlabs {
    let inverse = 1.0 / select(direction, vec3f(1e-20), abs(direction) < vec3f(1e-20));
    return RaySlabs(origin + margin, origin - margin, inverse);
}

// The distance along the ray at which it enters the box, below 0 if the origin is inside; RAY_MISS if it misses.
fn ray_enters(slabs: RaySlabs, node: RayNode) -> f32 {
    let to_lowest = (node.lowest - slabs.to_lowest) * slabs.inverse;
    let to_highest = (node.highest - slabs.to_highest) * slabs.inverse;
    let near = min(to_lowest, to_highest);
    let far = max(to_lowest, to_highest);
    let enters = max(near.x, max(near.y, near.z));
    let leaves = min(far.x, min(far.y, far.z));
    return select(RAY_MISS, enters, leaves >= enters && leaves >= 0.0);
}

// The point in the ray's sheared space: x and y across, z along the ray, metres.
fn ray_sheared(ray: ShadowRay, point: vec3f) -> vec3f {
    let p = ray_permuted(point - ray.origin, ray.axis);
    return vec3f(p.x - ray.shear.x * p.z, p.y - ray.shear.y * p.z, ray.shear.z * p.z);
}

// p.x * q.y - p.y * q.x, with the numbers split into halves of 12 bits whose products are exact in f32: the error is 2^-36 of
// |p| |q|, with and without fused products.
fn ray_side(p: vec2f, q: vec2f) -> f32 {
    let p_high = bitcast<vec2f>(bitcast<vec2u>(p) & vec2u(0xfffff000u));
    let q_high = bitcast<vec2f>(bitcast<vec2u>(q) & vec2u(0xfffff000u));
    let p_low = p - p_high;
    let q_low = q - q_high;
    let mixed = (p_high.x * q_low.y - p_high.y * q_low.x) + (p_low.x * q_high.y - p_low.y * q_high.x);
    let low = p_low.x * q_low.y - p_low.y * q_low.x;
    return (p_high.x * q_high.y - p_high.y * q_high.x) + (mixed + low);
}

fn ray_folded(at: f32, wrap: u32) -> f32 {
    if wrap == RAY_WRAP_REPEAT {
        return at - floor(at);
    }
    if wrap == RAY_WRAP_MIRROR {
        let period = at - 2.0 * floor(at * 0.5);
        return min(period, 2.0 - period);
    }
    return clamp(at, 0.0, 1.0);
}

// The wrapped index of a texel at most one step outside.
fn ray_inside(index: i32, size: i32, wrap: u32) -> u32 {
    if wrap == RAY_WRAP_REPEAT {
        return u32(select(select(index, index - size, index >= size), index + size, index < 0));
    }
    return u32(clamp(index, 0, size - 1));
}

fn ray_texel(image: RayTexture, x: i32, y: i32) -> f32 {
    let column = ray_inside(x, i32(image.width), image.sampling & 3u);
    let row = ray_inside(y, i32(image.height), (image.sampling >> 2u) & 3u);
    let index = image.first_texel + row * image.width + column;
    let word = ray_words[index >> 2u];
    return f32((word >> (8u * (index & 3u))) & 255u) * (1.0 / 255.0);
}

fn ray_value(image: RayTexture, uv: vec2f) -> f32 {
    let folded = vec2f(
        ray_folded(uv.x, image.sampling & 3u), ray_folded(uv.y, (image.sampling >> 2u) & 3u));
    let at = folded * vec2f(f32(image.width), f32(image.height));
    if (image.sampling & RAY_BILINEAR) == 0u {
        return ray_texel(image, i32(at.x), i32(at.y));
    }
    let base = floor(at - 0.5);
    let part = at - 0.5 - base;
    let x = i32(base.x);
    let y = i32(base.y);
    let top_left = ray_texel(image, x, y);
    let bottom_left = ray_texel(image, x, y + 1);
    let top = top_left + (ray_texel(image, x + 1, y) - top_left) * part.x;
    let bottom = bottom_left + (ray_texel(image, x + 1, y + 1) - bottom_left) * part.x;
    return top + (bottom - top) * part.y;
}

// The value of one of a surface's channels at the hit.
fn ray_channel(surface: RaySurface, channel: u32, weights: vec3f) -> f32 {
    if surface.texture == RAY_NONE {
        return 1.0;
    }
    let word = surface.texture + 4u * channel;
    let image = RayTexture(ray_words[word], ray_words[word + 1u], ray_words[word + 2u], ray_words[word + 3u]);
    let uv = surface.uv_a * weights.x + surface.uv_b * weights.y + surface.uv_c * weights.z;
    return ray_value(image, uv);
}

// Whether a triangle of an instance blocks light at the hit; if it does not, `passed` is multiplied by its transmittance.
fn ray_stops(first_surface: u32, triangle: u32, weights: vec3f, passed: ptr<function, vec3f>) -> bool {
    if !(CUTOUTS || TINTS) || first_surface == RAY_NONE {
        return true;
    }
    let surface = ray_surfaces[first_surface + triangle];
    var alpha = surface.alpha.x * weights.x + surface.alpha.y * weights.y + surface.alpha.z * weights.z;
    alpha *= ray_channel(surface, 0u, weights);
    if !TINTS || surface.cutoff != RAY_TINT {
        return alpha >= surface.cutoff;
    }
    let texture = vec3f(
        ray_channel(surface, 1u, weights), ray_channel(surface, 2u, weights), ray_channel(surface, 3u, weights));
    let corners = mat3x3f(
        unpack4x8unorm(surface.color.x).rgb, unpack4x8unorm(surface.color.y).rgb, unpack4x8unorm(surface.color.z).rgb);
    alpha = saturate(alpha);
    let density = select(alpha * (2.0 - alpha), 1.0, surface.transmits != 0u);
    *passed *= (1.0 - alpha) * mix(vec3f(1.0), corners * weights * texture, density);
    return false;
}

// A corner of a triangle in the world, by the arithmetic of draw.wgsl.
fn ray_corner(instance: RayInstance, corner: vec3f) -> vec3f {
    let p = vec4f(corner, 1.0);
    return vec3f(dot(instance.world_x, p), dot(instance.world_y, p), dot(instance.world_z, p));
}

// The test of Woop, Benthin and Wald (Watertight Ray/Triangle Intersection, JCGT 2013), from both sides.
fn ray_meets(ray: ShadowRay, instance: RayInstance, triangle: RayTriangle, passed: ptr<function, vec3f>) -> bool {
    let a = ray_sheared(ray, ray_corner(instance, triangle.a));
    let b = ray_sheared(ray, ray_corner(instance, triangle.b));
    let c = ray_sheared(ray, ray_corner(instance, triangle.c));
    let areas = vec3f(ray_side(c.xy, b.xy), ray_side(a.xy, c.xy), ray_side(b.xy, a.xy));
    if any(areas < vec3f(0.0)) && any(areas > vec3f(0.0)) {
        return false;
    }
    let area = areas.x + areas.y + areas.z;
    if area == 0.0 {
        return false;
    }
    let weights = areas / area;
    let t = weights.x * a.z + weights.y * b.z + weights.z * c.z;
    return t >= ray.min_t && t < ray.max_t && ray_stops(instance.first_surface, triangle.index, weights, passed);
}

fn ray_meets_any(ray: ShadowRay, instance: u32, node: RayNode, passed: ptr<function, vec3f>) -> bool {
    for (var i = 0u; i < node.count; i++) {
        if ray_meets(ray, ray_instances[instance], ray_triangles[node.first + i], passed) {
            return true;
        }
    }
    return false;
}

// The fraction of light that passes along the ray from `min_t` to `max_t`, metres, at most RAY_FAR: 0 if an opaque surface lies
// between. `direction` has unit length; `max_coordinate` is the largest coordinate of the scene.
fn ray_passed(origin: vec3f, direction: vec3f, min_t: f32, max_t: f32, max_coordinate: f32) -> vec3f {
    var passed = vec3f(1.0);
    let ray = ray_new(origin, direction, min_t, max_t);
    let size = abs(origin);
    let coordinates = max_coordinate + max(size.x, max(size.y, size.z));
    let world = ray_slabs(origin, direction, vec3f(RAY_MARGIN * coordinates));
    var stack: array<u32, RAY_STACK>;
    var height = 0u;
    // The current level: the ray in its space, its instance, and the height of the stack below it.
    var slabs = world;
    var instance = RAY_NONE;
    var base = 0u;
    // A pair of nodes or an instance. The root is in no pair, so 0 means none.
    let root = ray_nodes[0];
    var next = select(0u, root.first, ray_enters(world, root) < max_t);
    loop {
        if next == 0u {
            if height == base {
                slabs = world;
                instance = RAY_NONE;
                base = 0u;
            }
            if height == 0u {
                break;
            }
            height--;
            next = stack[height];
        }
        if (next & RAY_INSTANCE) != 0u {
            instance = next & ~RAY_INSTANCE;
            base = height;
            let m = ray_instances[instance];
            let p = vec4f(origin, 1.0);
            let mesh_origin = vec3f(dot(m.mesh_x, p), dot(m.mesh_y, p), dot(m.mesh_z, p));
            let mesh_direction =
                vec3f(dot(m.mesh_x.xyz, direction), dot(m.mesh_y.xyz, direction), dot(m.mesh_z.xyz, direction));
            slabs = ray_slabs(mesh_origin, mesh_direction, coordinates * m.margin);
            let node = ray_nodes[m.root];
            next = 0u;
            if ray_enters(slabs, node) < max_t {
                next = node.first;
                if node.count > 0u {
                    if ray_meets_any(ray, instance, node, &passed) {
                        return vec3f(0.0);
                    }
                    next = 0u;
                }
            }
            continue;
        }
        var node = ray_nodes[next];
        var other = ray_nodes[next + 1u];
        var enters = ray_enters(slabs, node);
        var enters_other = ray_enters(slabs, other);
        if enters > enters_other {
            let node_before = node;
            let enters_before = enters;
            node = other;
            enters = enters_other;
            other = node_before;
            enters_other = enters_before;
        }
        next = 0u;
        if enters < max_t {
            if node.count == 0u {
                next = node.first;
            } else if ray_meets_any(ray, instance, node, &passed) {
                return vec3f(0.0);
            }
        }
        if enters_other < max_t {
            if other.count > 0u {
                if ray_meets_any(ray, instance, other, &passed) {
                    return vec3f(0.0);
                }
            } else if next == 0u {
                next = other.first;
            } else {
                stack[height] = other.first;
                height++;
            }
        }
    }
    return passed;
}
