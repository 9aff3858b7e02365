// The state of virtual shadow maps, for the passes that bring it up to date.
#define_import_path shadowgraph::pages_state
#import shadowgraph::shadows::pages::{Level, Page, Projection}

const MAX_COARSE: u32 = 512u;
// Twice the number of boxes.
const BOX_WORDS: u32 = 1536u;

// What the passes of a frame need.
struct PagesFrame {
    // Number of the frame; ages are differences.
    frame: u32,
    // Physical pages, and those along the width of the pool.
    page_count: u32,
    pool_columns: u32,
    light_count: u32,
    // Pages that are always needed.
    coarse_count: u32,
    // The ends of the parts of the list of boxes: see `boxes`.
    changed_end: u32,
    moved_end: u32,
    movers_end: u32,
    // The capacity of the list of requested pages, and of that of needed pages, which follows.
    request_capacity: u32,
    need_capacity: u32,
    // Added to levels: coarser above 0, finer below.
    level_bias: f32,
    // 1: no page is valid.
    is_reset: u32,
    // The height of a plane that is lit where no surface is visible, if there is one.
    ground_height: f32,
    has_ground: u32,
    padding: vec2u,
    // Projection, level, and place.
    coarse: array<vec4i, MAX_COARSE>,
    // The centre and half the size of the bounds of static casters that have changed, before and after; then of moving casters that have
    // moved, before and after; then of all moving casters.
    boxes: array<vec4f, BOX_WORDS>,
}

// A page, and the index of its entry in the table.
struct ListedPage {
    page: Page,
    entry: u32,
    flags: u32,
}

// Moving casters are drawn into the page.
const HAS_MOVERS: u32 = 1u;
// Of a page that is missing: it is a composite one.
const IS_COMPOSITE: u32 = 2u;

// The arguments of the draw that stores pages, and counts.
struct Counters {
    vertex_count: u32,
    drawn: u32,
    first_vertex: u32,
    first_instance: u32,
    requested: atomic<u32>,
    listed: atomic<u32>,
    // Physical pages that the frame needs, at its coarsening.
    needed: u32,
    // Physical pages that hold depth.
    resident: u32,
    // Those that the frame draws. Until cs_finish, the static ones that it should draw.
    drawn_static: u32,
    drawn_composite: u32,
    // Casters that are drawn, each once for each of its pages.
    pairs: u32,
    coarsening: u32,
}

@group(1) @binding(0) var<uniform> pages_frame: PagesFrame;
@group(1) @binding(1) var<storage, read> projections: array<Projection>;
@group(1) @binding(2) var<storage, read> levels: array<Level>;
// Three words for each entry: bits for the quarters of levels that pixels request, bits for the coarsenings that need the page, and the places of
// its static and of its composite physical page in the pool, plus 1, in the lower and in the upper half.
@group(1) @binding(3) var<storage, read_write> marks: array<atomic<u32>>;
@group(1) @binding(4) var<storage, read_write> counters: Counters;
// Requested pages, then needed ones.
@group(1) @binding(5) var<storage, read_write> lists: array<ListedPage>;

fn level_of(page: Page) -> Level {
    return levels[projections[page.projection].first_level + page.level];
}

// The first word of an entry.
fn words_of(entry: u32) -> u32 {
    return 3u * entry;
}

fn frame_stamp() -> u32 {
    return pages_frame.frame & 0xffffu;
}
