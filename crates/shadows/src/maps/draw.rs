//! The passes that draw maps.

use std::sync::{Arc, PoisonError};

use shadowgraph_core::{Bind, Contents, Format, Frame, Pass, Rendering, Subresource, Texture, TextureDesc};

use super::cache::{CachedMap, TileKey};
use super::{DrawnMap, ShadowMaps, Views};
use crate::atlas::TileRect;
use crate::casters::{CasterPass, ShadowCasters, TINT_FORMAT, TileKind};
use crate::plan::{MapPlan, TilePlan};
use crate::vertex_buffers::VertexBuffers;
use crate::views::ShadowView;

/// Size of a view, bytes: also the step of its dynamic offset.
const VIEW_BYTES: u64 = size_of::<ShadowView>() as u64;

/// The names of a map's textures.
#[derive(Clone, Copy)]
pub(super) struct Names {
    depth: &'static str,
    tint_depth: &'static str,
    tint: &'static str,
}

/// The textures of the map of cascades.
pub(super) const CASCADES: Names =
    Names { depth: "cascades", tint_depth: "cascade tint depths", tint: "cascade tints" };

/// The textures of the map of other lights.
pub(super) const ATLAS: Names =
    Names { depth: "atlas", tint_depth: "atlas tint depths", tint: "atlas tints" };

/// The views and casters that tiles are drawn from.
#[derive(Clone, Copy)]
pub(super) struct Source<'v, 'f> {
    /// Index of the frame's view.
    pub(super) view: u32,
    pub(super) views: Views<'v>,
    pub(super) casters: &'f dyn ShadowCasters,
}

/// One of the textures of a map.
struct MapTexture<'p> {
    name: &'static str,
    pass: CasterPass,
    plan: &'p MapPlan,
}

impl MapTexture<'_> {
    fn format(&self) -> Format {
        if self.pass == CasterPass::Tint { TINT_FORMAT } else { self.plan.depth.texture_format() }
    }

    /// Returns the contents where nothing is drawn.
    fn empty(&self) -> Contents {
        if self.pass == CasterPass::Tint {
            Contents::clear_color([1.0; 4])
        } else {
            Contents::clear_depth(0.0)
        }
    }

    /// Adds the pass that clears the whole texture.
    fn clear<'p, 'f>(&self, frame: &'p mut Frame<'f>, texture: &mut Texture) -> Pass<'p, 'f, Rendering> {
        let mut pass = frame.render_pass("clear");
        match self.pass {
            CasterPass::Tint => pass.color(texture, self.empty()),
            _ => pass.depth(texture, self.empty()),
        };
        pass
    }

    /// Returns the contents of a tile.
    fn key(&self, tile: &TilePlan, source: Source<'_, '_>) -> Option<TileKey> {
        // Opaque casters hide tints.
        let hiding = if self.pass == CasterPass::Tint { &tile.casters[..] } else { &[] };
        let casters = tile.casters_of(self.pass).iter().chain(hiding).copied();
        TileKey::new(&source.views.1[tile.view as usize], casters, source.casters)
    }
}

/// The textures that a pass draws into.
struct Target<'t> {
    texture: &'t mut Texture,
    /// The depth that colours are tested against.
    depth: Option<&'t Texture>,
    contents: Contents,
}

impl ShadowMaps {
    /// Adds the passes that draw a map, or imports lit placeholders.
    pub(super) fn map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        names: Names,
        plan: Option<&MapPlan>,
        source: Source<'_, 'f>,
    ) -> DrawnMap {
        let tiles = plan.iter().flat_map(|plan| &plan.tiles).map(|tile| (tile.rect, tile.view)).collect();
        let is_tinted = |plan: &&MapPlan| plan.tiles.iter().any(|tile| !tile.tints.is_empty());
        let tinted = plan.filter(is_tinted);
        let mut texture_or_lit = |name, pass, plan, lit, depth: Option<&Texture>| match plan {
            Some(plan) => self.map_texture(frame, &MapTexture { name, pass, plan }, depth, source),
            None => {
                self.evict(source.view, name);
                frame.import_texture(format_args!("no {name}"), lit, true)
            }
        };
        let texture = texture_or_lit(names.depth, CasterPass::Depth, plan, &self.lit, None);
        let tint_depths = texture_or_lit(names.tint_depth, CasterPass::TintDepth, tinted, &self.lit, None);
        let tints = texture_or_lit(names.tint, CasterPass::Tint, tinted, &self.untinted, Some(&texture));
        DrawnMap { texture, tints, tint_depths, tiles }
    }

    /// Draws one of a map's textures, or its outdated tiles if it is cached.
    fn map_texture<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        depth: Option<&Texture>,
        source: Source<'_, 'f>,
    ) -> Texture {
        if map.plan.cache {
            return self.update(frame, map, depth, source);
        }
        self.evict(source.view, map.name);
        let [width, height] = map.plan.size_px;
        let mut texture = frame.create_texture(map.name, TextureDesc::d2(width, height, map.format()));
        frame.node(map.name, |frame| {
            // The whole map, as shaders sample all of it and its tiles need not cover it. Tiles do not overlap, so
            // they do not depend on each other, and all merge into one render pass that begins with this clear.
            map.clear(frame, &mut texture);
            for tile in map.plan.tiles.iter().filter(|tile| !tile.casters_of(map.pass).is_empty()) {
                let target = Target { texture: &mut texture, depth, contents: Contents::Preserve };
                self.tile(frame, map, target, tile, source, |_| ());
            }
        });
        texture
    }

    /// Draws the outdated tiles of a cached texture.
    fn update<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        depth: Option<&Texture>,
        source: Source<'_, 'f>,
    ) -> Texture {
        let cached = self.cached(source.view, map);
        let cleared = cached.is_cleared();
        let mut texture = frame.import_texture(map.name, &cached.texture, cleared);
        frame.node(map.name, |frame| {
            if !cleared {
                let cached = cached.clone();
                map.clear(frame, &mut texture).body(move |_| {
                    cached.mark_cleared();
                    Ok(())
                });
            }
            for tile in &map.plan.tiles {
                let key = map.key(tile, source);
                if key.as_ref().is_some_and(|key| cached.holds(tile.rect, key)) {
                    continue;
                }
                // The contents are stored when the pass is recorded, not when it is declared.
                let cached = cached.clone();
                let store = move |rect| cached.set_tile(rect, key);
                let target = Target { texture: &mut texture, depth, contents: map.empty() };
                self.tile(frame, map, target, tile, source, store);
            }
        });
        texture
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

    /// Drops a cached texture.
    fn evict(&self, view: u32, name: &'static str) {
        self.cached.lock().unwrap_or_else(PoisonError::into_inner).remove(&(view, name));
    }

    /// Adds the pass that draws casters into a tile; `then` is called when the pass has been recorded.
    fn tile<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        target: Target<'_>,
        tile: &TilePlan,
        source: Source<'_, 'f>,
        then: impl FnOnce(TileRect) + Send + 'f,
    ) {
        let (light, rect, view) = (tile.light, tile.rect, tile.view);
        let buffers = VertexBuffers::published_in(frame);
        let mut pass = match tile.kind {
            TileKind::Cascade(cascade) => frame.render_pass(format_args!("cascade {cascade}")),
            TileKind::Face(face) => frame.render_pass(format_args!("light {light} face {face}")),
            TileKind::Whole => frame.render_pass(format_args!("light {light}")),
        };
        buffers.read_in(&mut pass);
        let (buffer, views) = source.views;
        let buffer = pass.storage_buffer(buffer);
        // The graph limits viewport and scissor to the tile.
        let part = Subresource::FULL.rect(rect.into());
        match target.depth {
            None => pass.subresource(part).depth(target.texture, target.contents),
            Some(depth) => {
                pass.subresource(part).color(target.texture, target.contents);
                pass.subresource(part).depth_read(depth)
            }
        };
        let format = map.plan.depth.texture_format();
        let caster_view = tile.caster_view(&views[view as usize], map.pass, format);
        let (all, casters) = (source.casters, tile.casters_of(map.pass).to_vec());
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.view_layout, &[Bind::BufferRange(buffer, 0..VIEW_BYTES)])?;
            ctx.pass.set_bind_group(0, &group, &[view * VIEW_BYTES as u32]);
            let draws = all.draw(&mut ctx.pass, &caster_view, &casters);
            ctx.report_draws(draws);
            then(rect);
            Ok(())
        });
    }
}
