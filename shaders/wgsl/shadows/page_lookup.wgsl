// Finds the pages of virtual shadow maps that points are read from, and looks points up in them.
#define_import_path shadowgraph::shadows::page_lookup
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::{Lookup, incidence_in, look_up}
#import shadowgraph::shadows::maps::read_page
#import shadowgraph::shadows::page_depths::step_width
#import shadowgraph::shadows::pages::{
    BORDER_TEXELS, Level, Page, PAGE_DRAWN, PAGE_PLACE, PAGE_PX, PAGE_TEXELS, PageTable, PhysicalPage, Projection, biased, entry_of,
    has_entry, in_level, page_of, place_texel, project,
}
#import shadowgraph::shadows::types::{NOT_A_CASCADE, ShadowLight, ShadowView}
#import shadowgraph::shadows::variant::DIRECTIONAL

@group(1) @binding(0) var<storage, read> projections: array<Projection>;
@group(1) @binding(1) var<storage, read> levels: array<Level>;
@group(1) @binding(2) var<storage, read> shadow_lights: array<ShadowLight>;
@group(1) @binding(3) var<storage, read> page_table: PageTable;
@group(1) @binding(8) var<storage, read> physical_pages: array<PhysicalPage>;

// A page that the frame has, or none.
struct Found {
    page: Page,
    // Of the physical page, and its place in the pool.
    index: u32,
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
fn find_page(index: u32, shadow: ShadowLight, receiver: Receiver, finest: u32) -> Found {
    let projection = projections[index];
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
            let physical = (entry & PAGE_PLACE) - 1u;
            let texel = place_texel(physical, page_table.pool_columns);
            found = Found(Page(index, number, place), physical, vec2f(texel), true, (entry & PAGE_DRAWN) != 0u);
            break;
        }
    }
    return found;
}

// The view of a page, as lookups expect it.
fn view_of(found: Found) -> ShadowView {
    let projection = projections[found.page.projection];
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

// Looks a point up in a page, from which maps are read from then on. A page that does not exist covers nothing.
fn look_up_page(shadow: ShadowLight, receiver: Receiver, found: Found) -> Lookup {
    var lookup: Lookup;
    if found.exists {
        let depths = physical_pages[found.index].depths;
        read_page(found.index, found.place_px, depths);
        let shadow_view = view_of(found);
        lookup = look_up(shadow_view, shadow, receiver, incidence_in(shadow_view, shadow, receiver));
        let error = lookup.unbiased.error;
        lookup.unbiased.error = select(0.0, error + step_width(depths, lookup.depth), error > 0.0);
    }
    return lookup;
}
