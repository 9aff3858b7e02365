// Culls the instances of a scene for several views at once, and writes an indirect draw for each batch and view.
//
//   cull_instances    tests the instances: a bit for each instance and view
//   cull_seen         the same for what the view saw in its previous frame
//   cull_hidden       the same for what the depth of that does not hide
//   rank_chunks       a prefix sum: the number of visible instances before each chunk
//   write_instances   lists the visible instances of each view, in the order of their numbers
//   write_draws       the arguments of the draws
//
// Compaction keeps the order: images are those of drawing the same instances one after the other.
#import shadowgraph::cull_boxes::{Batch, Box, is_behind, world_bounds}
#import shadowgraph::draw::Instance
#import shadowgraph::occluders::{FINEST, texel_index, top_level}

// Instances of a chunk: the size of a workgroup.
const CHUNK: u32 = 64u;
// Elements of the block of views.
const ELEMENTS: u32 = 1024u;
// Threads that share the prefix sum of a view.
const RANKING: u32 = 256u;
// Words of the arguments of an indexed indirect draw.
const ARGUMENTS: u32 = 5u;

// Whether draws begin with the instance of their arguments. If not, lists are bound at an offset for each draw.
override FIRST_INSTANCE: bool = true;

@group(0) @binding(0) var<storage, read> instances: array<Instance>;
@group(0) @binding(1) var<storage, read> batches: array<Batch>;
// Element 0: numbers of views, instances, batches, and slots of a view's list. Then one element for each view: the first plane, the
// number of planes, flags that an instance must have, and flags that it must not have. Then the planes, as the bits of
// normal and distance: a point is inside if normal . point + distance >= 0.
@group(0) @binding(2) var<uniform> views: array<vec4u, ELEMENTS>;
// Two words for each view and chunk.
@group(0) @binding(3) var<storage, read_write> visible_bits: array<u32>;
// The number of visible instances before each chunk of each view, and at the end of a view all of them.
@group(0) @binding(4) var<storage, read_write> ranks: array<u32>;
// The visible instances of each view.
@group(0) @binding(5) var<storage, read_write> visible: array<u32>;
// ARGUMENTS words for each view and batch, then the number of visible instances of each view.
@group(0) @binding(6) var<storage, read_write> draws: array<u32>;

// The members of the camera's View that are read.
struct OcclusionView {
    clip_from_world: mat4x4f,
    unread: array<vec4f, 9>,
    size_px: vec2f,
}

// A bit for each instance that the camera saw in its previous frame; 32 in a texel.
@group(1) @binding(0) var seen_before: texture_2d<u32>;
// The same for this frame.
@group(1) @binding(1) var seen_now: texture_storage_2d<r32uint, write>;
@group(1) @binding(2) var<uniform> camera: OcclusionView;
// A depth pyramid.
@group(1) @binding(3) var<storage, read> occluders: array<f32>;

// Views of cull_hidden. The instances of all views are among those of the first.
const SOLID: u32 = 0u;
const NEW: u32 = 1u;

// A bit for each view that sees an instance of the chunk.
var<workgroup> viewers: array<u32, CHUNK>;
var<workgroup> sums: array<u32, RANKING>;

fn view_count() -> u32 {
    return views[0].x;
}

fn instance_count() -> u32 {
    return views[0].y;
}

fn batch_count() -> u32 {
    return views[0].z;
}

fn slot_count() -> u32 {
    return views[0].w;
}

fn chunk_count() -> u32 {
    return (instance_count() + CHUNK - 1u) / CHUNK;
}

// The index of the first word of bits of a chunk.
fn first_word(view: u32, chunk: u32) -> u32 {
    return 2u * (view * chunk_count() + chunk);
}

// Whether the box may intersect the volume of a view; never false for one that does.
fn intersects(box: Box, view: vec4u) -> bool {
    for (var index = view.x; index < view.x + view.y; index++) {
        if is_behind(box, bitcast<vec4f>(views[index])) {
            return false;
        }
    }
    return true;
}

// The farthest depth of a texel of the pyramid.
fn occluder(level: u32, texel: vec2u) -> f32 {
    return occluders[texel_index(vec2u(camera.size_px), level, texel)];
}

// Whether all that a box may draw is behind what the pyramid was made of; never true for a box with a visible pixel.
fn is_hidden(box: Box) -> bool {
    var low = vec2f(1e9);
    var high = vec2f(-1e9);
    var nearest = 0.0;
    for (var corner = 0u; corner < 8u; corner++) {
        let side = vec3f(vec3u(corner, corner >> 1u, corner >> 2u) & vec3u(1u)) * 2.0 - 1.0;
        let clip = camera.clip_from_world * vec4f(box.center + box.axes * side, 1.0);
        // In front of the near plane, or next to it.
        if clip.w <= 0.0 || clip.z >= 0.999 * clip.w {
            return false;
        }
        let position = clip.xyz / clip.w;
        low = min(low, position.xy);
        high = max(high, position.xy);
        nearest = max(nearest, position.z);
    }
    let size_px = vec2u(camera.size_px);
    let last_px = camera.size_px - 1.0;
    // A pixel more on all sides, for rounding and jitter.
    let first = vec2u(clamp((vec2f(low.x, -high.y) * 0.5 + 0.5) * camera.size_px - 1.5, vec2f(0.0), last_px));
    let last = vec2u(clamp((vec2f(high.x, -low.y) * 0.5 + 0.5) * camera.size_px + 1.5, vec2f(0.0), last_px));
    let extent = max(last.x - first.x, last.y - first.y);
    // At most two texels wide.
    let level = clamp(32u - countLeadingZeros(extent), FINEST, top_level(size_px));
    let from_texel = first >> vec2u(level);
    let to_texel = last >> vec2u(level);
    let upper = min(occluder(level, from_texel), occluder(level, vec2u(to_texel.x, from_texel.y)));
    let farthest = min(upper, min(occluder(level, vec2u(from_texel.x, to_texel.y)), occluder(level, to_texel)));
    return nearest * (1.0 + 1e-5) + 1e-7 < farthest;
}

// What the tests of an instance find.
struct Tested {
    box: Box,
    // The views whose volume it may intersect, a bit for each.
    seen_by: u32,
}

// Tests an instance against the volumes of the views.
fn tested(number: u32) -> Tested {
    if number >= instance_count() {
        return Tested(Box(), 0u);
    }
    let instance = instances[number];
    let batch = batches[instance.flags.x];
    let box = world_bounds(instance, batch);
    let flags = batch.flags | instance.flags.y;
    var seen_by = 0u;
    for (var index = 0u; index < view_count(); index++) {
        let view = views[1u + index];
        let is_wanted = (flags & view.z) == view.z && (flags & view.w) == 0u;
        seen_by |= u32(is_wanted && intersects(box, view)) << index;
    }
    return Tested(box, seen_by);
}

// The bits of one view for half a chunk.
fn gathered(view: u32, half: u32) -> u32 {
    var bits = 0u;
    for (var place = 0u; place < 32u; place++) {
        bits |= ((viewers[32u * half + place] >> view) & 1u) << place;
    }
    return bits;
}

// The texel of the bits of half a chunk.
fn seen_texel(chunk: u32, half: u32) -> vec2u {
    let width = textureDimensions(seen_before).x;
    let word = 2u * chunk + half;
    return vec2u(word % width, word / width);
}

// Writes the bits of a chunk, from those of its threads. Threads whose index is that of a view and half take part.
fn write_bits(chunk: u32, local: u32) {
    if local < 2u * view_count() {
        visible_bits[first_word(local / 2u, chunk) + local % 2u] = gathered(local / 2u, local % 2u);
    }
}

@compute @workgroup_size(64)
fn cull_instances(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var chunk = workgroup.x; chunk < chunk_count(); chunk += workgroups.x) {
        viewers[local] = tested(chunk * CHUNK + local).seen_by;
        workgroupBarrier();
        write_bits(chunk, local);
        workgroupBarrier();
    }
}

@compute @workgroup_size(64)
fn cull_seen(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var chunk = workgroup.x; chunk < chunk_count(); chunk += workgroups.x) {
        let seen = textureLoad(seen_before, seen_texel(chunk, local / 32u), 0).x;
        viewers[local] = 0u;
        if (seen & (1u << (local % 32u))) != 0u {
            viewers[local] = tested(chunk * CHUNK + local).seen_by;
        }
        workgroupBarrier();
        write_bits(chunk, local);
        workgroupBarrier();
    }
}

@compute @workgroup_size(64)
fn cull_hidden(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    for (var chunk = workgroup.x; chunk < chunk_count(); chunk += workgroups.x) {
        let found = tested(chunk * CHUNK + local);
        viewers[local] = 0u;
        if (found.seen_by & (1u << SOLID)) != 0u && !is_hidden(found.box) {
            let seen = textureLoad(seen_before, seen_texel(chunk, local / 32u), 0).x;
            let is_new = (seen & (1u << (local % 32u))) == 0u;
            viewers[local] = found.seen_by & ~(u32(!is_new) << NEW);
        }
        workgroupBarrier();
        if local < 2u {
            let seen = gathered(SOLID, local);
            textureStore(seen_now, seen_texel(chunk, local), vec4u(seen));
        }
        write_bits(chunk, local);
        workgroupBarrier();
    }
}

fn visible_in_chunk(view: u32, chunk: u32) -> u32 {
    let word = first_word(view, chunk);
    return countOneBits(visible_bits[word]) + countOneBits(visible_bits[word + 1u]);
}

@compute @workgroup_size(256)
fn rank_chunks(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let view = workgroup.x;
    let share = (chunk_count() + RANKING - 1u) / RANKING;
    let begin = min(local * share, chunk_count());
    let end = min(begin + share, chunk_count());
    var sum = 0u;
    for (var chunk = begin; chunk < end; chunk++) {
        sum += visible_in_chunk(view, chunk);
    }
    sums[local] = sum;
    workgroupBarrier();
    for (var step = 1u; step < RANKING; step *= 2u) {
        var before = 0u;
        if local >= step {
            before = sums[local - step];
        }
        workgroupBarrier();
        sums[local] += before;
        workgroupBarrier();
    }
    var rank = sums[local] - sum;
    let first = view * (chunk_count() + 1u);
    for (var chunk = begin; chunk < end; chunk++) {
        ranks[first + chunk] = rank;
        rank += visible_in_chunk(view, chunk);
    }
    if local == RANKING - 1u {
        ranks[first + chunk_count()] = sums[local];
    }
}

// The number of visible instances of a view before one.
fn rank_of(view: u32, number: u32) -> u32 {
    let chunk = number / CHUNK;
    let place = number % CHUNK;
    var rank = ranks[view * (chunk_count() + 1u) + chunk];
    if place > 0u {
        let word = first_word(view, chunk);
        let low = visible_bits[word];
        if place < 32u {
            rank += countOneBits(low & ((1u << place) - 1u));
        } else {
            rank += countOneBits(low) + countOneBits(visible_bits[word + 1u] & ((1u << (place - 32u)) - 1u));
        }
    }
    return rank;
}

@compute @workgroup_size(64)
fn write_instances(
    @builtin(workgroup_id) workgroup: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let view = workgroup.y;
    for (var chunk = workgroup.x; chunk < chunk_count(); chunk += workgroups.x) {
        let bits = visible_bits[first_word(view, chunk) + local / 32u];
        if (bits & (1u << (local % 32u))) != 0u {
            let number = chunk * CHUNK + local;
            let batch = batches[instances[number].flags.x];
            let slot = batch.first_slot + rank_of(view, number) - rank_of(view, batch.first);
            visible[view * slot_count() + slot] = number;
        }
    }
}

@compute @workgroup_size(64)
fn write_draws(@builtin(global_invocation_id) id: vec3u) {
    let view = id.y;
    if id.x == 0u {
        draws[ARGUMENTS * batch_count() * view_count() + view] = rank_of(view, instance_count());
    }
    if id.x >= batch_count() {
        return;
    }
    let batch = batches[id.x];
    let argument = ARGUMENTS * (view * batch_count() + id.x);
    draws[argument] = batch.index_count;
    draws[argument + 1u] = rank_of(view, batch.first + batch.count) - rank_of(view, batch.first);
    draws[argument + 2u] = batch.first_index;
    draws[argument + 3u] = bitcast<u32>(batch.base_vertex);
    draws[argument + 4u] = select(0u, batch.first_slot, FIRST_INSTANCE);
}
