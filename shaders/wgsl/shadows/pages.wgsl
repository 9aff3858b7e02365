// Pages of virtual shadow maps. The map of a projection has levels, each with texels twice as wide as those of the level before. A level is
// a grid of pages; those that are resident have a place in the pool of physical pages.
#define_import_path shadowgraph::shadows::pages
#import shadowgraph::shadows::page_depths::PageDepths
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::shadows::variant::DIRECTIONAL

// Texels along a page without its border, the border on each side, and with both.
const PAGE_TEXELS: f32 = 128.0;
const BORDER_TEXELS: f32 = 4.0;
const PAGE_PX: u32 = 136u;
// Levels are blended over this last part of the range of pixels that they serve.
const BLEND_PART: f32 = 0.25;
// Levels by which maps are finer where surfaces are seen or lit at a grazing angle, at most.
const MAX_NARROWING: f32 = 1.0;
// How far a level of a directional light reaches from the camera, texels: across it has 64 pages on each side, and along the light depths up to
// half its range, less half a step in which that follows the camera.
const REACH_ACROSS: f32 = 62.0 * 128.0;
const REACH_ALONG: f32 = 48000.0;
// Steps of a level in which all levels are coarsened while the pool is too small.
const COARSENING_STEPS: f32 = 4.0;

// A projection of a light: that of a directional or of a spot light, or a face of a point light. 176 bytes.
struct Projection {
    // Rows of the matrix from positions to x (right) and y (down), in texels of level 0, depth, and w, by which they are divided.
    x: vec4f,
    y: vec4f,
    z: vec4f,
    w: vec4f,
    // Directional: the camera as x, y (texels of level 0) and z; others: the light's position.
    center: vec3f,
    // The range of a spot or point light, metres.
    range_m: f32,
    // Unit axes of the map, and the direction to the light.
    right: vec3f,
    // The width of a texel of level 0, metres; for spot and point lights at 1 m along the axis.
    texel_m: f32,
    down: vec3f,
    // Change of z/w over that length towards the light; for spot and point lights times w.
    depth_per_texel: f32,
    to_light: vec3f,
    // 1: w is the distance along the axis.
    is_perspective: u32,
    // The first of its levels, and their number.
    first_level: u32,
    level_count: u32,
    // The first of its entries of the table.
    first_entry: u32,
    // Changes with the light: pages of another version are stale. 0: the projection is unused.
    version: u32,
    // The tangent of the angular radius of a directional light, or the radius of others, metres. For penumbrae: their largest radius, metres,
    // and the coarsest level that they are read from besides those that pixels ask for.
    light_radius: f32,
    max_radius_m: f32,
    soft_level: u32,
    // The bias away from the light with which casters are drawn, relative to the slope of their depth.
    caster_slope_bias: f32,
}

// A level of a map. Page 0 of a directional light contains the frame's origin; that of others is at the top left. 48 bytes.
struct Level {
    // The point with x = y = 0, texels of this level.
    phase: vec2f,
    // Added to pages to find their entry: entries wrap around.
    base: vec2i,
    // The first page that has an entry.
    first_page: vec2i,
    // Depth in the map: z/w times the scale, plus the offset.
    depth_scale: f32,
    depth_offset: f32,
    // The first entry, from that of the projection.
    first_entry: u32,
    // The logarithm to base 2 of the number of pages along each side.
    side_shift: u32,
    // The exponent of its texels: equal levels of different frames have equal exponents.
    exponent: i32,
    // The smallest difference of depths.
    depth_step: f32,
}

// A page of a level of a projection.
struct Page {
    projection: u32,
    level: u32,
    place: vec2i,
}

// A physical page. 64 bytes.
struct PhysicalPage {
    page: Page,
    // That of the projection when the page was drawn; 0: the page is free.
    version: u32,
    // That of its level.
    exponent: i32,
    // The last frame that needed it.
    last_frame: u32,
    // The index of its entry.
    entry: u32,
    // STATIC or COMPOSITE.
    kind: u32,
    // The frame that drew it, and its layer there.
    drawn_frame: u32,
    layer: u32,
    // The offset of depths in its level, and how it stores them.
    depth_offset: f32,
    depths: PageDepths,
}

const STATIC: u32 = 0u;
const COMPOSITE: u32 = 1u;

// The pages of the frame.
struct PageTable {
    // Number of the frame, modulo 65536.
    stamp: u32,
    // Steps by which all levels are coarser, COARSENING_STEPS for a level.
    coarsening: u32,
    // Pages of the pool along its width.
    pool_columns: u32,
    // Added to levels: coarser above 0, finer below.
    level_bias: f32,
    // For each page the stamp of the last frame that needed it, in the upper half, PAGE_DRAWN if that has drawn it, and its place in the pool
    // plus 1.
    entries: array<u32>,
}

const PAGE_DRAWN: u32 = 0x8000u;
const PAGE_PLACE: u32 = 0x7fffu;

// The entry of a page in the table.
fn entry_of(projection: Projection, level: Level, place: vec2i) -> u32 {
    let side = 1u << level.side_shift;
    let wrapped = vec2u(place + level.base) & vec2u(side - 1u);
    return projection.first_entry + level.first_entry + (wrapped.y << level.side_shift) + wrapped.x;
}

// Whether a page has an entry.
fn has_entry(level: Level, place: vec2i) -> bool {
    let offset = vec2u(place - level.first_page);
    return all(offset < vec2u(1u << level.side_shift));
}

// How soft the shadows of a point are.
struct Softness {
    // The level that it is read from; the fraction says how near it is to the next one.
    level: f32,
    // The half width of the filter, texels of level 0.
    radius: f32,
}

// A point in a projection.
struct MapPoint {
    // Texels of level 0, and z/w.
    position: vec3f,
    w: f32,
}

fn project(projection: Projection, position: vec3f) -> MapPoint {
    if DIRECTIONAL {
        let axes = mat3x3f(projection.x.xyz, projection.y.xyz, projection.z.xyz);
        return MapPoint(position * axes, 1.0);
    }
    let p = vec4f(position, 1.0);
    let w = dot(projection.w, p);
    let divided = vec3f(dot(projection.x, p), dot(projection.y, p), dot(projection.z, p)) / w;
    return MapPoint(divided, w);
}

// The depth at an infinite distance from a spot or point light: z is this times w, plus a constant.
fn depth_at_infinity(projection: Projection) -> f32 {
    return dot(projection.z.xyz, projection.w.xyz);
}

// The position of a point in a level, texels.
fn in_level(point: MapPoint, level_index: u32, level: Level) -> vec2f {
    return ldexp(point.position.xy, vec2i(-i32(level_index))) + level.phase;
}

// The page of a position in a level.
fn page_of(texels: vec2f) -> vec2i {
    return vec2i(floor(texels / PAGE_TEXELS));
}

// The logarithm to base 2 of the width of a pixel on the map: the shorter axis of its image there, relative to its width across the view. The
// pixel is projected onto the surface along the view, and from there onto the map along the light; of that linear map, the sum of the squares
// and the product of the singular values are known. The vectors have unit length.
fn narrowing(normal: vec3f, to_camera: vec3f, to_light: vec3f) -> f32 {
    let facing_camera = max(abs(dot(normal, to_camera)), 1e-3);
    let facing_light = dot(normal, to_light);
    let between = dot(to_light, to_camera) * sign(dot(normal, to_camera)) / facing_camera;
    let squares = max(1.0 / (facing_camera * facing_camera) - between * between + 2.0 * facing_light * between, 0.0);
    let product = facing_light / facing_camera;
    let difference = sqrt(max(squares * squares - 4.0 * product * product, 0.0));
    return clamp(0.5 * log2(0.5 * max(squares - difference, 1e-12)), -MAX_NARROWING, 0.0);
}

// The direction to the light, unit length.
fn direction_to_light(projection: Projection, position: vec3f) -> vec3f {
    if DIRECTIONAL || projection.is_perspective == 0u {
        return projection.to_light;
    }
    return normalize(projection.center - position);
}

// The level for a pixel of this width on the map, metres: its texels are at most as wide. The fraction says how near it is to the next level.
fn wanted_level(projection: Projection, point: MapPoint, pixel_m: f32) -> f32 {
    var level = log2(pixel_m / (projection.texel_m * point.w));
    if DIRECTIONAL || projection.is_perspective == 0u {
        // The level covers the point.
        let offset = abs(point.position - projection.center);
        let across = max(offset.x, offset.y) / REACH_ACROSS;
        level = max(level, ceil(log2(max(across, offset.z / (REACH_ALONG * projection.texel_m)))));
    }
    return clamp(level, 0.0, f32(projection.level_count - 1u));
}

// A receiver, moved along its normal by the bias of a level.
fn biased(projection: Projection, light: ShadowLight, level: u32, position: vec3f, normal: vec3f) -> vec3f {
    var w = 1.0;
    if !DIRECTIONAL && projection.is_perspective == 1u {
        w = max(dot(projection.w, vec4f(position, 1.0)), 0.0);
    }
    let cosine = dot(normal, direction_to_light(projection, position));
    let sine = select(1.0, sqrt(saturate(1.0 - cosine * cosine)), light.normal_sine == 1u);
    return position + normal * (light.normal_bias_texels * sine * ldexp(projection.texel_m * w, i32(level)));
}

// In the second part of the tag of a composite page's view: the depths of the static page are those of a layer of this frame, not of a place in
// the pool.
const IS_LAYER: u32 = 0x80000000u;

// The first texel of a place in a pool with some pages along its width.
fn place_texel(place: u32, columns: u32) -> vec2u {
    return PAGE_PX * vec2u(place % columns, place / columns);
}

// The page of the next level that contains a page.
fn parent_of(page: Page, level: Level) -> Page {
    return Page(page.projection, page.level + 1u, (page.place + (level.base & vec2i(1))) >> vec2u(1u));
}
