// Marks the pages of virtual shadow maps that visible surfaces are read from.
#import shadowgraph::float_order::{decoded, encoded}
#import shadowgraph::view::{pixels_per_metre, view_depth_of}
#import shadowgraph::surface::unpack_normal
#import shadowgraph::shadows::cube::cube_face
#import shadowgraph::shadows::pages::{
    Level, Page, PAGE_TEXELS, Projection, biased, entry_of, has_entry, in_level, page_of, project, wanted_level,
}
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::pages_state::{ListedPage, counters, levels, lists, marks, pages_frame, projections}

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var<storage, read> shadow_lights: array<ShadowLight>;

// Pixels along a workgroup.
const GROUP_SIZE: u32 = 8u;
// Distance to the edge of a page, texels, at which its neighbour is marked too: the pass that shades computes the position again.
const MARGIN_TEXELS: f32 = 1.0;
// Lights that are tested together.
const BATCH: u32 = 64u;

// Bounds of the positions of the workgroup; floats are encoded as integers of the same order.
var<workgroup> lowest: array<atomic<u32>, 3>;
var<workgroup> highest: array<atomic<u32>, 3>;
// The lights of a batch that may reach them.
var<workgroup> reaching: array<u32, BATCH>;
var<workgroup> reaching_count: atomic<u32>;

fn request(page: Page, projection: Projection, level: Level, bit: u32) {
    if !has_entry(level, page.place) {
        return;
    }
    let entry = entry_of(projection, level, page.place);
    if (atomicLoad(&marks[2u * entry]) & bit) != 0u {
        return;
    }
    if atomicOr(&marks[2u * entry], bit) == 0u {
        let index = atomicAdd(&counters.requested, 1u);
        if index < pages_frame.request_capacity {
            lists[index] = ListedPage(page, entry, 0u);
        }
    }
}

fn mark(index: u32, light: ShadowLight, position: vec3f, normal: vec3f, pixel_m: f32) {
    let projection = projections[index];
    let point = project(projection, position);
    if point.w <= 0.0 {
        return;
    }
    let wanted = wanted_level(projection, point, pixel_m * exp2(pages_frame.level_bias));
    let number = u32(wanted);
    let level = levels[projection.first_level + number];
    let moved = project(projection, biased(projection, light, number, position, normal));
    let at = in_level(moved, number, level);
    let depth = moved.position.z * level.depth_scale + level.depth_offset;
    if !(depth > 0.0 && depth < 1.0) {
        return;
    }
    let bit = 1u << u32(4.0 * fract(wanted));
    let place = page_of(at);
    request(Page(index, number, place), projection, level, bit);
    // The neighbours next to an edge or a corner.
    let first = page_of(at - MARGIN_TEXELS);
    let last = page_of(at + MARGIN_TEXELS);
    if any(first != last) {
        for (var corner = 0u; corner < 4u; corner++) {
            let other = vec2i(select(first.x, last.x, (corner & 1u) == 1u), select(first.y, last.y, corner >= 2u));
            if any(other != place) {
                request(Page(index, number, other), projection, level, bit);
            }
        }
    }
}

// Whether a light may reach the positions of the workgroup.
fn reaches(index: u32) -> bool {
    let light = shadow_lights[index];
    if light.view_count == 0u {
        return false;
    }
    let projection = projections[light.first_view];
    if projection.is_perspective == 0u {
        return true;
    }
    var offset: vec3f;
    for (var axis = 0u; axis < 3u; axis++) {
        let low = decoded(atomicLoad(&lowest[axis]));
        let high = decoded(atomicLoad(&highest[axis]));
        offset[axis] = projection.center[axis] - clamp(projection.center[axis], low, high);
    }
    return dot(offset, offset) < projection.range_m * projection.range_m;
}

@compute @workgroup_size(8, 8)
fn cs_mark(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) local: u32) {
    if local < 3u {
        atomicStore(&lowest[local], 0xffffffffu);
        atomicStore(&highest[local], 0u);
    }
    workgroupBarrier();
    var surface = vec4f(0.0);
    if all(id.xy < textureDimensions(surfaces)) {
        surface = textureLoad(surfaces, id.xy, 0);
    }
    let is_seen = surface.w >= 1.0;
    let position = surface.xyz;
    let normal = unpack_normal(surface.w);
    let view_depth = view_depth_of(position);
    let pixel_m = 1.0 / pixels_per_metre(view_depth);
    if is_seen {
        for (var axis = 0u; axis < 3u; axis++) {
            atomicMin(&lowest[axis], encoded(position[axis]));
            atomicMax(&highest[axis], encoded(position[axis]));
        }
    }
    for (var first = 0u; first < pages_frame.light_count; first += BATCH) {
        if local == 0u {
            atomicStore(&reaching_count, 0u);
        }
        workgroupBarrier();
        if first + local < pages_frame.light_count && reaches(first + local) {
            reaching[atomicAdd(&reaching_count, 1u)] = first + local;
        }
        workgroupBarrier();
        let count = select(0u, atomicLoad(&reaching_count), is_seen);
        for (var i = 0u; i < count; i++) {
            let light = shadow_lights[reaching[i]];
            let first_projection = light.first_view;
            let center = projections[first_projection].center;
            let is_directional = projections[first_projection].is_perspective == 0u;
            let to_light = select(center - position, projections[first_projection].to_light, is_directional);
            let fades_at = select(view_depth, distance(light.eye, position), light.fades_by_radius == 1u);
            if fades_at >= light.fade_end_m || dot(normal, to_light) <= -0.05 * length(to_light) {
                continue;
            }
            let face = select(0u, cube_face(-to_light), light.view_count > 1u);
            mark(first_projection + face, light, position, normal, pixel_m);
        }
        workgroupBarrier();
    }
}
