// Draws the pool of physical pages as an image: the surfaces that a page has stored, lit from the top left in the colour of its level, and
// darker where the page is kept from an earlier frame. Texels without a caster are dark, free pages black.
#import shadowgraph::shadows::colors::cascade_tint
#import shadowgraph::shadows::page_depths::{LAST_STEP, depth_of_step}
#import shadowgraph::shadows::pages::{Level, PAGE_PX, PageTable, PhysicalPage, Projection, depth_at_infinity}

@group(0) @binding(0) var<storage, read> projections: array<Projection>;
@group(0) @binding(1) var<storage, read> levels: array<Level>;
@group(0) @binding(2) var<storage, read> page_table: PageTable;
@group(0) @binding(3) var<storage, read> physical_pages: array<PhysicalPage>;
@group(0) @binding(4) var page_pool: texture_depth_2d;
@group(0) @binding(5) var image: texture_storage_2d<rgba8unorm, write>;

const DIRECTION_TO_LIGHT: vec3f = vec3f(-0.5, -0.5, 0.70710678);
const NO_CASTER: f32 = 0.12;
const KEPT: f32 = 0.5;

@compute @workgroup_size(8, 8)
fn cs_view(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(page_pool)) {
        return;
    }
    textureStore(image, id.xy, vec4f(color_of(id.xy), 1.0));
}

fn color_of(texel: vec2u) -> vec3f {
    let place = texel / PAGE_PX;
    let index = place.y * page_table.pool_columns + place.x;
    if place.x >= page_table.pool_columns || index >= arrayLength(&physical_pages) || physical_pages[index].version == 0u {
        return vec3f(0.0);
    }
    let physical = physical_pages[index];
    let is_drawn = (physical.drawn_frame & 0xffffu) == page_table.stamp;
    let color = cascade_tint(u32(physical.exponent & 3)) * select(KEPT, 1.0, is_drawn);
    let depth = depth_at(physical, texel);
    if depth == 0.0 {
        return color * NO_CASTER;
    }
    // Within the page.
    let first = place * PAGE_PX;
    let last = first + PAGE_PX - 1u;
    let slope = vec2f(
        depth_at(physical, vec2u(min(texel.x + 1u, last.x), texel.y)) - depth_at(physical, vec2u(max(texel.x, first.x + 1u) - 1u, texel.y)),
        depth_at(physical, vec2u(texel.x, min(texel.y + 1u, last.y))) - depth_at(physical, vec2u(texel.x, max(texel.y, first.y + 1u) - 1u)),
    ) / (2.0 * depth_per_texel(physical, depth));
    let n_dot_l = dot(normalize(vec3f(-slope, 1.0)), DIRECTION_TO_LIGHT);
    return color * (0.3 + 0.7 * max(n_dot_l, 0.0));
}

fn depth_at(physical: PhysicalPage, texel: vec2u) -> f32 {
    return depth_of_step(physical.depths, round(LAST_STEP * textureLoad(page_pool, texel, 0)));
}

// The change of a depth over the width of a texel towards the light.
fn depth_per_texel(physical: PhysicalPage, depth: f32) -> f32 {
    let projection = projections[physical.page.projection];
    let level = levels[projection.first_level + physical.page.level];
    let change = ldexp(projection.depth_per_texel * level.depth_scale, i32(physical.page.level));
    if projection.is_perspective == 0u {
        return change;
    }
    // The depth is z/w, with z = a w + b.
    let a = depth_at_infinity(projection);
    let b = projection.z.w - a * projection.w.w;
    return change * max((depth - a) / b, 1e-9);
}
