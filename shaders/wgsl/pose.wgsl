// Skins and morph targets: computes the vertices of deformed meshes, in the space of their instances, and their
// positions in the previous frame.

// Words of a vertex, and of the displacement of one.
const VERTEX_WORDS = 16u;
const DELTA_WORDS = 9u;
const NO_JOB = 0xffffffffu;

// A deformed mesh. All numbers are those of elements of the whole buffers.
struct Job {
    rest_vertex: u32,
    posed_vertex: u32,
    vertex_count: u32,
    first_influence: u32,
    // 0 without skin.
    influences_per_vertex: u32,
    first_joint: u32,
    first_delta: u32,
    first_weight: u32,
    weight_count: u32,
    // Those of the previous frame.
    previous_first_joint: u32,
    previous_first_weight: u32,
}

// Rows of the affine matrix from the space of the mesh to that of the instance.
struct Joint {
    row_x: vec4f,
    row_y: vec4f,
    row_z: vec4f,
}

struct Influence {
    joint: u32,
    weight: f32,
}

@group(0) @binding(0) var<storage, read> jobs: array<Job>;
// The job of each workgroup, and the first of its vertices.
@group(0) @binding(1) var<storage, read> workgroups: array<vec2u>;
@group(0) @binding(2) var<storage, read> joints: array<Joint>;
@group(0) @binding(3) var<storage, read> weights: array<f32>;
@group(0) @binding(4) var<storage, read> rest: array<f32>;
@group(0) @binding(5) var<storage, read> influences: array<Influence>;
@group(0) @binding(6) var<storage, read> deltas: array<f32>;
@group(0) @binding(7) var<storage, read_write> posed: array<f32>;

fn rest_vector(word: u32) -> vec3f {
    return vec3f(rest[word], rest[word + 1u], rest[word + 2u]);
}

fn delta_vector(word: u32) -> vec3f {
    return vec3f(deltas[word], deltas[word + 1u], deltas[word + 2u]);
}

fn write_vector(word: u32, vector: vec3f) {
    posed[word] = vector.x;
    posed[word + 1u] = vector.y;
    posed[word + 2u] = vector.z;
}

// `fallback` for a direction of length 0.
fn normalize_or(direction: vec3f, fallback: vec3f) -> vec3f {
    let length_squared = dot(direction, direction);
    return select(fallback, direction * inverseSqrt(length_squared), length_squared > 1e-30);
}

// The displacement of a vertex: word 0 of a delta is the position, 3 the normal, 6 the tangent.
fn displacement(job: Job, first_weight: u32, vertex: u32, word: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < job.weight_count; i++) {
        let weight = weights[first_weight + i];
        if weight != 0.0 {
            let delta = job.first_delta + i * job.vertex_count + vertex;
            sum += weight * delta_vector(delta * DELTA_WORDS + word);
        }
    }
    return sum;
}

// The weighted sum of the transforms of a vertex's joints.
fn skin_transform(job: Job, first_joint: u32, vertex: u32) -> Joint {
    var sum = Joint(vec4f(0.0), vec4f(0.0), vec4f(0.0));
    let first = job.first_influence + vertex * job.influences_per_vertex;
    for (var i = 0u; i < job.influences_per_vertex; i++) {
        let influence = influences[first + i];
        let joint = joints[first_joint + influence.joint];
        sum.row_x += influence.weight * joint.row_x;
        sum.row_y += influence.weight * joint.row_y;
        sum.row_z += influence.weight * joint.row_z;
    }
    return sum;
}

fn transform_point(m: Joint, position: vec3f) -> vec3f {
    let p = vec4f(position, 1.0);
    return vec3f(dot(m.row_x, p), dot(m.row_y, p), dot(m.row_z, p));
}

fn transform_direction(m: Joint, direction: vec3f) -> vec3f {
    return vec3f(dot(m.row_x.xyz, direction), dot(m.row_y.xyz, direction), dot(m.row_z.xyz, direction));
}

// Cofactors, as in `world_normal` of draw.wgsl.
fn transform_normal(m: Joint, normal: vec3f) -> vec3f {
    let cofactor_x = cross(m.row_y.xyz, m.row_z.xyz);
    let cofactor_y = cross(m.row_z.xyz, m.row_x.xyz);
    let cofactor_z = cross(m.row_x.xyz, m.row_y.xyz);
    let transformed = vec3f(dot(cofactor_x, normal), dot(cofactor_y, normal), dot(cofactor_z, normal));
    return select(transformed, -transformed, dot(m.row_x.xyz, cofactor_x) < 0.0);
}

@compute @workgroup_size(64)
fn cs_pose(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) count: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let work = workgroups[workgroup.y * count.x + workgroup.x];
    if work.x == NO_JOB {
        return;
    }
    let job = jobs[work.x];
    let vertex = work.y + lane;
    if vertex >= job.vertex_count {
        return;
    }
    let source = (job.rest_vertex + vertex) * VERTEX_WORDS;
    let rest_position = rest_vector(source);
    let rest_normal = rest_vector(source + 3u);
    let rest_tangent = rest_vector(source + 6u);
    var position = rest_position + displacement(job, job.first_weight, vertex, 0u);
    var normal = rest_normal + displacement(job, job.first_weight, vertex, 3u);
    var tangent = rest_tangent + displacement(job, job.first_weight, vertex, 6u);
    if job.influences_per_vertex > 0u {
        let transform = skin_transform(job, job.first_joint, vertex);
        position = transform_point(transform, position);
        normal = transform_normal(transform, normal);
        tangent = transform_direction(transform, tangent);
    }
    let target_word = (job.posed_vertex + vertex) * VERTEX_WORDS;
    write_vector(target_word, position);
    write_vector(target_word + 3u, normalize_or(normal, rest_normal));
    write_vector(target_word + 6u, normalize_or(tangent, rest_tangent));
    if job.previous_first_joint != job.first_joint || job.previous_first_weight != job.first_weight {
        position = rest_position + displacement(job, job.previous_first_weight, vertex, 0u);
        if job.influences_per_vertex > 0u {
            position = transform_point(skin_transform(job, job.previous_first_joint, vertex), position);
        }
    }
    // The positions in the previous frame follow the vertices.
    write_vector(target_word + job.vertex_count * VERTEX_WORDS, position);
}
