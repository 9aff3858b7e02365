// The forward lit pass: every light, every material, whatever the shadow technique.
#import shadowgraph::view::{view, lights, view_depth_of, direction_to_camera, to_neighbour}
#import shadowgraph::draw::{
    Vertex, world_position, world_normal, world_direction, handedness, clip_position,
}
#import shadowgraph::material::{
    MATERIAL_MASK, MATERIAL_BLEND, MATERIAL_UNLIT, MATERIAL_NORMAL_MAP, MATERIAL_UNSHADOWED,
    TextureCoordinates, material_has,
    base_color, metallic_roughness, normal_in_tangent_space, occlusion, emissive, is_hole,
}
#import shadowgraph::surface::pack_normal
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT, RECEIVER_BACK_FACE}
#import shadowgraph::lighting::{Surface, surface_of, arriving_light, reflected, ambient}
#import shadowgraph::technique::{shadow_visibility, shadow_debug_color}

// What is written: 0 light, 1 the visibility of light AOV_LIGHT, 2 the technique's debug colours for that light,
// 3 the shading normal, 4 the surface itself.
override AOV: u32 = 0u;
override AOV_LIGHT: u32 = 0u;

const AOV_VISIBILITY: u32 = 1u;
const AOV_CASCADE: u32 = 2u;
const AOV_NORMAL: u32 = 3u;
const AOV_SURFACE: u32 = 4u;

// Half floats end at 65504.
const BRIGHTEST: f32 = 60000.0;

struct ForwardVertex {
    @invariant @builtin(position) position: vec4f,
    // Relative to the camera: its small numbers keep the derivatives precise where they matter, nearby.
    @location(0) from_camera: vec3f,
    @location(1) normal: vec3f,
    // w: which side the bitangent is on.
    @location(2) tangent: vec4f,
    @location(3) uv_first: vec2f,
    @location(4) uv_second: vec2f,
    @location(5) color: vec4f,
}

@vertex
fn vs_forward(vertex: Vertex) -> ForwardVertex {
    let position = world_position(vertex.instance, vertex.position);
    let side = vertex.tangent.w * handedness(vertex.instance);
    return ForwardVertex(
        clip_position(view.clip_from_world, position),
        position - view.position,
        world_normal(vertex.instance, vertex.normal),
        vec4f(world_direction(vertex.instance, vertex.tangent.xyz), side),
        vertex.uv_first,
        vertex.uv_second,
        vertex.color,
    );
}

// `fallback` where the direction has no length.
fn normalize_or(direction: vec3f, fallback: vec3f) -> vec3f {
    let length_squared = dot(direction, direction);
    if length_squared > 1e-30 {
        return direction * inverseSqrt(length_squared);
    }
    return fallback;
}

// The triangle's own normal, towards the viewer: for the front of a surface and for a back that is shown alike,
// that is the side that is seen.
fn geometric_normal(ddx_position: vec3f, ddy_position: vec3f, to_camera: vec3f, shading_normal: vec3f) -> vec3f {
    // Scaled to the same length first: up close, the product of two derivatives is too small a number.
    let right = normalize_or(ddx_position, vec3f(0.0));
    let down = normalize_or(ddy_position, vec3f(0.0));
    let n = normalize_or(cross(right, down), shading_normal);
    return select(n, -n, dot(n, to_camera) < 0.0);
}

// Reads a texture: call in uniform control flow.
fn shading_normal(in: ForwardVertex, uv: TextureCoordinates, front_facing: bool, to_camera: vec3f) -> vec3f {
    let smooth_normal = normalize_or(in.normal, to_camera);
    var normal = smooth_normal;
    if material_has(MATERIAL_NORMAL_MAP) {
        let across = in.tangent.xyz - smooth_normal * dot(in.tangent.xyz, smooth_normal);
        let tangent = normalize_or(across, vec3f(0.0));
        let bitangent = cross(smooth_normal, tangent) * in.tangent.w;
        let mapped = normal_in_tangent_space(uv);
        normal = normalize_or(
            tangent * mapped.x + bitangent * mapped.y + smooth_normal * mapped.z, smooth_normal);
    }
    return select(-normal, normal, front_facing);
}

// What the technique says, where the material lets shadows fall.
fn visibility_of(light: u32, receiver: Receiver) -> vec3f {
    if material_has(MATERIAL_UNSHADOWED) {
        return vec3f(1.0);
    }
    return shadow_visibility(light, receiver);
}

fn lit(surface: Surface, receiver: Receiver) -> vec3f {
    var sum = ambient(surface, view.ambient_sky, view.ambient_ground);
    for (var i = 0u; i < view.light_count; i++) {
        let light = lights[i];
        let arriving = arriving_light(light, receiver.position);
        let n_dot_l = dot(surface.normal, arriving.to_light);
        if n_dot_l > 0.0 && arriving.attenuation > 0.0 {
            let visibility = visibility_of(i, receiver);
            let illuminance = light.color * arriving.attenuation * visibility;
            sum += reflected(surface, arriving.to_light, n_dot_l) * illuminance;
        }
    }
    return sum;
}

// Grey: the factor of light AOV_LIGHT in the lit pass. Alpha 0 where the surface faces away from the light.
fn visibility_aov(receiver: Receiver) -> vec4f {
    if AOV_LIGHT >= view.light_count {
        return vec4f(0.0);
    }
    let arriving = arriving_light(lights[AOV_LIGHT], receiver.position);
    if dot(receiver.shading_normal, arriving.to_light) <= 0.0 {
        return vec4f(0.0);
    }
    let factor = dot(visibility_of(AOV_LIGHT, receiver), vec3f(1.0 / 3.0));
    return vec4f(vec3f(factor), 1.0);
}

// The technique's colours, shaded so that shapes and shadows can be made out.
fn cascade_aov(receiver: Receiver, to_camera: vec3f) -> vec4f {
    var shade = 0.4 + 0.2 * saturate(dot(receiver.shading_normal, to_camera));
    if AOV_LIGHT >= view.light_count {
        return vec4f(vec3f(shade), 1.0);
    }
    let arriving = arriving_light(lights[AOV_LIGHT], receiver.position);
    let n_dot_l = dot(receiver.shading_normal, arriving.to_light);
    if n_dot_l > 0.0 {
        shade += 0.4 * n_dot_l * dot(visibility_of(AOV_LIGHT, receiver), vec3f(1.0 / 3.0));
    }
    return vec4f(shadow_debug_color(AOV_LIGHT, receiver) * shade, 1.0);
}

@fragment
fn fs_forward(in: ForwardVertex, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    // Everything that needs the neighbouring pixels comes before the first branch that they may not share.
    let ddx_position = dpdx(in.from_camera);
    let ddy_position = dpdy(in.from_camera);
    let uv = TextureCoordinates(in.uv_first, in.uv_second);
    let color = base_color(uv, in.color);
    let metal_rough = metallic_roughness(uv);
    let open = occlusion(uv);
    let glow = emissive(uv);
    let to_camera = direction_to_camera(in.from_camera);
    let normal = shading_normal(in, uv, front_facing, to_camera);

    if material_has(MATERIAL_MASK) && is_hole(color.a) {
        discard;
    }
    let blended = material_has(MATERIAL_BLEND);
    let position = in.from_camera + view.position;
    let view_depth = view_depth_of(position);
    let flat_normal = geometric_normal(ddx_position, ddy_position, to_camera, normal);
    let receiver = Receiver(
        position,
        view_depth,
        flat_normal,
        select(0u, RECEIVER_TRANSPARENT, blended) | select(RECEIVER_BACK_FACE, 0u, front_facing),
        normal,
        in.position.xy,
        to_neighbour(position, flat_normal, view_depth, 0),
        -to_neighbour(position, flat_normal, view_depth, 1),
    );
    if AOV == AOV_VISIBILITY {
        return visibility_aov(receiver);
    }
    if AOV == AOV_CASCADE {
        return cascade_aov(receiver, to_camera);
    }
    if AOV == AOV_NORMAL {
        return vec4f(normal * 0.5 + 0.5, 1.0);
    }
    if AOV == AOV_SURFACE {
        return vec4f(receiver.position, pack_normal(receiver.geometric_normal));
    }

    // Unlit colours and glow are what the picture shows: exposure, which follows the lights, does not change them.
    var radiance = color.rgb;
    if !material_has(MATERIAL_UNLIT) {
        let surface = surface_of(color.rgb, metal_rough, open, normal, to_camera);
        radiance = lit(surface, receiver) * view.exposure + glow;
    }
    let alpha = select(1.0, saturate(color.a), blended);
    return vec4f(min(radiance, vec3f(BRIGHTEST)) * alpha, alpha);
}
