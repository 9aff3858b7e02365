// Motion vectors of meshes: the motion from a surface's position in this frame back to that in the previous frame, pixels, y down,
// without jitter.
#import shadowgraph::draw::{Vertex, world_position, previous_world_position, clip_position}

// The used member of a View.
struct VelocityView {
    clip_from_world: mat4x4f,
}

// The camera without jitter. 160 bytes.
struct ViewMotion {
    // From positions relative to `eye` to clip space.
    clip_from_relative: mat4x4f,
    previous_clip_from_relative: mat4x4f,
    // The camera, in world space.
    eye: vec3f,
    px_from_ndc: vec2f,
}

@group(0) @binding(0) var<storage, read> velocity_view: VelocityView;
@group(0) @binding(1) var<storage, read> view_motion: ViewMotion;

// What was behind the camera comes from far outside of the image.
const OUTSIDE = vec2f(32768.0);

struct VelocityVertex {
    @invariant @builtin(position) position: vec4f,
    // x, y and w in the clip space of this frame and of the previous one.
    @location(0) current: vec3f,
    @location(1) previous: vec3f,
}

@vertex
fn vs_velocity(vertex: Vertex, @location(6) previous_local: vec3f) -> VelocityVertex {
    let position = world_position(vertex.instance, vertex.position);
    let previous_position = previous_world_position(vertex.instance, previous_local);
    let current = view_motion.clip_from_relative * vec4f(position - view_motion.eye, 1.0);
    let previous = view_motion.previous_clip_from_relative * vec4f(previous_position - view_motion.eye, 1.0);
    return VelocityVertex(clip_position(velocity_view.clip_from_world, position), current.xyw, previous.xyw);
}

@fragment
fn fs_velocity(in: VelocityVertex) -> @location(0) vec2f {
    if in.previous.z <= 0.0 {
        return OUTSIDE;
    }
    return (in.previous.xy / in.previous.z - in.current.xy / in.current.z) * view_motion.px_from_ndc;
}
