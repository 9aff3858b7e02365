// The light that a surface reflects from every light, with shadows.
#define_import_path shadowgraph::shade
#import shadowgraph::lights::{light_at, light_count}
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT}
#import shadowgraph::screen_occlusion::screen_occlusion
#import shadowgraph::lighting::{Surface, arriving_light, reflected}
#import shadowgraph::environment::environment_light
#import shadowgraph::light_list::next_light
#import shadowgraph::technique::{shadow_visibility, shadow_debug_color}

// The visibility from the technique; 1 for a material without shadows.
fn visibility_of(light: u32, receiver: Receiver, unshadowed: bool) -> vec3f {
    if unshadowed {
        return vec3f(1.0);
    }
    return shadow_visibility(light, receiver);
}

fn shade_surface(surface: Surface, receiver: Receiver, unshadowed: bool) -> vec3f {
    let transparent = (receiver.flags & RECEIVER_TRANSPARENT) != 0u;
    let ambient_occlusion = screen_occlusion(receiver.pixel, transparent);
    var sum = environment_light(surface) * ambient_occlusion;
    // Tested at the end: software drivers run what follows a test at the start once more, for nothing.
    var i = next_light(0u, receiver.pixel, receiver.view_depth);
    loop {
        let light = light_at(i);
        let arriving = arriving_light(light, receiver.position);
        let n_dot_l = dot(surface.normal, arriving.to_light);
        if i < light_count() && n_dot_l > 0.0 && arriving.attenuation > 0.0 {
            let visibility = visibility_of(i, receiver, unshadowed);
            let illuminance = light.color * arriving.attenuation * visibility;
            sum += reflected(surface, arriving.to_light, n_dot_l) * illuminance;
        }
        i = next_light(i + 1u, receiver.pixel, receiver.view_depth);
        if i >= light_count() {
            break;
        }
    }
    return sum;
}

// Grey: the visibility of a light in the lit pass. Alpha 0 where the surface faces away from the light.
fn visibility_output(light: u32, receiver: Receiver, unshadowed: bool) -> vec4f {
    if light >= light_count() {
        return vec4f(0.0);
    }
    let arriving = arriving_light(light_at(light), receiver.position);
    if dot(receiver.shading_normal, arriving.to_light) <= 0.0 {
        return vec4f(0.0);
    }
    let factor = dot(visibility_of(light, receiver, unshadowed), vec3f(1.0 / 3.0));
    return vec4f(vec3f(factor), 1.0);
}

// The technique's debug colours, shaded so that shapes and shadows are visible.
fn debug_output(light: u32, receiver: Receiver, to_camera: vec3f, unshadowed: bool) -> vec4f {
    var shade = 0.4 + 0.2 * saturate(dot(receiver.shading_normal, to_camera));
    if light >= light_count() {
        return vec4f(vec3f(shade), 1.0);
    }
    let arriving = arriving_light(light_at(light), receiver.position);
    let n_dot_l = dot(receiver.shading_normal, arriving.to_light);
    if n_dot_l > 0.0 {
        let factor = dot(visibility_of(light, receiver, unshadowed), vec3f(1.0 / 3.0));
        shade += 0.4 * n_dot_l * factor;
    }
    return vec4f(shadow_debug_color(light, receiver) * shade, 1.0);
}
