// The forward lit pass: every light, every material, whatever the shadow technique.
#import shadowgraph::view::{view, direction_to_camera}
#import shadowgraph::draw::Vertex
#import shadowgraph::mesh::{MeshVertex, mesh_vertex, shading_normal, receiver_of}
#import shadowgraph::material::{
    MATERIAL_MASK, MATERIAL_BLEND, MATERIAL_UNLIT, MATERIAL_UNSHADOWED, TextureCoordinates, material_has,
    base_color, metallic_roughness, occlusion, emissive, is_hole,
}
#import shadowgraph::surface::pack_normal
#import shadowgraph::lighting::surface_of
#import shadowgraph::shade::{lit, visibility_shown, debug_shown}

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

@vertex
fn vs_forward(vertex: Vertex) -> MeshVertex {
    return mesh_vertex(vertex);
}

@fragment
fn fs_forward(in: MeshVertex, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
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
    let unshadowed = material_has(MATERIAL_UNSHADOWED);
    let receiver = receiver_of(in, ddx_position, ddy_position, normal, to_camera, front_facing);
    if AOV == AOV_VISIBILITY {
        return visibility_shown(AOV_LIGHT, receiver, unshadowed);
    }
    if AOV == AOV_CASCADE {
        return debug_shown(AOV_LIGHT, receiver, to_camera, unshadowed);
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
        radiance = lit(surface, receiver, unshadowed) * view.exposure + glow;
    }
    let alpha = select(1.0, saturate(color.a), blended);
    return vec4f(min(radiance, vec3f(BRIGHTEST)) * alpha, alpha);
}
