//! Maps that are cached from frame to frame, and the contents of their tiles.

use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::atlas::TileRect;
use crate::casters::ShadowCasters;
use crate::views::ShadowView;

/// A cached map.
pub(super) struct CachedMap {
    pub(super) texture: wgpu::Texture,
    drawn: Mutex<Drawn>,
}

/// The contents that the passes of recorded frames have drawn.
#[derive(Default)]
struct Drawn {
    /// Whether the whole map has been cleared once.
    cleared: bool,
    tiles: Vec<(TileRect, TileKey)>,
}

/// The contents of a tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TileKey {
    clip_from_world: glam::Mat4,
    /// The casters and the versions that were drawn.
    casters: Vec<(u32, u64)>,
}

impl TileKey {
    /// Returns `None` if a caster may change at any time.
    pub(super) fn new(
        view: &ShadowView,
        casters: impl Iterator<Item = u32>,
        all: &dyn ShadowCasters,
    ) -> Option<Self> {
        let version = |caster| all.version(caster).map(|version| (caster, version));
        let casters = casters.map(version).collect::<Option<_>>()?;
        Some(Self { clip_from_world: view.clip_from_world, casters })
    }
}

impl CachedMap {
    pub(super) fn new(
        device: &wgpu::Device,
        name: &str,
        [width, height]: [u32; 2],
        format: wgpu::TextureFormat,
    ) -> Self {
        let usage = wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some(name),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        Self { texture, drawn: Mutex::default() }
    }

    /// Returns whether it has this size and format.
    pub(super) fn fits(&self, size_px: [u32; 2], format: wgpu::TextureFormat) -> bool {
        [self.texture.width(), self.texture.height()] == size_px && self.texture.format() == format
    }

    fn drawn(&self) -> MutexGuard<'_, Drawn> {
        self.drawn.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn is_cleared(&self) -> bool {
        self.drawn().cleared
    }

    /// Returns whether the tile has these contents already.
    pub(super) fn holds(&self, rect: TileRect, key: &TileKey) -> bool {
        self.drawn().tiles.iter().any(|(other, held)| *other == rect && held == key)
    }

    /// Marks the whole map as cleared.
    pub(super) fn mark_cleared(&self) {
        *self.drawn() = Drawn { cleared: true, tiles: Vec::new() };
    }

    /// Stores the contents of a tile; `None` if it must be drawn again.
    pub(super) fn set_tile(&self, rect: TileRect, key: Option<TileKey>) {
        let mut drawn = self.drawn();
        // Where the tiles of a frame cover the whole map, the graph culls its clear.
        drawn.cleared = true;
        drawn.tiles.retain(|(other, _)| !other.overlaps(&rect));
        drawn.tiles.extend(key.map(|key| (rect, key)));
    }
}
