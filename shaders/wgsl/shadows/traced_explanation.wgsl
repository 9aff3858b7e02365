// What the technique `raytraced` says about a point: where its rays begin, and how many there are.
#define_import_path shadowgraph::explanation
#import shadowgraph::rays::ray_origin
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::traced::{TRACED_LIT, traced}
#import shadowgraph::view::view

fn explain_shadow(light: u32, receiver: Receiver) -> array<f32, 32> {
    var facts: array<f32, 32>;
    if light >= arrayLength(&traced.slots) || traced.slots[light] == TRACED_LIT {
        return facts;
    }
    let eye_m = distance(receiver.position, view.position);
    let origin = ray_origin(receiver.position, receiver.geometric_normal, eye_m, traced.max_coordinate);
    facts[0] = f32(traced.settings.rays);
    facts[1] = distance(origin, receiver.position);
    return facts;
}
