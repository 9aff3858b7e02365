// Culls the instances of a scene for views that the GPU has written, and writes an indirect draw for each batch: of pairs of an instance
// and a view.
//
//   clear_counts   sets the counts of a frame to 0
//   count_pairs    counts the pairs of each view and of each batch
//   choose_views   finds how many views fit into the list of pairs
//   recount_pairs  counts the pairs of batches again if not all views do
//   write_draws    the arguments of the draws
//   write_pairs    the list of pairs
//
// The order of pairs is not defined: draws must not depend on it.
#import shadowgraph::cull_boxes::{Batch, Box, is_behind, world_bounds}
#import shadowgraph::draw::Instance
#import shadowgraph::layer_views::{CASTERS_MOVING, CASTERS_STATIC, LayerViews}

struct CullLayers {
    instance_count: u32,
    batch_count: u32,
    // Flags that an instance must have, and flags that it must not have.
    required: u32,
    excluded: u32,
    // The capacity of the list of pairs.
    pair_capacity: u32,
    // The most views.
    view_capacity: u32,
    // The flags of casters that move.
    moving: u32,
    // The flags of casters that tint.
    tinting: u32,
}

const GROUP: u32 = 64u;
const RANKING: u32 = 256u;
// Words of the draw of a batch: the alignment of dynamic offsets.
const DRAW_WORDS: u32 = 64u;

override FIRST_INSTANCE: bool = true;

@group(0) @binding(0) var<storage, read> instances: array<Instance>;
@group(0) @binding(1) var<storage, read> batches: array<Batch>;
@group(0) @binding(2) var<uniform> cull: CullLayers;
@group(0) @binding(3) var<storage, read_write> layers: LayerViews;
// The pairs of each view, then those of each batch.
@group(0) @binding(4) var<storage, read_write> counts: array<atomic<u32>>;
// DRAW_WORDS for each batch: the arguments of an indexed indirect draw, and the first pair.
@group(0) @binding(5) var<storage, read_write> draws: array<u32>;
// The number of an instance and the index of a view, for each pair.
@group(0) @binding(6) var<storage, read_write> pairs: array<vec2u>;

var<workgroup> sums: array<u32, RANKING>;

// Whether the instance is drawn in a view: its box may intersect the view, or what is nearer than it. Never false for one that does.
fn is_drawn(found: Candidate, index: u32) -> bool {
    if (found.casters & layers.views[index].casters) == 0u {
        return false;
    }
    let box = found.box;
    let rows = transpose(layers.views[index].clip_from_world);
    return !is_behind(box, rows[3] + rows[0]) && !is_behind(box, rows[3] - rows[0]) && !is_behind(box, rows[3] + rows[1])
        && !is_behind(box, rows[3] - rows[1]) && !is_behind(box, rows[2]);
}

// An instance that may be drawn.
struct Candidate {
    box: Box,
    batch: u32,
    // CASTERS_*; 0: it is not drawn.
    casters: u32,
}

// The views that have a caster. Those that tint are in all views with moving casters, which may hide them.
fn casters_of(flags: u32) -> u32 {
    if (flags & cull.moving) != 0u {
        return CASTERS_MOVING;
    }
    return CASTERS_STATIC | select(0u, CASTERS_MOVING, (flags & cull.tinting) != 0u);
}

fn candidate(number: u32) -> Candidate {
    var found: Candidate;
    if number < cull.instance_count {
        let instance = instances[number];
        let batch = batches[instance.flags.x];
        let flags = batch.flags | instance.flags.y;
        if (flags & cull.required) == cull.required && (flags & cull.excluded) == 0u {
            found.casters = casters_of(flags);
        }
        found.batch = instance.flags.x;
        found.box = world_bounds(instance, batch);
    }
    return found;
}

fn view_count() -> u32 {
    return min(layers.count, cull.view_capacity);
}

@compute @workgroup_size(64)
fn clear_counts(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var index = id.x; index < arrayLength(&counts); index += GROUP * groups.x) {
        atomicStore(&counts[index], 0u);
    }
}

@compute @workgroup_size(64)
fn count_pairs(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var number = id.x; number < cull.instance_count; number += GROUP * groups.x) {
        let found = candidate(number);
        if (found.casters & layers.casters) == 0u {
            continue;
        }
        var of_batch = 0u;
        for (var index = 0u; index < view_count(); index++) {
            if is_drawn(found, index) {
                atomicAdd(&counts[index], 1u);
                of_batch++;
            }
        }
        if of_batch > 0u {
            atomicAdd(&counts[cull.view_capacity + found.batch], of_batch);
        }
    }
}

// Returns the sum of `own` over the threads up to this one.
fn running_sum(local: u32, own: u32) -> u32 {
    sums[local] = own;
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
    return sums[local];
}

@compute @workgroup_size(256)
fn choose_views(@builtin(local_invocation_index) local: u32) {
    let share = (view_count() + RANKING - 1u) / RANKING;
    let begin = min(local * share, view_count());
    let end = min(begin + share, view_count());
    var own = 0u;
    for (var index = begin; index < end; index++) {
        own += atomicLoad(&counts[index]);
    }
    let after = running_sum(local, own);
    // The views of the last thread whose first ones fit.
    var sum = after - own;
    var last = begin;
    while last < end && sum + atomicLoad(&counts[last]) <= cull.pair_capacity {
        sum += atomicLoad(&counts[last]);
        last++;
    }
    let fits_before = after - own <= cull.pair_capacity;
    workgroupBarrier();
    sums[local] = select(0u, last, fits_before && begin < end);
    workgroupBarrier();
    if local == 0u {
        var drawn = 0u;
        for (var thread = 0u; thread < RANKING; thread++) {
            drawn = max(drawn, sums[thread]);
        }
        layers.drawn = drawn;
    }
}

@compute @workgroup_size(64)
fn recount_pairs(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    if layers.drawn == view_count() {
        return;
    }
    for (var number = id.x; number < cull.instance_count; number += GROUP * groups.x) {
        let found = candidate(number);
        if (found.casters & layers.casters) == 0u {
            continue;
        }
        var dropped = 0u;
        for (var index = layers.drawn; index < view_count(); index++) {
            dropped += u32(is_drawn(found, index));
        }
        if dropped > 0u {
            atomicSub(&counts[cull.view_capacity + found.batch], dropped);
        }
    }
}

@compute @workgroup_size(256)
fn write_draws(@builtin(local_invocation_index) local: u32) {
    let share = (cull.batch_count + RANKING - 1u) / RANKING;
    let begin = min(local * share, cull.batch_count);
    let end = min(begin + share, cull.batch_count);
    var own = 0u;
    for (var index = begin; index < end; index++) {
        own += atomicLoad(&counts[cull.view_capacity + index]);
    }
    var first = running_sum(local, own) - own;
    for (var index = begin; index < end; index++) {
        let batch = batches[index];
        let count = atomicLoad(&counts[cull.view_capacity + index]);
        let word = DRAW_WORDS * index;
        draws[word] = batch.index_count;
        draws[word + 1u] = count;
        draws[word + 2u] = batch.first_index;
        draws[word + 3u] = bitcast<u32>(batch.base_vertex);
        draws[word + 4u] = select(0u, first, FIRST_INSTANCE);
        draws[word + 5u] = first;
        // From here on the next free pair of the batch.
        atomicStore(&counts[cull.view_capacity + index], first);
        first += count;
    }
    if local == RANKING - 1u {
        layers.pairs = first;
    }
}

@compute @workgroup_size(64)
fn write_pairs(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var number = id.x; number < cull.instance_count; number += GROUP * groups.x) {
        let found = candidate(number);
        if (found.casters & layers.casters) == 0u {
            continue;
        }
        for (var index = 0u; index < layers.drawn; index++) {
            if is_drawn(found, index) {
                let pair = atomicAdd(&counts[cull.view_capacity + found.batch], 1u);
                pairs[pair] = vec2u(number, index);
            }
        }
    }
}
