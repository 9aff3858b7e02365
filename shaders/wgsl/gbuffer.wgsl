// The surfaces of all that is not blended, for deferred lighting.
#import shadowgraph::view::direction_to_camera
#import shadowgraph::draw::Vertex
#import shadowgraph::mesh::{MeshVertex, mesh_vertex, shading_normal, receiver_of}
#import shadowgraph::material::{
    MATERIAL_MASK, MATERIAL_UNLIT, MATERIAL_UNSHADOWED, TextureCoordinates, material_has,
    base_color, metallic_roughness, occlusion, emissive, is_hole,
}
#import shadowgraph::surface::octahedral
#import shadowgraph::gbuffer_layout::{
    SURFACE_UNLIT, SURFACE_UNSHADOWED, SURFACE_BACK_FACE, flags_to_unorm,
}

struct Texels {
    // Linear colour, stored as sRGB; alpha: SURFACE_* bits.
    @location(0) base_color: vec4f,
    // Metallic, roughness, ambient occlusion.
    @location(1) material: vec4f,
    // The shading and the geometric normal, two 16 bit axes of the unfolded octahedron each.
    @location(2) normals: vec2u,
    // What the surface gives off.
    @location(3) glow: vec4f,
}

@vertex
fn vs_gbuffer(vertex: Vertex) -> MeshVertex {
    return mesh_vertex(vertex);
}

@fragment
fn fs_gbuffer(in: MeshVertex, @builtin(front_facing) front_facing: bool) -> Texels {
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
    let receiver = receiver_of(in, ddx_position, ddy_position, normal, to_camera, front_facing);
    let unlit = material_has(MATERIAL_UNLIT);
    let flags = select(0u, SURFACE_UNLIT, unlit)
        | select(0u, SURFACE_UNSHADOWED, material_has(MATERIAL_UNSHADOWED))
        | select(SURFACE_BACK_FACE, 0u, front_facing);
    // Unlit colours are what the picture shows, however bright: they go where glow does.
    return Texels(
        vec4f(saturate(color.rgb), flags_to_unorm(flags)),
        vec4f(metal_rough, open, 0.0),
        vec2u(pack2x16snorm(octahedral(normal)), pack2x16snorm(octahedral(receiver.geometric_normal))),
        vec4f(min(select(glow, color.rgb, unlit), vec3f(60000.0)), 0.0),
    );
}
