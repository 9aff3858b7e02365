// The technique `virtual`: shadows from pages of virtual shadow maps. A point is read from the level whose texels are at most as wide as its
// pixel, or from the next coarser one with a page there.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::{Receiver, RECEIVER_COARSER}
#import shadowgraph::shadows::colors::cascade_tint
#import shadowgraph::shadows::cube::cube_face
#import shadowgraph::shadows::crease::is_behind_crease
#import shadowgraph::shadows::filter::filtered
#import shadowgraph::shadows::lookup::{Lookup, incidence_in, look_up}
#import shadowgraph::shadows::maps::read_page
#import shadowgraph::shadows::pages::{
    BLEND_PART, BORDER_TEXELS, COARSENING_STEPS, Level, Page, PAGE_DRAWN, PAGE_PLACE, PAGE_PX, PAGE_TEXELS, PageTable, Projection, biased, entry_of, has_entry,
    in_level, page_of, place_texel, project, wanted_level,
}
#import shadowgraph::shadows::types::{NOT_A_CASCADE, ShadowLight, ShadowView}
#import shadowgraph::shadows::variant::DIRECTIONAL
#import shadowgraph::view::pixels_per_metre

@group(1) @binding(0) var<storage, read> projections: array<Projection>;
@group(1) @binding(1) var<storage, read> levels: array<Level>;
@group(1) @binding(2) var<storage, read> shadow_lights: array<ShadowLight>;
@group(1) @binding(3) var<storage, read> page_table: PageTable;

// A page that the frame has, or none.
struct Found {
    page: Page,
    place_px: vec2f,
    exists: bool,
    // Whether this frame has drawn it.
    is_drawn: bool,
}

fn light_shadow(light: u32) -> ShadowLight {
    var shadow = shadow_lights[light];
    if light >= arrayLength(&shadow_lights) {
        shadow.view_count = 0u;
    }
    return shadow;
}

// The page of a point in a level, or in the finest coarser level that has one.
fn find_page(index: u32, projection: Projection, shadow: ShadowLight, receiver: Receiver, finest: u32) -> Found {
    var found: Found;
    for (var number = finest; number < projection.level_count; number++) {
        let level = levels[projection.first_level + number];
        let moved = biased(projection, shadow, number, receiver.position, receiver.geometric_normal);
        let place = page_of(in_level(project(projection, moved), number, level));
        if !has_entry(level, place) {
            continue;
        }
        let entry = page_table.entries[entry_of(projection, level, place)];
        if entry >> 16u == page_table.stamp && (entry & PAGE_PLACE) != 0u {
            let texel = place_texel((entry & PAGE_PLACE) - 1u, page_table.pool_columns);
            found = Found(Page(index, number, place), vec2f(texel), true, (entry & PAGE_DRAWN) != 0u);
            break;
        }
    }
    return found;
}

// The view of a page, as lookups expect it.
fn view_of(projection: Projection, found: Found) -> ShadowView {
    let number = found.page.level;
    let level = levels[projection.first_level + number];
    let page_px = f32(PAGE_PX);
    let scale = ldexp(1.0, -i32(number));
    // From texels of the level to those of the page with its border.
    let offset = level.phase + BORDER_TEXELS - PAGE_TEXELS * vec2f(found.page.place);
    let depth = projection.z * level.depth_scale + projection.w * level.depth_offset;
    let across = (projection.x * scale + projection.w * offset.x) / page_px;
    let down = (projection.y * scale + projection.w * offset.y) / page_px;
    var result: ShadowView;
    result.map_from_world = transpose(mat4x4f(across, down, depth, projection.w));
    // Of this, the directions of the axes are read.
    result.clip_from_world = transpose(
        mat4x4f(vec4f(projection.right, 0.0), vec4f(-projection.down, 0.0), depth, projection.w),
    );
    result.axis_scale = 1.0;
    result.texel_scale = vec2f(1.0);
    result.texel_world = projection.texel_m / scale;
    result.depth_per_texel = projection.depth_per_texel * level.depth_scale / scale;
    result.light = vec4f(projection.to_light, 0.0);
    if !DIRECTIONAL && projection.is_perspective == 1u {
        result.light = vec4f(projection.center, 1.0);
    }
    result.uv_min = vec2f((BORDER_TEXELS - 1.0) / page_px);
    result.uv_max = vec2f((BORDER_TEXELS + PAGE_TEXELS + 1.0) / page_px);
    result.bias_scale = 1.0;
    result.depth_step = level.depth_step;
    result.cascade = NOT_A_CASCADE;
    return result;
}

// Lit where there is no page.
fn page_visibility(projection: Projection, shadow: ShadowLight, receiver: Receiver, found: Found) -> f32 {
    if !found.exists {
        return 1.0;
    }
    read_page(found.place_px);
    let shadow_view = view_of(projection, found);
    let lookup = look_up(shadow_view, shadow, receiver, incidence_in(shadow_view, shadow, receiver));
    if !lookup.covered {
        return 1.0;
    }
    let visibility = filtered(shadow, receiver, lookup);
    if visibility > 0.0 && is_behind_crease(shadow, lookup, shadow.filter_half) {
        return 0.0;
    }
    return visibility;
}

// The level that a point is read from; the fraction says how near it is to the next one.
fn level_at(projection: Projection, receiver: Receiver) -> f32 {
    let pixel_m = exp2(page_table.level_bias) / pixels_per_metre(receiver.view_depth);
    let wanted = wanted_level(projection, project(projection, receiver.position), pixel_m)
        + f32(page_table.coarsening) / COARSENING_STEPS
        + select(0.0, 1.0, (receiver.flags & RECEIVER_COARSER) != 0u);
    return min(wanted, f32(projection.level_count - 1u));
}

// The index of the projection of a point among those of its light.
fn face_of(shadow: ShadowLight, receiver: Receiver) -> u32 {
    if DIRECTIONAL || shadow.view_count == 1u {
        return 0u;
    }
    return cube_face(receiver.position - projections[shadow.first_view].center);
}

fn strength_at(shadow: ShadowLight, receiver: Receiver) -> f32 {
    let distance_m = select(receiver.view_depth, distance(shadow.eye, receiver.position), shadow.fades_by_radius == 1u);
    return shadow.strength * saturate((shadow.fade_end_m - distance_m) * shadow.fade_per_m);
}

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    let shadow = light_shadow(light);
    let strength = strength_at(shadow, receiver);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    let index = shadow.first_view + face_of(shadow, receiver);
    let projection = projections[index];
    let wanted = level_at(projection, receiver);
    let finest = u32(wanted);
    var found = find_page(index, projection, shadow, receiver, finest);
    // Near the end of its range, a level is blended with the next.
    let blends = found.exists && found.page.level == finest;
    var weight = 1.0 - select(0.0, saturate((fract(wanted) - (1.0 - BLEND_PART)) / BLEND_PART), blends);
    var visibility = 0.0;
    var is_last = weight == 1.0;
    loop {
        visibility += weight * page_visibility(projection, shadow, receiver, found);
        if is_last {
            break;
        }
        found = find_page(index, projection, shadow, receiver, finest + 1u);
        weight = 1.0 - weight;
        is_last = true;
    }
    return vec3f(mix(1.0, visibility, strength));
}

// The colour of the level that is read, in a checkerboard of its pages; darker where the page is kept from an earlier frame. White without
// shadows.
fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    let shadow = light_shadow(light);
    let strength = strength_at(shadow, receiver);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    let index = shadow.first_view + face_of(shadow, receiver);
    let projection = projections[index];
    let found = find_page(index, projection, shadow, receiver, u32(level_at(projection, receiver)));
    if !found.exists {
        return vec3f(1.0);
    }
    let is_odd = ((found.page.place.x + found.page.place.y) & 1) == 1;
    let exponent = levels[projection.first_level + found.page.level].exponent;
    return cascade_tint(u32(exponent & 3)) * select(1.0, 0.75, is_odd) * select(0.45, 1.0, found.is_drawn);
}
