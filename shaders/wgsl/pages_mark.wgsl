// Marks the pages of virtual shadow maps that visible surfaces are read from. A thread has a block of pixels: it reads each light once, and
// tests the bounds of the block instead of its pixels where these cannot differ by more than a page.
#import shadowgraph::float_order::{decoded, encoded}
#import shadowgraph::view::{direction_to_camera, pixels_per_metre, view, view_depth_of, view_ray}
#import shadowgraph::surface::{pack_normal, unpack_normal}
#import shadowgraph::shadows::cube::cube_face
#import shadowgraph::shadows::pages::{
    Level, MapPoint, Page, PAGE_TEXELS, Projection, biased, direction_to_light, entry_of, has_entry, in_level, narrowing, page_of, project,
    wanted_level,
}
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::pages_state::{ListedPage, counters, levels, lists, marks, pages_frame, projections, words_of}

@group(2) @binding(0) var surfaces: texture_2d<f32>;
@group(2) @binding(1) var<storage, read> shadow_lights: array<ShadowLight>;

// Pixels along the block of a thread.
const BLOCK: u32 = 4u;
// Distance to the edge of a page, texels, at which its neighbour is marked too: the pass that shades computes the position again.
const MARGIN_TEXELS: f32 = 1.0;
// The cosine between normal and light below which a surface is not lit, with a margin.
const LEAST_COSINE: f32 = -0.05;
// The largest difference of normals, along an axis, in a block that is tested as a plane, and the error of its levels.
const PLANE_NORMALS: f32 = 0.01;
const PLANE_LEVELS: f32 = 0.05;
// The fall of rays, metres a metre, at which the ground is taken to be infinitely far.
const LEAST_FALL: f32 = 1e-3;
// Lights that are tested together.
const BATCH: u32 = 64u;

// Bounds of the positions of the workgroup; floats are encoded as integers of the same order.
var<workgroup> lowest: array<atomic<u32>, 3>;
var<workgroup> highest: array<atomic<u32>, 3>;
// The lights of a batch that may reach them.
var<workgroup> reaching: array<u32, BATCH>;
var<workgroup> reaching_count: atomic<u32>;

// Bounds of the visible surfaces of a block of pixels.
struct Block {
    first_px: vec2u,
    is_seen: bool,
    position_min: vec3f,
    position_max: vec3f,
    normal_min: vec3f,
    normal_max: vec3f,
    // View depths.
    nearest: f32,
    farthest: f32,
}

fn block_at(first_px: vec2u) -> Block {
    let huge = vec3f(3e38);
    var block = Block(first_px, false, huge, -huge, huge, -huge, 3e38, -3e38);
    for (var i = 0u; i < BLOCK * BLOCK; i++) {
        let surface = surface_at(first_px + vec2u(i % BLOCK, i / BLOCK));
        if surface.w >= 1.0 {
            let normal = unpack_normal(surface.w);
            let depth = view_depth_of(surface.xyz);
            block.is_seen = true;
            block.position_min = min(block.position_min, surface.xyz);
            block.position_max = max(block.position_max, surface.xyz);
            block.normal_min = min(block.normal_min, normal);
            block.normal_max = max(block.normal_max, normal);
            block.nearest = min(block.nearest, depth);
            block.farthest = max(block.farthest, depth);
        }
    }
    return block;
}

// 0 in w: nothing is visible.
fn surface_at(pixel: vec2u) -> vec4f {
    if any(pixel >= textureDimensions(surfaces)) {
        return vec4f(0.0);
    }
    let surface = textureLoad(surfaces, pixel, 0);
    if surface.w < 1.0 && pages_frame.has_ground == 1u {
        return ground_at(pixel);
    }
    return surface;
}

// The point of the ground that a pixel shows.
fn ground_at(pixel: vec2u) -> vec4f {
    let ray = view_ray(vec2f(pixel) + 0.5);
    let fall = -ray.direction.y;
    let above = ray.start.y - pages_frame.ground_height;
    if above <= 0.0 || fall <= LEAST_FALL {
        return vec4f(0.0);
    }
    return vec4f(ray.start + ray.direction * (above / fall), pack_normal(vec3f(0.0, 1.0, 0.0)));
}

// The bounds of a linear function in a block.
fn span_in(block: Block, row: vec4f) -> vec2f {
    let center = 0.5 * (block.position_min + block.position_max);
    let reach = dot(abs(row.xyz), 0.5 * (block.position_max - block.position_min));
    return dot(row, vec4f(center, 1.0)) + vec2f(-reach, reach);
}

// The bounds of a quotient; the divisor is positive.
fn divided(span: vec2f, divisor: vec2f) -> vec2f {
    return vec2f(min(span.x / divisor.x, span.x / divisor.y), max(span.y / divisor.x, span.y / divisor.y));
}

// Whether all of a block is in the dark half of a light, beyond its range, or beyond the distance of shadows.
fn is_out_of_reach(projection: Projection, light: ShadowLight, block: Block) -> bool {
    let center = 0.5 * (block.position_min + block.position_max);
    let radius = 0.5 * length(block.position_max - block.position_min);
    let fades_at = select(block.nearest, distance(light.eye, center) - radius, light.fades_by_radius == 1u);
    if fades_at >= light.fade_end_m {
        return true;
    }
    var to_light = projection.to_light;
    var spread = 0.0;
    if projection.is_perspective == 1u {
        let offset = projection.center - center;
        let length = length(offset);
        if length - radius > projection.range_m {
            return true;
        }
        // The directions to the light from other points of the block.
        spread = 2.0 * radius / max(length, 1e-6);
        to_light = offset / max(length, 1e-6);
    }
    let highest_cosine = dot(max(block.normal_min * to_light, block.normal_max * to_light), vec3f(1.0));
    return highest_cosine + spread <= LEAST_COSINE;
}

fn request(page: Page, projection: Projection, level: Level, bits: u32) {
    if !has_entry(level, page.place) {
        return;
    }
    let entry = entry_of(projection, level, page.place);
    if (atomicLoad(&marks[words_of(entry)]) & bits) == bits {
        return;
    }
    if atomicOr(&marks[words_of(entry)], bits) == 0u {
        let index = atomicAdd(&counters.requested, 1u);
        if index < pages_frame.request_capacity {
            lists[index] = ListedPage(page, entry, 0u);
        } else {
            atomicStore(&marks[words_of(entry)], 0u);
        }
    }
}

// Requests the pages of a rectangle of a level, texels. Returns false without a request if it has more than two along a side.
fn request_all(index: u32, number: u32, corners: array<vec2f, 2>, bits: u32) -> bool {
    let first = page_of(corners[0]);
    let last = page_of(corners[1]);
    if any(last - first > vec2i(1)) {
        return false;
    }
    let projection = projections[index];
    let level = levels[projection.first_level + number];
    for (var y = first.y; y <= last.y; y++) {
        for (var x = first.x; x <= last.x; x++) {
            request(Page(index, number, vec2i(x, y)), projection, level, bits);
        }
    }
    return true;
}

// The quarter of its level, 0 to 3, that a pixel is read from.
fn quarter_of(level: f32) -> u32 {
    return u32(4.0 * fract(level));
}

// Marks all pages of a block by its bounds. Returns false if its pixels need to be tested.
fn mark_block(index: u32, light: ShadowLight, block: Block) -> bool {
    if any(block.normal_max - block.normal_min > vec3f(PLANE_NORMALS)) {
        return false;
    }
    let projection = projections[index];
    var w = vec2f(1.0);
    var expansion = light.normal_bias_texels + MARGIN_TEXELS;
    if projection.is_perspective == 1u {
        w = span_in(block, projection.w);
        expansion += light.normal_bias_texels;
        if w.x <= 0.0 {
            return w.y <= 0.0;
        }
    }
    let x = divided(span_in(block, projection.x), w);
    let y = divided(span_in(block, projection.y), w);
    let z = divided(span_in(block, projection.z), w);
    let low = vec3f(x.x, y.x, z.x);
    let high = vec3f(x.y, y.y, z.y);
    let is_far_side = abs(high - projection.center) > abs(low - projection.center);
    let finer = MapPoint(clamp(projection.center, low, high), w.y);
    let coarser = MapPoint(select(low, high, is_far_side), w.x);
    let position = 0.5 * (block.position_min + block.position_max);
    let normal = normalize(block.normal_min + block.normal_max);
    let to_camera = direction_to_camera(position - view.position);
    let bias = pages_frame.level_bias + narrowing(normal, to_camera, direction_to_light(projection, position));
    let widths = exp2(bias + vec2f(-PLANE_LEVELS, PLANE_LEVELS));
    let finest = wanted_level(projection, finer, widths.x / pixels_per_metre(block.nearest));
    let coarsest = wanted_level(projection, coarser, widths.y / pixels_per_metre(block.farthest));
    let first = u32(finest);
    let last = u32(coarsest);
    if last > first + 1u {
        return false;
    }
    for (var number = first; number <= last; number++) {
        let level = levels[projection.first_level + number];
        let depths = z * level.depth_scale + level.depth_offset;
        if depths.y <= 0.0 || depths.x >= 1.0 {
            continue;
        }
        let begin = select(0u, quarter_of(finest), number == first);
        let end = select(3u, quarter_of(coarsest), number == last);
        let bits = (0xfu << begin) & (0xfu >> (3u - end));
        let corners = array(
            in_level(MapPoint(low, 1.0), number, level) - expansion, in_level(MapPoint(high, 1.0), number, level) + expansion,
        );
        if !request_all(index, number, corners, bits) {
            return false;
        }
    }
    return true;
}

fn mark(index: u32, light: ShadowLight, position: vec3f, normal: vec3f, pixel_m: f32) {
    let projection = projections[index];
    let point = project(projection, position);
    if point.w <= 0.0 {
        return;
    }
    let finer = narrowing(normal, direction_to_camera(position - view.position), direction_to_light(projection, position));
    let wanted = wanted_level(projection, point, pixel_m * exp2(pages_frame.level_bias + finer));
    let number = u32(wanted);
    let level = levels[projection.first_level + number];
    let moved = project(projection, biased(projection, light, number, position, normal));
    let at = in_level(moved, number, level);
    let depth = moved.position.z * level.depth_scale + level.depth_offset;
    if depth > 0.0 && depth < 1.0 {
        _ = request_all(index, number, array(at - MARGIN_TEXELS, at + MARGIN_TEXELS), 1u << quarter_of(wanted));
    }
}

// Marks the pages of each pixel of a block.
fn mark_pixels(light: ShadowLight, block: Block) {
    let center = projections[light.first_view].center;
    let is_directional = projections[light.first_view].is_perspective == 0u;
    for (var i = 0u; i < BLOCK * BLOCK; i++) {
        let surface = surface_at(block.first_px + vec2u(i % BLOCK, i / BLOCK));
        let normal = unpack_normal(surface.w);
        let to_light = select(center - surface.xyz, projections[light.first_view].to_light, is_directional);
        let depth = view_depth_of(surface.xyz);
        let fades_at = select(depth, distance(light.eye, surface.xyz), light.fades_by_radius == 1u);
        if surface.w < 1.0 || fades_at >= light.fade_end_m || dot(normal, to_light) <= LEAST_COSINE * length(to_light) {
            continue;
        }
        let face = select(0u, cube_face(-to_light), light.view_count > 1u);
        mark(light.first_view + face, light, surface.xyz, normal, 1.0 / pixels_per_metre(depth));
    }
}

// The face of a point light that all of a block is in, or the number of faces.
fn face_of(center: vec3f, block: Block) -> u32 {
    let face = cube_face(block.position_min - center);
    for (var corner = 1u; corner < 8u; corner++) {
        let is_high = (vec3u(corner) & vec3u(1u, 2u, 4u)) != vec3u(0u);
        if cube_face(select(block.position_min, block.position_max, is_high) - center) != face {
            return 6u;
        }
    }
    return face;
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
    let block = block_at(BLOCK * id.xy);
    if block.is_seen {
        for (var axis = 0u; axis < 3u; axis++) {
            atomicMin(&lowest[axis], encoded(block.position_min[axis]));
            atomicMax(&highest[axis], encoded(block.position_max[axis]));
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
        let count = select(0u, atomicLoad(&reaching_count), block.is_seen);
        for (var i = 0u; i < count; i++) {
            let light = shadow_lights[reaching[i]];
            let projection = projections[light.first_view];
            if is_out_of_reach(projection, light, block) {
                continue;
            }
            var face = 0u;
            if light.view_count > 1u {
                face = face_of(projection.center, block);
            }
            if face >= light.view_count || !mark_block(light.first_view + face, light, block) {
                mark_pixels(light, block);
            }
        }
        workgroupBarrier();
    }
}
