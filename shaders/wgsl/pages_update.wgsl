// Brings the pages of virtual shadow maps up to date: finds out which pages a frame needs, and gives each a physical page.
//
//   cs_validate   frees the pages that are stale, and lists the coarse pages that are always needed
//   cs_list       lists the pages that are needed for what pixels request, at each coarsening
//   cs_allocate   chooses the least coarsening at which they fit into the pool, and gives pages that are not resident a place
//   cs_finish     frees the pages that are not drawn after all
//
// All but cs_allocate run in any number of workgroups.
//
// A page has a static physical page, with the casters that stand, and where casters move also a composite one, with all of them. A composite
// page is drawn again for each movement, and its static page stays as it is.
#import shadowgraph::shadows::pages::{
    BORDER_TEXELS, COMPOSITE, IS_LAYER, Level, PAGE_DRAWN, PAGE_PX, PAGE_TEXELS, Page, PageTable, PhysicalPage, Projection, STATIC,
    entry_of, has_entry, parent_of,
}
#import shadowgraph::shadows::page_depths::PageDepths
#import shadowgraph::layer_views::{CASTERS_MOVING, CASTERS_STATIC, LayerViews}
#import shadowgraph::pages_state::{
    HAS_MOVERS, IS_COMPOSITE, ListedPage, counters, level_of, levels, lists, marks, pages_frame, projections, frame_stamp, words_of,
}

@group(2) @binding(0) var<storage, read_write> page_table: PageTable;
@group(2) @binding(1) var<storage, read_write> physical_pages: array<PhysicalPage>;
@group(2) @binding(2) var<storage, read_write> page_views: LayerViews;

const THREADS: u32 = 256u;
// Coarsenings, and levels by which the coarsest is coarser.
const COARSENINGS: u32 = 32u;
const COARSER_LEVELS: u32 = 8u;
// The age of a free page; those of others are less.
const FREE: u32 = 255u;

// Lists a page that is needed at some coarsenings, a bit for each.
fn need(page: Page, bits: u32) {
    let projection = projections[page.projection];
    let level = levels[projection.first_level + page.level];
    if bits == 0u || !has_entry(level, page.place) {
        return;
    }
    let entry = entry_of(projection, level, page.place);
    if atomicOr(&marks[words_of(entry) + 1u], bits) == 0u {
        let index = atomicAdd(&counters.listed, 1u);
        if index < pages_frame.need_capacity {
            let has_movers = any_touches(page, pages_frame.moved_end, pages_frame.movers_end);
            lists[pages_frame.request_capacity + index] = ListedPage(page, entry, select(0u, HAS_MOVERS, has_movers));
        } else {
            atomicStore(&marks[words_of(entry) + 1u], 0u);
        }
    }
}

// Whether some of the boxes intersect what is drawn into a page.
fn any_touches(page: Page, begin: u32, end: u32) -> bool {
    if begin == end {
        return false;
    }
    let clip = clip_from_world(page);
    for (var i = begin; i < end; i++) {
        if touches(clip, pages_frame.boxes[2u * i].xyz, pages_frame.boxes[2u * i + 1u].xyz) {
            return true;
        }
    }
    return false;
}

fn touches(clip: mat4x4f, center: vec3f, half_size: vec3f) -> bool {
    let rows = array(
        vec4f(clip[0].x, clip[1].x, clip[2].x, clip[3].x), vec4f(clip[0].y, clip[1].y, clip[2].y, clip[3].y),
        vec4f(clip[0].z, clip[1].z, clip[2].z, clip[3].z), vec4f(clip[0].w, clip[1].w, clip[2].w, clip[3].w),
    );
    let planes = array(rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[2]);
    for (var i = 0u; i < 5u; i++) {
        let plane = planes[i];
        let reach = dot(abs(plane.xyz), half_size);
        let terms = dot(abs(plane.xyz), abs(center)) + abs(plane.w) + reach;
        if dot(plane.xyz, center) + plane.w + reach < -1e-5 * terms {
            return false;
        }
    }
    return true;
}

// The place of a resident page in the pool plus 1, or 0.
fn resident(entry: u32, kind: u32) -> u32 {
    return (atomicLoad(&marks[words_of(entry) + 2u]) >> (16u * kind)) & 0xffffu;
}

fn set_resident(entry: u32, kind: u32, place: u32) {
    atomicOr(&marks[words_of(entry) + 2u], (place + 1u) << (16u * kind));
}

// Shows a page to lookups of this frame. The state is PAGE_DRAWN or 0.
fn show(entry: u32, place: u32, state: u32) {
    page_table.entries[entry] = (frame_stamp() << 16u) | state | (place + 1u);
}

fn free(index: u32) {
    let known = physical_pages[index];
    atomicAnd(&marks[words_of(known.entry) + 2u], ~(0xffffu << (16u * known.kind)));
    physical_pages[index].version = 0u;
}

@compute @workgroup_size(64)
fn cs_validate(@builtin(global_invocation_id) id: vec3u) {
    if id.x < pages_frame.coarse_count {
        let coarse = pages_frame.coarse[id.x];
        need(Page(u32(coarse.x), u32(coarse.y), coarse.zw), 0xffffffffu);
    }
    let index = id.x;
    if index >= pages_frame.page_count || physical_pages[index].version == 0u {
        return;
    }
    let known = physical_pages[index];
    // Stamps are those of one in 65,536 frames.
    page_table.entries[known.entry] = 0u;
    let projection = projections[known.page.projection];
    var is_valid = pages_frame.is_reset == 0u && projection.version == known.version;
    if is_valid {
        // The level with these texels may have another number.
        let number = known.exponent - levels[projection.first_level].exponent;
        let page = Page(known.page.projection, u32(number), known.page.place);
        // Static pages do not depend on what moves.
        let changed_end = select(pages_frame.changed_end, pages_frame.moved_end, known.kind == COMPOSITE);
        is_valid = number >= 0 && number < i32(projection.level_count) && has_entry(level_of(page), page.place)
            && level_of(page).depth_offset == known.depth_offset && !any_touches(page, 0u, changed_end);
        physical_pages[index].page = page;
    }
    if !is_valid {
        free(index);
    }
}

// The bits of coarsenings from `begin` to before `end`.
fn between(begin: i32, end: i32) -> u32 {
    let from_begin = 0xffffffffu << u32(clamp(begin, 0, 31));
    let from_end = select(0xffffffffu << u32(clamp(end, 0, 31)), 0u, end > 31);
    return select(from_begin & ~from_end, 0u, begin > 31 || end <= 0);
}

@compute @workgroup_size(64)
fn cs_list(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let count = min(atomicLoad(&counters.requested), pages_frame.request_capacity);
    for (var index = id.x; index < count; index += 64u * groups.x) {
        let entry = lists[index].entry;
        let quarters = atomicExchange(&marks[words_of(entry)], 0u);
        var page = lists[index].page;
        // Missing pages are listed here later, and nothing else is to be left.
        lists[index] = ListedPage();
        let last = projections[page.projection].level_count - 1u;
        let soft_level = projections[page.projection].soft_level;
        let coarsest = max(page.level + COARSER_LEVELS, soft_level);
        let finest = page.level;
        while page.level <= coarsest {
            let coarser = i32(page.level - finest);
            // Penumbrae are read from all levels up to this.
            var bits = select(0u, between(0, 4 * coarser + 1), page.level > finest && page.level <= soft_level);
            for (var quarter = 0; quarter < 4; quarter++) {
                if (quarters & (1u << u32(quarter))) != 0u {
                    // A level is also blended with the finer one, in the last quarter of that.
                    let begin = 4 * coarser - quarter - 1;
                    bits |= between(begin, select(begin + 5, 32, page.level == last));
                }
            }
            need(page, bits);
            if page.level == last {
                break;
            }
            page = parent_of(page, level_of(page));
        }
    }
}

var<workgroup> counts: array<atomic<u32>, 256>;
var<workgroup> sums: array<u32, 512>;
// Physical pages that are not resident, and those of them that find a place.
var<workgroup> missing_count: atomic<u32>;
var<workgroup> missing_static: atomic<u32>;
var<workgroup> missing: u32;
var<workgroup> oldest: u32;
var<workgroup> older: u32;
var<workgroup> coarsening: u32;

fn listed_count() -> u32 {
    return min(atomicLoad(&counters.listed), pages_frame.need_capacity);
}

fn listed(index: u32) -> ListedPage {
    return lists[pages_frame.request_capacity + index];
}

fn has_movers(page: ListedPage) -> bool {
    return (page.flags & HAS_MOVERS) != 0u;
}

// The kind of the physical page that lookups read.
fn shown_kind(page: ListedPage) -> u32 {
    return select(STATIC, COMPOSITE, has_movers(page));
}

// The kind of a missing page.
fn kind_of(page: ListedPage) -> u32 {
    return select(STATIC, COMPOSITE, (page.flags & IS_COMPOSITE) != 0u);
}

fn age_of(index: u32) -> u32 {
    let page = physical_pages[index];
    if page.version == 0u {
        return FREE;
    }
    return min(pages_frame.frame - page.last_frame, FREE - 1u);
}

// Whether the page is needed at the frame's coarsening.
fn is_needed(entry: u32) -> bool {
    return (atomicLoad(&marks[words_of(entry) + 1u]) & (1u << coarsening)) != 0u;
}

fn choose_coarsening(local: u32) {
    atomicStore(&counts[local], 0u);
    workgroupBarrier();
    for (var index = local; index < listed_count(); index += THREADS) {
        let page = listed(index);
        let bits = atomicLoad(&marks[words_of(page.entry) + 1u]);
        let places = 1u + u32(has_movers(page));
        // Runs of coarsenings are counted where they begin and end.
        let before = bits << 1u;
        for (var begins = bits & ~before; begins != 0u; begins &= begins - 1u) {
            atomicAdd(&counts[firstTrailingBit(begins)], places);
        }
        for (var ends = before & ~bits; ends != 0u; ends &= ends - 1u) {
            atomicSub(&counts[firstTrailingBit(ends)], places);
        }
    }
    workgroupBarrier();
    if local == 0u {
        var needed = atomicLoad(&counts[0]);
        coarsening = 0u;
        while coarsening < COARSENINGS - 1u && needed > pages_frame.page_count {
            coarsening++;
            needed += atomicLoad(&counts[coarsening]);
        }
        counters.needed = needed;
        counters.coarsening = coarsening;
        page_table.coarsening = coarsening;
        page_table.stamp = frame_stamp();
        page_table.pool_columns = pages_frame.pool_columns;
        page_table.level_bias = pages_frame.level_bias;
    }
    workgroupBarrier();
}

// Shows needed pages that are resident, and lists the others in place of the requests.
fn show_resident(local: u32) {
    if local == 0u {
        atomicStore(&missing_count, 0u);
        atomicStore(&missing_static, 0u);
    }
    workgroupBarrier();
    for (var index = local; index < listed_count(); index += THREADS) {
        let needed = listed(index);
        if !is_needed(needed.entry) {
            continue;
        }
        let shown = shown_kind(needed);
        for (var kind = STATIC; kind <= shown; kind++) {
            let place = resident(needed.entry, kind);
            if place == 0u {
                let number = atomicAdd(&missing_count, 1u);
                if number < pages_frame.request_capacity {
                    let is_composite = select(0u, IS_COMPOSITE, kind == COMPOSITE);
                    lists[number] = ListedPage(needed.page, needed.entry, needed.flags | is_composite);
                }
                atomicAdd(&missing_static, u32(kind == STATIC));
                continue;
            }
            physical_pages[place - 1u].last_frame = pages_frame.frame;
            if kind == shown {
                show(needed.entry, place - 1u, 0u);
            }
        }
    }
    storageBarrier();
    workgroupBarrier();
}

// Whether a missing page comes before another: static pages before composite ones, and coarse levels first.
fn comes_before(first: ListedPage, second: ListedPage) -> bool {
    if kind_of(first) != kind_of(second) {
        return kind_of(first) < kind_of(second);
    }
    if first.page.level != second.page.level {
        return first.page.level > second.page.level;
    }
    return first.entry < second.entry;
}

// A step of a bitonic sort whose comparisons all have the same direction: nothing past the end takes part.
fn exchange(local: u32, count: u32, mask: u32) {
    for (var index = local; index < count; index += THREADS) {
        let partner = index ^ mask;
        if partner > index && partner < count && comes_before(lists[partner], lists[index]) {
            let page = lists[index];
            lists[index] = lists[partner];
            lists[partner] = page;
        }
    }
    storageBarrier();
    workgroupBarrier();
}

// Sorts the missing pages: they are listed in any order, and are to have the same places whenever the same frames are drawn.
fn sort_missing(local: u32) {
    if local == 0u {
        missing = min(atomicLoad(&missing_count), pages_frame.request_capacity);
    }
    let count = workgroupUniformLoad(&missing);
    for (var width = 2u; width < 2u * count; width *= 2u) {
        exchange(local, count, width - 1u);
        for (var step = width / 4u; step > 0u; step /= 2u) {
            exchange(local, count, step);
        }
    }
    if local == 0u {
        missing = min(count, pages_frame.page_count);
        counters.drawn_static = atomicLoad(&missing_static);
    }
    workgroupBarrier();
}

// Finds as many pages as are missing, free ones and then those that were not needed for the longest time.
fn find_places(local: u32) {
    atomicStore(&counts[local], 0u);
    workgroupBarrier();
    let share = (pages_frame.page_count + THREADS - 1u) / THREADS;
    let begin = min(local * share, pages_frame.page_count);
    let end = min(begin + share, pages_frame.page_count);
    for (var index = begin; index < end; index++) {
        atomicAdd(&counts[age_of(index)], 1u);
    }
    workgroupBarrier();
    if local == 0u {
        var sum = 0u;
        var age = FREE;
        while age > 0u && sum + atomicLoad(&counts[age]) < missing {
            sum += atomicLoad(&counts[age]);
            age--;
        }
        oldest = age;
        older = sum;
        // Age 0 is that of pages that this frame needs.
        missing = min(missing, select(sum + atomicLoad(&counts[age]), sum, age == 0u));
        counters.resident = min(pages_frame.page_count - atomicLoad(&counts[FREE]) + missing, pages_frame.page_count);
    }
    workgroupBarrier();
    var above = 0u;
    var equal = 0u;
    for (var index = begin; index < end; index++) {
        let age = age_of(index);
        above += u32(age > oldest);
        equal += u32(age == oldest);
    }
    sums[local] = above;
    sums[THREADS + local] = equal;
    workgroupBarrier();
    for (var step = 1u; step < THREADS; step *= 2u) {
        var before = vec2u(0u);
        if local >= step {
            before = vec2u(sums[local - step], sums[THREADS + local - step]);
        }
        workgroupBarrier();
        sums[local] += before.x;
        sums[THREADS + local] += before.y;
        workgroupBarrier();
    }
    var rank_above = sums[local] - above;
    var rank_equal = older + sums[THREADS + local] - equal;
    for (var index = begin; index < end; index++) {
        let age = age_of(index);
        if age > oldest && rank_above < missing {
            page_views.views[rank_above].tag.x = index;
            rank_above++;
        } else if age == oldest && rank_equal < missing {
            page_views.views[rank_equal].tag.x = index;
            rank_equal++;
        }
    }
    storageBarrier();
    workgroupBarrier();
}

// Gives a missing page the place of a rank.
fn give_place(needed: ListedPage, rank: u32) {
    let kind = kind_of(needed);
    let place = page_views.views[rank].tag.x;
    if physical_pages[place].version != 0u {
        free(place);
    }
    let level = level_of(needed.page);
    let version = projections[needed.page.projection].version;
    let frame = pages_frame.frame;
    physical_pages[place] = PhysicalPage(
        needed.page, version, level.exponent, frame, needed.entry, kind, frame, rank, level.depth_offset, PageDepths(),
    );
    set_resident(needed.entry, kind, place);
    if kind == shown_kind(needed) {
        show(needed.entry, place, PAGE_DRAWN);
    }
    page_views.views[rank].clip_from_world = clip_from_world(needed.page);
    let texel = (needed.page.place + level.base) * i32(PAGE_TEXELS) - i32(BORDER_TEXELS);
    page_views.views[rank].noise_px = vec2u(texel & vec2i(1023));
    page_views.views[rank].casters = select(CASTERS_STATIC, CASTERS_MOVING, kind == COMPOSITE);
    page_views.views[rank].tint_layer = place;
    page_views.views[rank].slope_bias = projections[needed.page.projection].caster_slope_bias;
    if kind == COMPOSITE {
        page_views.views[rank].tag.y = static_depths(needed.entry);
    }
}

// Where the depths of the static page of an entry are: see IS_LAYER. It has its place before the composite page.
fn static_depths(entry: u32) -> u32 {
    let place = resident(entry, STATIC) - 1u;
    let layer = physical_pages[place].layer;
    let is_drawn = physical_pages[place].drawn_frame == pages_frame.frame;
    return select(place, layer | IS_LAYER, is_drawn);
}

// Gives the missing pages of a kind their places.
fn assign(local: u32, kind: u32) {
    for (var rank = local; rank < missing; rank += THREADS) {
        if kind_of(lists[rank]) == kind {
            give_place(lists[rank], rank);
        }
    }
    storageBarrier();
    workgroupBarrier();
}

// From positions to the clip space of a page.
fn clip_from_world(page: Page) -> mat4x4f {
    let projection = projections[page.projection];
    let level = level_of(page);
    let half_px = 0.5 * f32(PAGE_PX);
    let scale = ldexp(1.0, -i32(page.level)) / half_px;
    let center = PAGE_TEXELS * (vec2f(page.place) + 0.5) - level.phase;
    let x = projection.x * scale - projection.w * (center.x / half_px);
    let y = projection.w * (center.y / half_px) - projection.y * scale;
    let z = projection.z * level.depth_scale + projection.w * level.depth_offset;
    return transpose(mat4x4f(x, y, z, projection.w));
}

@compute @workgroup_size(256)
fn cs_allocate(@builtin(local_invocation_index) local: u32) {
    choose_coarsening(local);
    show_resident(local);
    sort_missing(local);
    find_places(local);
    assign(local, STATIC);
    assign(local, COMPOSITE);
    for (var index = local; index < listed_count(); index += THREADS) {
        atomicStore(&marks[words_of(listed(index).entry) + 1u], 0u);
    }
    if local == 0u {
        page_views.count = missing;
        page_views.side_px = PAGE_PX;
        let has_static = min(counters.drawn_static, missing) > 0u;
        page_views.casters = select(0u, CASTERS_STATIC, has_static) + select(0u, CASTERS_MOVING, missing > counters.drawn_static);
    }
}

// Shows the static page in place of a composite one, if there is one.
fn show_static(entry: u32, depths: u32) {
    let layer = depths & ~IS_LAYER;
    if (depths & IS_LAYER) == 0u {
        show(entry, depths, 0u);
    } else if layer < page_views.drawn {
        show(entry, page_views.views[layer].tag.x, PAGE_DRAWN);
    }
}

@compute @workgroup_size(64)
fn cs_finish(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var index = page_views.drawn + id.x; index < page_views.count; index += 64u * groups.x) {
        let tag = page_views.views[index].tag;
        let entry = physical_pages[tag.x].entry;
        page_table.entries[entry] = 0u;
        if physical_pages[tag.x].kind == COMPOSITE {
            show_static(entry, tag.y);
        }
        free(tag.x);
    }
    if id.x == 0u {
        counters.vertex_count = 6u;
        counters.drawn = page_views.drawn;
        counters.first_vertex = 0u;
        counters.first_instance = 0u;
        counters.drawn_static = min(counters.drawn_static, page_views.drawn);
        counters.drawn_composite = page_views.drawn - counters.drawn_static;
        counters.pairs = page_views.pairs;
    }
}
