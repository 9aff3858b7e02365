//! Maps that are kept from frame to frame, the separate depth of static casters, and the contents of their tiles.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::contents::{ALL_STATIC, Held, Stored};
use crate::atlas::TileRect;

/// A number for the contents of a tile: contents that were drawn again have another one. Without casters it is 0.
pub(crate) type Revision = u64;

/// A kept map.
pub(super) struct CachedMap {
    pub(super) texture: wgpu::Texture,
    state: Mutex<State>,
}

/// The contents that the passes of recorded frames have drawn.
#[derive(Default)]
struct State {
    /// Whether a pass has drawn into the map.
    drawn: bool,
    tiles: Vec<(TileRect, (Held, Revision))>,
    store: Option<Store>,
}

/// The depth of static casters alone, in a texture of the map's size and format. wgpu initializes it with zeros, the far end.
struct Store {
    texture: wgpu::Texture,
    tiles: Vec<(TileRect, Stored)>,
    /// Number of frames since it was needed.
    unused_frames: u32,
}

/// The number of frames without need after which a store is dropped.
const KEPT_FRAMES: u32 = 60;

impl CachedMap {
    pub(super) fn new(
        device: &wgpu::Device,
        name: &str,
        size_px: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> Self {
        Self { texture: texture(device, name, size_px, format), state: Mutex::default() }
    }

    /// Returns whether it has this size and format.
    pub(super) fn fits(&self, size_px: [u32; 2], format: wgpu::TextureFormat) -> bool {
        [self.texture.width(), self.texture.height()] == size_px && self.texture.format() == format
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns whether no pass has drawn into it.
    pub(super) fn is_new(&self) -> bool {
        !self.state().drawn
    }

    /// Calls `read` with the contents of a tile and of its store.
    pub(super) fn with_tile<R>(
        &self,
        rect: TileRect,
        read: impl FnOnce(Option<&Held>, Option<&Stored>) -> R,
    ) -> R {
        let state = self.state();
        let stored = state.store.as_ref().and_then(|store| find(&store.tiles, rect));
        read(find(&state.tiles, rect).map(|(held, _)| held), stored)
    }

    /// Gives the static casters of a tile and its store a new version, unless they have changed since theirs.
    pub(super) fn renew(&self, rect: TileRect, version: u64, is_same: impl Fn(u64) -> bool) {
        let mut state = self.state();
        let renew = |entry: &mut u64| {
            if is_same(*entry) {
                *entry = version;
            }
        };
        if let Some((_, (held, _))) = state.tiles.iter_mut().find(|(other, _)| *other == rect) {
            let all = held.statics.iter_mut().filter(|(caster, _)| *caster == ALL_STATIC);
            all.for_each(|(_, entry)| renew(entry));
            held.static_version.iter_mut().for_each(renew);
        }
        let stored = state.store.iter_mut().flat_map(|store| &mut store.tiles);
        for (_, stored) in stored.filter(|(other, _)| *other == rect) {
            let all = stored.casters.iter_mut().filter(|stored| stored.caster == ALL_STATIC);
            all.for_each(|stored| renew(&mut stored.version));
        }
    }

    /// Returns the revision of a tile's contents.
    pub(super) fn revision(&self, rect: TileRect) -> Option<Revision> {
        find(&self.state().tiles, rect).map(|(_, revision)| *revision)
    }

    /// Marks the whole map as cleared.
    pub(super) fn mark_cleared(&self) {
        self.state().drawn = true;
    }

    /// Stores the contents of a tile.
    pub(super) fn set_tile(&self, rect: TileRect, held: Held, revision: Revision) {
        let mut state = self.state();
        // Where the tiles of a frame cover the whole map, the graph culls its clear.
        state.drawn = true;
        replace(&mut state.tiles, rect, (held, revision));
    }

    /// Stores the contents of a tile of a new map in which nothing is drawn.
    pub(super) fn set_empty(&self, rect: TileRect, held: Held) {
        replace(&mut self.state().tiles, rect, (held, 0));
    }

    /// Returns the store for a frame that needs it; it is created by the first.
    pub(super) fn store(&self, device: &wgpu::Device, name: &str) -> wgpu::Texture {
        let mut state = self.state();
        let size_px = [self.texture.width(), self.texture.height()];
        let make = || Store {
            texture: texture(device, name, size_px, self.texture.format()),
            tiles: Vec::new(),
            unused_frames: 0,
        };
        let store = state.store.get_or_insert_with(make);
        store.unused_frames = 0;
        store.texture.clone()
    }

    /// Counts a frame that does not need the store, which is dropped if many have not.
    pub(super) fn skip_store(&self) {
        let mut state = self.state();
        let Some(store) = &mut state.store else { return };
        store.unused_frames += 1;
        if store.unused_frames > KEPT_FRAMES {
            state.store = None;
        }
    }

    /// Stores the contents of a tile of the store.
    pub(super) fn set_stored(&self, rect: TileRect, stored: Stored) {
        if let Some(store) = &mut self.state().store {
            replace(&mut store.tiles, rect, stored);
        }
    }
}

pub(crate) fn find<T>(tiles: &[(TileRect, T)], rect: TileRect) -> Option<&T> {
    tiles.iter().find(|(other, _)| *other == rect).map(|(_, contents)| contents)
}

pub(crate) fn replace<T>(tiles: &mut Vec<(TileRect, T)>, rect: TileRect, contents: T) {
    tiles.retain(|(other, _)| !other.overlaps(&rect));
    tiles.push((rect, contents));
}

fn texture(
    device: &wgpu::Device,
    name: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}
