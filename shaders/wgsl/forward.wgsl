// The forward lit pass: all lights and materials, with any shadow technique.
#import shadowgraph::view::view
#import shadowgraph::draw::Vertex
#import shadowgraph::mesh::{MeshVertex, mesh_vertex, mesh_surface}
#import shadowgraph::material::{MATERIAL_BLEND, MATERIAL_TRANSMIT, MATERIAL_UNLIT, MATERIAL_UNSHADOWED, material_has}
#import shadowgraph::surface::pack_normal
#import shadowgraph::lighting::surface_of
#import shadowgraph::shade::{shade_surface, visibility_output, debug_output}

// The output: 0 light, 1 the visibility of light AOV_LIGHT, 2 the technique's debug colours for that light, 3 the shading
// normal, 4 the surface.
override AOV: u32 = 0u;
override AOV_LIGHT: u32 = 0u;

const AOV_VISIBILITY: u32 = 1u;
const AOV_CASCADE: u32 = 2u;
const AOV_NORMAL: u32 = 3u;
const AOV_SURFACE: u32 = 4u;

// Half floats end at 65504.
const MAX_RADIANCE: f32 = 60000.0;

@vertex
fn vs_forward(vertex: Vertex) -> MeshVertex {
    return mesh_vertex(vertex);
}

@fragment
fn fs_forward(in: MeshVertex, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    let mesh = mesh_surface(in, front_facing);
    let receiver = mesh.receiver;
    let blended = material_has(MATERIAL_BLEND);
    let unshadowed = material_has(MATERIAL_UNSHADOWED);
    if AOV == AOV_VISIBILITY {
        return visibility_output(AOV_LIGHT, receiver, unshadowed);
    }
    if AOV == AOV_CASCADE {
        return debug_output(AOV_LIGHT, receiver, mesh.to_camera, unshadowed);
    }
    if AOV == AOV_NORMAL {
        return vec4f(mesh.normal * 0.5 + 0.5, 1.0);
    }
    if AOV == AOV_SURFACE {
        return vec4f(receiver.position, pack_normal(receiver.geometric_normal));
    }

    // Exposure adapts to the lights, so it does not apply to unlit colours and emission.
    var radiance = mesh.color.rgb;
    let alpha = select(1.0, saturate(mesh.color.a), blended);
    let transmits = material_has(MATERIAL_TRANSMIT);
    if !material_has(MATERIAL_UNLIT) {
        var surface = surface_of(mesh.color.rgb, mesh.metal_rough, mesh.ambient_occlusion, mesh.normal, mesh.to_camera);
        surface.diffuse_color *= select(1.0, alpha, transmits);
        radiance = shade_surface(surface, receiver, unshadowed) * view.exposure + mesh.emission;
    }
    radiance = min(radiance, vec3f(MAX_RADIANCE));
    if transmits {
        // Blending has one factor for all channels: that of the mean of the tint.
        return vec4f(radiance, 1.0 - (1.0 - alpha) * dot(saturate(mesh.color.rgb), vec3f(1.0 / 3.0)));
    }
    return vec4f(radiance * alpha, alpha);
}
