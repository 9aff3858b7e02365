// Calls the function of a technique that explains points: compiling this checks that it exists with the right signature.
#import shadowgraph::explanation::explain_shadow
#import shadowgraph::receiver::Receiver

@compute @workgroup_size(1)
fn cs_check_explanation() {
    let values: array<f32, 32> = explain_shadow(0u, Receiver());
}
