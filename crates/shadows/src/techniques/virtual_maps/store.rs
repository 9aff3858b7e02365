//! What is kept on the GPU from frame to frame, and what the CPU knows about it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DVec3;
use shadowgraph_core::Frame;
use shadowgraph_scene::Aabb;

use super::projections::PAGE_PX;
use super::slots::Slots;
use super::tints::Tints;
use crate::casters::ShadowCasters;
use crate::layered_casters::LayeredCasters;

/// The format of the pool: see `shadows/page_depths.wgsl`.
pub(super) const POOL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// The logarithm to base 2 of the bytes of a texel of the pool.
const POOL_TEXEL_SHIFT: u32 = 1;
/// The bytes of a page in the buffers that it is drawn into.
const DRAWN_PAGE_BYTES: u64 = PAGE_PX as u64 * PAGE_PX as u64 * 4;
/// The size of `PhysicalPage` of `shadows/pages.wgsl`.
const PHYSICAL_PAGE_BYTES: u64 = 64;
/// Words before the entries of the table: `PageTable` of `shadows/virtual.wgsl`.
const TABLE_HEADER_WORDS: u64 = 4;
/// Bytes of marks for each entry.
const MARK_BYTES: u64 = 12;
/// The most boxes of a part of [`Boxes`].
const MAX_PART: usize = 256;

/// The physical pages of a pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PoolSize {
    /// Width and height of the texture.
    pub(super) size_px: [u32; 2],
    /// Pages along the width.
    pub(super) columns: u32,
    /// Number of pages.
    pub(super) pages: u32,
}

impl PoolSize {
    /// Returns the pool with some memory, a power of two. Its width and height in texels are powers of two, so texture coordinates of texels are
    /// exact.
    ///
    /// # Errors
    /// The most MiB within the limits.
    pub(super) fn new(mib: u32, limits: &wgpu::Limits) -> Result<Self, u32> {
        let size = |mib: u32| {
            let texels_log2 = mib.ilog2() + 20 - POOL_TEXEL_SHIFT;
            let [width, height] = [texels_log2.div_ceil(2), texels_log2 / 2].map(|side| 1u32 << side);
            let [columns, rows] = [width, height].map(|side| side / PAGE_PX);
            Self { size_px: [width, height], columns, pages: columns * rows }
        };
        let bytes = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let fits = |size: &Self| {
            size.size_px[0] <= limits.max_texture_dimension_2d
                && DRAWN_PAGE_BYTES * u64::from(size.pages) <= bytes
        };
        let wanted = size(mib);
        if fits(&wanted) {
            return Ok(wanted);
        }
        let less = std::iter::successors(Some(mib / 2), |&mib| Some(mib / 2)).take_while(|&mib| mib > 0);
        Err(less.into_iter().find(|&mib| fits(&size(mib))).unwrap_or(0))
    }
}

/// What a frame needs of a store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PageNeeds {
    pub(super) size: PoolSize,
    /// Entries of the page table.
    pub(super) entry_count: u32,
    /// Whether casters tint.
    pub(super) tinted: bool,
}

/// The tints of the physical pages of a pool.
pub(super) struct TintStore {
    depths: wgpu::Buffer,
    densities: wgpu::Buffer,
}

impl TintStore {
    pub(super) fn import(&self, frame: &mut Frame<'_>) -> Tints {
        Tints {
            depths: frame.import_buffer("page tint depths", &self.depths, true),
            densities: frame.import_buffer("page tint densities", &self.densities, true),
        }
    }
}

/// The buffers of a view, and what has been drawn into them.
pub(super) struct PageStore {
    pub(super) size: PoolSize,
    pub(super) pool: wgpu::Texture,
    /// `PageTable`.
    pub(super) table: wgpu::Buffer,
    /// Three words for each entry.
    pub(super) marks: wgpu::Buffer,
    /// `PhysicalPage`s.
    pub(super) pages: wgpu::Buffer,
    /// Depths of the pages that a frame draws; 0 between frames.
    pub(super) depths: wgpu::Buffer,
    /// If a frame has had casters that tint.
    pub(super) tints: Option<TintStore>,
    entry_count: u32,
    known: Mutex<StoreState>,
}

/// What the last recorded frame has left.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct StoreState {
    /// Its number; 0 before the first.
    pub(super) frame: u32,
    pub(super) origin_world: DVec3,
    pub(super) slots: Slots,
    static_version: u64,
    /// The version and the bounds of each moving caster.
    moving: BTreeMap<u32, (Option<u64>, Aabb)>,
}

impl PageStore {
    pub(super) fn new(device: &wgpu::Device, needs: PageNeeds) -> Self {
        let PageNeeds { size, entry_count, tinted } = needs;
        let [width, height] = size.size_px;
        let pool = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("page pool"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: POOL_FORMAT,
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let buffer = |label, size| {
            // With the latter, captured frames have their contents.
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let (pages, entries) = (u64::from(size.pages), u64::from(entry_count.max(1)));
        Self {
            size,
            pool,
            table: buffer("page table", 4 * (TABLE_HEADER_WORDS + entries)),
            marks: buffer("page marks", MARK_BYTES * entries),
            pages: buffer("physical pages", PHYSICAL_PAGE_BYTES * pages),
            depths: buffer("page depths", DRAWN_PAGE_BYTES * pages),
            tints: tinted.then(|| TintStore {
                depths: buffer("page tint depths", DRAWN_PAGE_BYTES * pages),
                densities: buffer("page tint densities", DRAWN_PAGE_BYTES * pages),
            }),
            entry_count,
            known: Mutex::default(),
        }
    }

    /// Returns whether it has this pool, as many entries, and tints if they are needed.
    pub(super) fn fits(&self, needs: PageNeeds) -> bool {
        let has_tints = self.tints.is_some() || !needs.tinted;
        self.size == needs.size && self.entry_count >= needs.entry_count && has_tints
    }

    pub(super) fn known(&self) -> MutexGuard<'_, StoreState> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Bounds of casters that decide which pages are drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Boxes {
    /// Static casters that have changed since the previous frame, before and after; `None`: they may be anywhere.
    pub(super) changed: Option<Vec<Aabb>>,
    /// Moving casters that have moved, before and after.
    pub(super) moved: Vec<Aabb>,
    /// All moving casters.
    pub(super) movers: Vec<Aabb>,
}

/// The most boxes of a frame.
pub(super) const MAX_BOXES: usize = 3 * MAX_PART;

impl StoreState {
    /// Returns what a frame with these casters leaves, and its boxes.
    pub(super) fn next(
        &self,
        casters: (&dyn ShadowCasters, &dyn LayeredCasters),
        origin_world: DVec3,
        slots: Slots,
    ) -> (Self, Boxes) {
        let (all, layered) = casters;
        let mut numbers = Vec::new();
        layered.all_moving(&mut numbers);
        let state = |caster: u32| (caster, (all.version(caster), all.caster_bounds(caster)));
        let moving: BTreeMap<_, _> = numbers.into_iter().map(state).collect();
        let next = Self {
            frame: self.frame + 1,
            origin_world,
            slots,
            static_version: layered.static_version(),
            moving,
        };
        let mut changed = Vec::new();
        let is_known = self.frame > 0
            && self.origin_world == origin_world
            && layered.static_changes(self.static_version, &mut changed);
        let movers = next.moving.values().map(|(_, bounds)| *bounds).collect();
        let boxes = Boxes {
            changed: is_known.then(|| merged(changed)),
            moved: merged(self.moved(&next)),
            movers: merged(movers),
        };
        (next, boxes)
    }

    /// Returns the bounds of moving casters, before and after, that do not stand since this frame.
    fn moved(&self, next: &Self) -> Vec<Aabb> {
        let stands =
            |states: &BTreeMap<_, (Option<u64>, Aabb)>, caster: &u32, state: &(Option<u64>, Aabb)| {
                state.0.is_some() && states.get(caster) == Some(state)
            };
        let before = self.moving.iter().filter(|(caster, state)| !stands(&next.moving, caster, state));
        let after = next.moving.iter().filter(|(caster, state)| !stands(&self.moving, caster, state));
        before.chain(after).map(|(_, (_, bounds))| *bounds).collect()
    }
}

/// Returns at most [`MAX_PART`] boxes that contain all others: neighbours are merged.
fn merged(mut bounds: Vec<Aabb>) -> Vec<Aabb> {
    bounds.retain(|bounds| !bounds.is_empty());
    if bounds.len() <= MAX_PART {
        return bounds;
    }
    let union = |part: &[Aabb]| part.iter().fold(Aabb::EMPTY, |all, bounds| all.union(bounds));
    let all = union(&bounds);
    bounds.sort_by_key(|bounds| cell_order(&all, bounds.center()));
    bounds.chunks(bounds.len().div_ceil(MAX_PART)).map(union).collect()
}

/// Returns the place of a point on a curve through the cells of a grid, on which neighbours are near to each other (Morton order).
fn cell_order(all: &Aabb, point: DVec3) -> u32 {
    const BITS: u32 = 10;
    let size = (all.max - all.min).max(DVec3::splat(f64::MIN_POSITIVE));
    let cells = ((point - all.min) / size * f64::from((1 << BITS) - 1)).as_uvec3();
    let bit = |cell: u32, bit: u32| (cell >> bit) & 1;
    (0..BITS).fold(0, |code, index| {
        let bits = cells.to_array().map(|cell| bit(cell, index));
        code | (bits[0] | bits[1] << 1 | bits[2] << 2) << (3 * index)
    })
}

/// The stores of views.
#[derive(Default)]
pub(super) struct Stores(Mutex<BTreeMap<u32, Arc<PageStore>>>);

impl Stores {
    /// Returns the store of a view in its previous frame.
    pub(super) fn previous(&self, view: u32) -> Option<Arc<PageStore>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&view).cloned()
    }

    /// Returns the store of a view, a new one if that of its previous frame does not fit.
    pub(super) fn fitting(&self, device: &wgpu::Device, view: u32, needs: PageNeeds) -> Arc<PageStore> {
        let mut stores = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(store) = stores.get(&view).filter(|store| store.fits(needs)) {
            return store.clone();
        }
        let store = Arc::new(PageStore::new(device, needs));
        stores.insert(view, store.clone());
        store
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_boxes_are_merged_with_their_neighbours() {
        let cube = |index: u32| {
            let corner = DVec3::new(f64::from(index % 40), 0.0, f64::from(index / 40)) * 10.0;
            Aabb { min: corner, max: corner + 1.0 }
        };
        let few: Vec<_> = (0..256).map(cube).collect();
        assert_eq!(merged(few.clone()), few);
        let many: Vec<_> = (0..1600).map(|index| cube(index * 7 % 1600)).chain([Aabb::EMPTY]).collect();
        let boxes = merged(many.clone());
        assert!(boxes.len() <= MAX_PART);
        let contains = |outer: &Aabb, inner: &Aabb| outer.union(inner) == *outer;
        assert!(many.iter().all(|cube| boxes.iter().any(|merged| contains(merged, cube))));
        let area = |bounds: &Aabb| (bounds.max.x - bounds.min.x) * (bounds.max.z - bounds.min.z);
        // In the order of their numbers, they would cover it 12 times.
        assert!(boxes.iter().map(area).sum::<f64>() < 4.0 * 400.0 * 400.0);
    }

    #[test]
    fn a_pool_has_sides_that_are_powers_of_two_and_is_within_the_limits() {
        let limits = wgpu::Limits::default();
        let pool = |mib| PoolSize::new(mib, &limits);
        assert_eq!(pool(4), Ok(PoolSize { size_px: [2048, 1024], columns: 15, pages: 105 }));
        assert_eq!(pool(64), Ok(PoolSize { size_px: [8192, 4096], columns: 60, pages: 1800 }));
        // Of the default limits, that of storage buffers is reached first.
        assert_eq!(pool(128), Err(64));
        let small = wgpu::Limits { max_texture_dimension_2d: 2048, ..limits };
        assert_eq!(PoolSize::new(64, &small), Err(8));
    }
}
