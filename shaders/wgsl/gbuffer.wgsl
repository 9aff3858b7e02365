// The G-buffer pass for deferred lighting, for all surfaces that are not blended.
#import shadowgraph::draw::Vertex
#import shadowgraph::mesh::{MeshVertex, mesh_vertex, mesh_surface}
#import shadowgraph::material::{MATERIAL_UNLIT, MATERIAL_UNSHADOWED, material_has}
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
    // Emitted radiance.
    @location(3) emissive: vec4f,
}

@vertex
fn vs_gbuffer(vertex: Vertex) -> MeshVertex {
    return mesh_vertex(vertex);
}

@fragment
fn fs_gbuffer(in: MeshVertex, @builtin(front_facing) front_facing: bool) -> Texels {
    let surface = mesh_surface(in, front_facing);
    let unlit = material_has(MATERIAL_UNLIT);
    let flags = select(0u, SURFACE_UNLIT, unlit)
        | select(0u, SURFACE_UNSHADOWED, material_has(MATERIAL_UNSHADOWED))
        | select(SURFACE_BACK_FACE, 0u, front_facing);
    // Unlit colours are output unchanged, so they are stored as emission.
    return Texels(
        vec4f(saturate(surface.color.rgb), flags_to_unorm(flags)),
        vec4f(surface.metal_rough, surface.ambient_occlusion, 0.0),
        vec2u(
            pack2x16snorm(octahedral(surface.normal)),
            pack2x16snorm(octahedral(surface.receiver.geometric_normal)),
        ),
        vec4f(min(select(surface.emission, surface.color.rgb, unlit), vec3f(60000.0)), 0.0),
    );
}
