//! The passes that draw maps.

use std::sync::{Arc, PoisonError};

use shadowgraph_core::{Bind, Contents, Format, Frame, Part, Texture, TextureDesc};

use super::cache::{CachedMap, TileKey};
use super::{DrawnMap, ShadowMaps, Views};
use crate::{MapPlan, ShadowCasters, ShadowView, TilePart, TilePlan, TileRect};

/// The bytes of a view: also the step of its dynamic offset.
const VIEW_BYTES: u64 = size_of::<ShadowView>() as u64;

impl ShadowMaps {
    /// Adds the passes that draw a map, or imports the texel that means lit.
    pub(super) fn map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: Option<MapPlan>,
        (view, views): (u32, Views<'_>),
        casters: &'f dyn ShadowCasters,
    ) -> DrawnMap {
        let tiles = plan.iter().flat_map(|plan| &plan.tiles).map(|tile| (tile.rect, tile.view)).collect();
        let cached = plan.as_ref().filter(|plan| plan.cache).map(|plan| self.cached_map(view, name, plan));
        if cached.is_none() {
            self.cached.lock().unwrap_or_else(PoisonError::into_inner).remove(&(view, name));
        }
        let texture = match (plan, cached) {
            (None, _) => frame.import_texture(format_args!("no {name}"), &self.lit, true),
            (Some(plan), None) => self.draw_map(frame, name, plan, views, casters),
            (Some(plan), Some(cached)) => self.update_map(frame, name, plan, (cached, views), casters),
        };
        DrawnMap { texture, tiles }
    }

    /// Draws a map anew.
    fn draw_map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: MapPlan,
        views: Views<'_>,
        casters: &'f dyn ShadowCasters,
    ) -> Texture {
        let [width, height] = plan.size_px;
        let format = plan.depth.texture_format();
        let mut map = frame.create_texture(name, TextureDesc::d2(width, height, format));
        frame.node(name, |frame| {
            // All of the map, as shaders sample it whole and its tiles need not cover it. Tiles do not overlap, so
            // nothing orders them among each other, and all become one render pass that begins with this clear.
            frame.render_pass("clear").depth(&mut map, Contents::clear_depth(0.0));
            for tile in plan.tiles.into_iter().filter(|tile| !tile.casters.is_empty()) {
                self.tile(frame, (&mut map, format, Contents::Preserve), tile, views, casters, |_| ());
            }
        });
        map
    }

    /// Draws those tiles of a map again that do not hold what they should.
    fn update_map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: MapPlan,
        (cached, views): (Arc<CachedMap>, Views<'_>),
        casters: &'f dyn ShadowCasters,
    ) -> Texture {
        let format = plan.depth.texture_format();
        let cleared = cached.is_cleared();
        let mut map = frame.import_texture(name, &cached.texture, cleared);
        frame.node(name, |frame| {
            if !cleared {
                let cached = cached.clone();
                let mut pass = frame.render_pass("clear");
                pass.depth(&mut map, Contents::clear_depth(0.0));
                pass.body(move |_| {
                    cached.note_clear();
                    Ok(())
                });
            }
            for tile in plan.tiles {
                let key = TileKey::new(&tile, &views.1[tile.view as usize], casters);
                if key.as_ref().is_some_and(|key| cached.holds(tile.rect, key)) {
                    continue;
                }
                // What a pass has drawn is known when it has been recorded, not when it is declared.
                let cached = cached.clone();
                let note = move |rect| cached.note(rect, key);
                self.tile(frame, (&mut map, format, Contents::clear_depth(0.0)), tile, views, casters, note);
            }
        });
        map
    }

    fn cached_map(&self, view: u32, name: &'static str, plan: &MapPlan) -> Arc<CachedMap> {
        let mut all = self.cached.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || Arc::new(CachedMap::new(&self.device, name, plan));
        let cached = all.entry((view, name)).or_insert_with(make);
        if !cached.fits(plan) {
            *cached = make();
        }
        cached.clone()
    }

    /// Adds the pass that draws casters into a tile; `then` is called when it has been recorded.
    fn tile<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (map, format, contents): (&mut Texture, Format, Contents),
        tile: TilePlan,
        (buffer, views): Views<'_>,
        casters: &'f dyn ShadowCasters,
        then: impl FnOnce(TileRect) + Send + 'f,
    ) {
        let light = tile.light;
        let mut pass = match tile.part {
            TilePart::Cascade(cascade) => frame.render_pass(format_args!("cascade {cascade}")),
            TilePart::Face(face) => frame.render_pass(format_args!("light {light} face {face}")),
            TilePart::Whole => frame.render_pass(format_args!("light {light}")),
        };
        let buffer = pass.storage_buffer(buffer);
        // The graph keeps viewport and scissor to the tile.
        pass.on(Part::WHOLE.rect(tile.rect.into())).depth(map, contents);
        let caster_view = tile.caster_view(&views[tile.view as usize], format);
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.view_layout, &[Bind::BufferRange(buffer, 0..VIEW_BYTES)])?;
            ctx.pass.set_bind_group(0, &group, &[tile.view * VIEW_BYTES as u32]);
            casters.draw(&mut ctx.pass, &caster_view, &tile.casters);
            then(tile.rect);
            Ok(())
        });
    }
}
