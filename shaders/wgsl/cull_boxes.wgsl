// The bounds of instances, for passes that cull them.
#define_import_path shadowgraph::cull_boxes
#import shadowgraph::draw::Instance

// Relative error of a distance to a plane.
const ROUNDING: f32 = 4e-6;

// Neighbours in the order of draws that share all but the instance. 64 bytes.
struct Batch {
    // Bounds in the space of the instance.
    center: vec3f,
    // The number of the first instance.
    first: u32,
    half_size: vec3f,
    // Number of instances.
    count: u32,
    flags: u32,
    first_index: u32,
    index_count: u32,
    base_vertex: i32,
    // The place of the first visible instance in the list of a view.
    first_slot: u32,
    padding: array<u32, 3>,
}

// A box with axes that need not be orthogonal.
struct Box {
    center: vec3f,
    axes: mat3x3f,
}

fn world_bounds(instance: Instance, batch: Batch) -> Box {
    let center = vec4f(batch.center, 1.0);
    let rows = array(instance.row_x, instance.row_y, instance.row_z);
    let axes = mat3x3f(
        vec3f(rows[0].x, rows[1].x, rows[2].x) * batch.half_size.x,
        vec3f(rows[0].y, rows[1].y, rows[2].y) * batch.half_size.y,
        vec3f(rows[0].z, rows[1].z, rows[2].z) * batch.half_size.z,
    );
    return Box(vec3f(dot(rows[0], center), dot(rows[1], center), dot(rows[2], center)), axes);
}

// Whether the box is behind a plane: a point is in front of it if normal . point + distance >= 0. Never true for one that touches it.
fn is_behind(box: Box, plane: vec4f) -> bool {
    let reach = abs(plane.xyz * box.axes);
    let radius = reach.x + reach.y + reach.z;
    let terms = dot(abs(plane.xyz), abs(box.center)) + abs(plane.w) + radius;
    return dot(plane.xyz, box.center) + plane.w + radius < -ROUNDING * terms;
}
