// The state of virtual shadow maps, for the passes that bring it up to date.
#define_import_path shadowgraph::pages_state
#import shadowgraph::shadows::pages::{Level, Page, Projection}

const MAX_COARSE: u32 = 512u;
const MAX_CHANGED: u32 = 256u;

// What the passes of a frame need.
struct PagesFrame {
    // Number of the frame; ages are differences.
    frame: u32,
    // Physical pages, and those along the width of the pool.
    page_count: u32,
    pool_columns: u32,
    light_count: u32,
    // Pages that are always needed, and changed boxes.
    coarse_count: u32,
    changed_count: u32,
    // The capacity of the list of requested pages, and of that of needed pages, which follows.
    request_capacity: u32,
    need_capacity: u32,
    // Added to levels: coarser above 0, finer below.
    level_bias: f32,
    // 1: no page is valid.
    is_reset: u32,
    padding: vec2u,
    // Projection, level, and place.
    coarse: array<vec4i, MAX_COARSE>,
    // The centre and half the size of bounds of casters that have changed, before and after.
    changed: array<vec4f, 512>,
}

// A page, and the index of its entry in the table.
struct ListedPage {
    page: Page,
    entry: u32,
    padding: u32,
}

// The arguments of the draw that stores pages, and counts.
struct Counters {
    vertex_count: u32,
    drawn: u32,
    first_vertex: u32,
    first_instance: u32,
    requested: atomic<u32>,
    listed: atomic<u32>,
    // Pages that the frame needs, at its coarsening.
    needed: u32,
    // Of these, the ones that have to be drawn.
    missing: u32,
    coarsening: u32,
    // Pages that hold depth.
    resident: u32,
    padding: vec2u,
}

@group(1) @binding(0) var<uniform> pages_frame: PagesFrame;
@group(1) @binding(1) var<storage, read> projections: array<Projection>;
@group(1) @binding(2) var<storage, read> levels: array<Level>;
// Two words for each entry: bits for the quarters of levels that pixels request, and for the coarsenings that need the page.
@group(1) @binding(3) var<storage, read_write> marks: array<atomic<u32>>;
@group(1) @binding(4) var<storage, read_write> counters: Counters;
// Requested pages, then needed ones.
@group(1) @binding(5) var<storage, read_write> lists: array<ListedPage>;

fn level_of(page: Page) -> Level {
    return levels[projections[page.projection].first_level + page.level];
}

fn frame_stamp() -> u32 {
    return pages_frame.frame & 0xffffu;
}
