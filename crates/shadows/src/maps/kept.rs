//! The passes that bring kept maps up to date.

use std::sync::atomic::Ordering;
use std::sync::{Arc, PoisonError};

use shadowgraph_core::{Bind, Buffer, Contents, Frame, Subresource, Texture};

use super::ShadowMaps;
use super::cache::{CachedMap, Revision};
use super::contents::Work;
use super::draw::{MapTexture, Source, Target, TileDraws};
use super::queries::Queries;
use super::reasons::tile_name;
use super::restore::Restore;
use super::scroll::Piece;
use super::store_draws::{Fills, StoreDraw, TileFill};
use super::tile::{Tile, plan_tile};
use crate::caster_view::CasterPass;
use crate::culled::CulledInstances;
use crate::error::Error;
use crate::vertex_buffers::VertexBuffers;

/// The store of static casters in a frame, and what copies from it.
struct Store {
    texture: Texture,
    restore: Arc<Restore>,
}

impl ShadowMaps {
    /// Adds the passes that bring a kept texture up to date, and returns it with the revisions of its tiles.
    pub(super) fn update<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        depth: Option<&Texture>,
        source: Source<'_, 'f>,
    ) -> Result<(Texture, Vec<Revision>), Error> {
        let cached = self.cached(source.view, map);
        let mut queries = Queries::default();
        let plan = |tile| plan_tile(&cached, map, tile, source, &mut queries);
        let tiles: Vec<_> = map.plan.tiles.iter().map(plan).collect();
        let fills = Fills::new(&tiles, source, &mut queries);
        let is_defined = map.pass != CasterPass::Tint || !cached.is_new();
        let mut texture = frame.import_texture(map.name, &cached.texture, is_defined);
        for tile in tiles.iter().filter(|tile| !tile.wanted.is_empty()) {
            frame.note(&texture, format_args!("{} {}", tile_name(tile.plan), tile.reason));
        }
        frame.node(map.name, |frame| {
            let culled = queries.add_to(frame, source.casters);
            let culled = culled.as_ref();
            self.clear(frame, map, &cached, &mut texture, &tiles);
            let store = self.update_store(frame, (map, &cached), source, (&tiles, fills), culled)?;
            let mut revisions = Vec::with_capacity(tiles.len());
            for tile in &tiles {
                let target = (&mut texture, depth, store.as_ref());
                revisions.push(self.update_tile(frame, map, target, source, (tile, culled), &cached));
            }
            Ok((texture, revisions))
        })
    }

    /// Clears a new texture of tints. wgpu initializes those of depth with zeros, the far end.
    fn clear<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        cached: &Arc<CachedMap>,
        texture: &mut Texture,
        tiles: &[Tile<'_>],
    ) {
        if !cached.is_new() {
            return;
        }
        // True whether this frame is executed or not: a new texture is empty.
        for tile in tiles.iter().filter(|tile| tile.casters.is_empty()) {
            cached.set_empty(tile.plan.rect, tile.held());
        }
        if map.pass == CasterPass::Tint {
            let cached = cached.clone();
            map.clear(frame, texture).body(move |_| {
                cached.mark_cleared();
                Ok(())
            });
        }
    }

    /// Draws what is missing in the store, and returns it if a tile needs it.
    fn update_store<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (map, cached): (&MapTexture<'_>, &Arc<CachedMap>),
        source: Source<'_, 'f>,
        (tiles, fills): (&[Tile<'_>], Fills<'_>),
        culled: Option<&CulledInstances>,
    ) -> Result<Option<Store>, Error> {
        if !tiles.iter().any(|tile| matches!(tile.work, Work::OverStore(_))) {
            cached.skip_store();
            return Ok(None);
        }
        let restore = self.restore(map.format())?;
        let store = cached.store(&self.device, map.name);
        let mut texture = frame.import_texture(format_args!("static {}", map.name), &store, true);
        if fills.draws.is_empty() {
            return Ok(Some(Store { texture, restore }));
        }
        let bytes: Vec<u8> = bytemuck::cast_slice(&fills.views).to_vec();
        let buffer = frame.upload_buffer(format_args!("views of static {}", map.name), bytes);
        for fill in fills.draws {
            let target = (map, &mut texture, &buffer);
            self.fill_tile(frame, target, source, (fill, culled), (cached, &restore));
        }
        Ok(Some(Store { texture, restore }))
    }

    /// Adds the pass that draws what is missing in a tile of the store.
    fn fill_tile<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (map, store, views): (&MapTexture<'_>, &mut Texture, &Buffer),
        source: Source<'_, 'f>,
        (TileFill { tile, fill, draws }, culled): (TileFill<'_>, Option<&CulledInstances>),
        (cached, restore): (&Arc<CachedMap>, &Arc<Restore>),
    ) {
        let rect = tile.plan.rect;
        let buffers = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass(format_args!("{} static", tile_name(tile.plan)));
        buffers.read_in(&mut pass);
        pass.note(format_args!("{}", tile.reason));
        pass.subresource(Subresource::FULL.rect(rect.into())).depth(store, Contents::Preserve);
        let mut tile_draws = TileDraws {
            layout: &self.view_layout,
            views: pass.storage_buffer(views),
            view: 0,
            caster_view: map.caster_view(tile.plan, source.views.1),
            all: source.casters,
            casters: Vec::new(),
            culled: None,
        };
        let read = |draw: StoreDraw| (draw.casters.read_in(&mut pass, culled), draw);
        let draws: Vec<_> = draws.into_iter().map(read).collect();
        let stored = tile.stored(fill, source.casters);
        let (cached, restore) = (cached.clone(), restore.clone());
        pass.body(move |ctx| {
            for (culled, StoreDraw { piece: Piece { rect: part, tile_at }, view, clears, casters }) in draws {
                let ([x, y], [width, height]) = (tile_at.map(|at| at as f32), [rect.width, rect.height]);
                ctx.pass.set_viewport(x, y, width as f32, height as f32, 0.0, 1.0);
                ctx.pass.set_scissor_rect(part.x, part.y, part.width, part.height);
                if clears {
                    ctx.pass.set_pipeline(&restore.clear);
                    ctx.pass.draw(0..3, 0..1);
                }
                (tile_draws.view, tile_draws.casters, tile_draws.culled) = (view, casters.listed, culled);
                tile_draws.record(ctx)?;
            }
            cached.set_stored(rect, stored);
            Ok(())
        });
    }

    /// Adds the pass that brings a tile of the map up to date, if it needs one, and returns the revision of its contents.
    fn update_tile<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        (texture, depth, store): (&mut Texture, Option<&Texture>, Option<&Store>),
        source: Source<'_, 'f>,
        (tile, culled): (&Tile<'_>, Option<&CulledInstances>),
        cached: &Arc<CachedMap>,
    ) -> Revision {
        let is_new = cached.is_new();
        let kept = cached.revision(tile.plan.rect).unwrap_or_default();
        let copied = match (&tile.work, store) {
            (Work::Nothing, _) => return kept,
            (Work::All { .. }, _) if is_new && tile.casters.is_empty() => return kept,
            (Work::OverStore(fill), Some(store)) => {
                let block = tile.restore_block(fill);
                Some((store, frame.uniform(bytemuck::bytes_of(&block))))
            }
            _ => None,
        };
        let contents = if copied.is_some() || is_new { Contents::Preserve } else { map.empty() };
        let target = Target { texture, depth, contents };
        let casters = (tile.casters.clone(), culled);
        let (mut pass, draws) = self.tile(frame, map, target, tile.plan, source, casters);
        pass.note(&tile.reason);
        let copied = copied.map(|(Store { texture, restore }, block)| {
            let store = pass.subresource(Subresource::FULL.rect(tile.plan.rect.into())).sample(texture);
            (store, restore.clone(), block)
        });
        // The contents are stored when the pass is recorded, not when it is declared.
        let revision = 1 + self.revisions.fetch_add(1, Ordering::Relaxed);
        let (cached, rect, held) = (cached.clone(), tile.plan.rect, tile.held());
        pass.body(move |ctx| {
            if let Some((store, restore, block)) = copied {
                let group = ctx.bind_group(&restore.layout, &[Bind::Texture(store), Bind::Uniform(block)])?;
                ctx.pass.set_pipeline(&restore.copy);
                ctx.pass.set_bind_group(0, &group, &[]);
                ctx.pass.draw(0..3, 0..1);
            }
            draws.record(ctx)?;
            cached.set_tile(rect, held, revision);
            Ok(())
        });
        revision
    }

    fn cached(&self, view: u32, map: &MapTexture<'_>) -> Arc<CachedMap> {
        let mut all = self.cached.lock().unwrap_or_else(PoisonError::into_inner);
        let (size_px, format) = (map.plan.size_px, map.format());
        let make = || Arc::new(CachedMap::new(&self.device, map.name, size_px, format));
        let cached = all.entry((view, map.name)).or_insert_with(make);
        if !cached.fits(size_px, format) {
            *cached = make();
        }
        cached.clone()
    }

    /// Drops a kept texture.
    pub(super) fn evict(&self, view: u32, name: &'static str) {
        self.cached.lock().unwrap_or_else(PoisonError::into_inner).remove(&(view, name));
    }

    /// Returns the pipelines of a format, which are created when a frame first needs them.
    fn restore(&self, format: wgpu::TextureFormat) -> Result<Arc<Restore>, Error> {
        let mut all = self.restore.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, restore)) = all.iter().find(|(other, _)| *other == format) {
            return Ok(restore.clone());
        }
        let restore = Arc::new(Restore::new(&self.device, format)?);
        all.push((format, restore.clone()));
        Ok(restore)
    }
}
