// The technique without shadows. It has no bindings.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::Receiver

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    return vec3f(1.0);
}

fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    return vec3f(1.0);
}
