//! Maps of moments that are kept from frame to frame, and which tiles of a frame they already have.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use shadowgraph_core::{Format, TextureDesc};

use crate::atlas::TileRect;
use crate::maps::cache::{Revision, find, replace};

/// The rectangles of tiles in the depth map, and the revisions of their contents.
pub(super) type TileRevisions = Vec<(TileRect, Revision)>;

/// A kept map of moments.
pub(super) struct KeptMoments {
    pub(super) texture: wgpu::Texture,
    /// The technique's settings, which every moment depends on.
    settings: Vec<u8>,
    /// The contents of the depth map whose moments each tile has: they say how depths are read, too.
    tiles: Mutex<TileRevisions>,
}

impl KeptMoments {
    fn tiles(&self) -> MutexGuard<'_, TileRevisions> {
        self.tiles.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns whether it has the moments of these contents of a tile.
    pub(super) fn has(&self, rect: TileRect, revision: Revision) -> bool {
        find(&self.tiles(), rect) == Some(&revision)
    }

    /// Notes the moments of tiles that a pass has computed.
    pub(super) fn set(&self, computed: &TileRevisions) {
        let mut tiles = self.tiles();
        for &(rect, revision) in computed {
            replace(&mut tiles, rect, revision);
        }
    }
}

/// The kept maps, by view and name.
#[derive(Default)]
pub(super) struct AllMoments(Mutex<BTreeMap<(u32, &'static str), Arc<KeptMoments>>>);

impl AllMoments {
    fn all(&self) -> MutexGuard<'_, BTreeMap<(u32, &'static str), Arc<KeptMoments>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns a map for these settings: an empty one where there was another.
    pub(super) fn get(
        &self,
        device: &wgpu::Device,
        key: (u32, &'static str),
        desc: &TextureDesc,
        settings: &[u8],
    ) -> Arc<KeptMoments> {
        let mut all = self.all();
        let found = all.get(&key).filter(|kept| kept.settings == settings && fits(&kept.texture, desc));
        if let Some(kept) = found {
            return kept.clone();
        }
        let texture = texture(device, key.1, desc);
        let kept = KeptMoments { texture, settings: settings.to_vec(), tiles: Mutex::default() };
        let kept = Arc::new(kept);
        all.insert(key, kept.clone());
        kept
    }

    /// Drops a map.
    pub(super) fn evict(&self, key: (u32, &'static str)) {
        self.all().remove(&key);
    }
}

fn fits(texture: &wgpu::Texture, desc: &TextureDesc) -> bool {
    let format: Format = texture.format();
    texture.size() == desc.size && format == desc.format && texture.mip_level_count() == desc.mip_levels
}

fn texture(device: &wgpu::Device, name: &str, desc: &TextureDesc) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(name),
        size: desc.size,
        mip_level_count: desc.mip_levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: desc.format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::STORAGE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}
