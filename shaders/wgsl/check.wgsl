// Calls every function of a technique: compiling this checks that they exist with the right signatures.
#import shadowgraph::receiver::Receiver
#import shadowgraph::technique::{shadow_visibility, shadow_debug_color}

@compute @workgroup_size(1)
fn cs_check() {
    let receiver = Receiver();
    let visibility: vec3f = shadow_visibility(0u, receiver);
    let color: vec3f = shadow_debug_color(0u, receiver);
}
