//! The passes that draw maps.

use shadowgraph_core::{
    Bind, BodyResult, BufferToken, Contents, Format, Frame, Pass, RenderContext, Rendering, Subresource,
    Texture, TextureDesc,
};

use super::cache::Revision;
use super::queries::{Queries, TileCasters};
use super::reasons::tile_name;
use super::{DrawnMap, ShadowMaps, Views};
use crate::caster_view::{CasterPass, CasterView, TINT_FORMAT};
use crate::casters::ShadowCasters;
use crate::culled::{CulledInstances, CulledTokens};
use crate::error::Error;
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
    /// See [`ShadowInputs::origin_world`](crate::ShadowInputs::origin_world).
    pub(super) origin_world: glam::DVec3,
    pub(super) views: Views<'v>,
    pub(super) casters: &'f dyn ShadowCasters,
}

/// One of the textures of a map.
pub(super) struct MapTexture<'p> {
    pub(super) name: &'static str,
    pub(super) pass: CasterPass,
    pub(super) plan: &'p MapPlan,
}

impl MapTexture<'_> {
    pub(super) fn format(&self) -> Format {
        if self.pass == CasterPass::Tint { TINT_FORMAT } else { self.plan.depth.texture_format() }
    }

    /// Returns the contents where nothing is drawn.
    pub(super) fn empty(&self) -> Contents {
        if self.pass == CasterPass::Tint {
            Contents::clear_color([1.0; 4])
        } else {
            Contents::clear_depth(0.0)
        }
    }

    /// Adds the pass that clears the whole texture.
    pub(super) fn clear<'p, 'f>(
        &self,
        frame: &'p mut Frame<'f>,
        texture: &mut Texture,
    ) -> Pass<'p, 'f, Rendering> {
        let mut pass = frame.render_pass("clear");
        match self.pass {
            CasterPass::Tint => pass.color(texture, self.empty()),
            _ => pass.depth(texture, self.empty()),
        };
        pass
    }

    /// Describes a tile for the casters.
    pub(super) fn caster_view(&self, tile: &TilePlan, views: &[ShadowView]) -> CasterView {
        let format = self.plan.depth.texture_format();
        tile.caster_view(&views[tile.view as usize], self.pass, format)
    }
}

/// The textures that a pass draws into.
pub(super) struct Target<'t> {
    pub(super) texture: &'t mut Texture,
    /// The depth that colours are tested against.
    pub(super) depth: Option<&'t Texture>,
    pub(super) contents: Contents,
}

impl ShadowMaps {
    /// Adds the passes that draw a map, or imports lit placeholders.
    pub(super) fn map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        names: Names,
        plan: Option<&MapPlan>,
        source: Source<'_, 'f>,
    ) -> Result<DrawnMap, Error> {
        let tiles = plan.iter().flat_map(|plan| &plan.tiles).map(|tile| (tile.rect, tile.view)).collect();
        let is_tinted = |plan: &&MapPlan| plan.tiles.iter().any(|tile| !tile.tints.is_empty());
        let tinted = plan.filter(is_tinted);
        let mut texture_or_lit = |name, pass, plan, lit, depth: Option<&Texture>| match plan {
            Some(plan) => self.map_texture(frame, &MapTexture { name, pass, plan }, depth, source),
            None => {
                self.evict(source.view, name);
                Ok((frame.import_texture(format_args!("no {name}"), lit, true), Vec::new()))
            }
        };
        let (texture, revisions) = texture_or_lit(names.depth, CasterPass::Depth, plan, &self.lit, None)?;
        let (tint_depths, _) =
            texture_or_lit(names.tint_depth, CasterPass::TintDepth, tinted, &self.lit, None)?;
        let (tints, _) =
            texture_or_lit(names.tint, CasterPass::Tint, tinted, &self.untinted, Some(&texture))?;
        Ok(DrawnMap { texture, tints, tint_depths, tiles, revisions })
    }

    /// Draws one of a map's textures, or what has changed in it if it is kept, and then returns the revisions of its tiles too.
    fn map_texture<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        map: &MapTexture<'_>,
        depth: Option<&Texture>,
        source: Source<'_, 'f>,
    ) -> Result<(Texture, Vec<Revision>), Error> {
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
            let mut queries = Queries::default();
            let tiles = map.plan.tiles.iter().filter(|tile| !tile.is_empty(map.pass));
            let tiles: Vec<_> =
                tiles.map(|tile| (tile, TileCasters::seen(tile, map.pass, &mut queries))).collect();
            let culled = queries.add_to(frame, source.casters);
            for (tile, casters) in tiles {
                let target = Target { texture: &mut texture, depth, contents: Contents::Preserve };
                let (pass, draws) = self.tile(frame, map, target, tile, source, (casters, culled.as_ref()));
                pass.body(move |ctx| draws.record(ctx));
            }
        });
        Ok((texture, Vec::new()))
    }

    /// Adds the pass that draws casters into a tile, without its body.
    pub(super) fn tile<'p, 'f>(
        &'f self,
        frame: &'p mut Frame<'f>,
        map: &MapTexture<'_>,
        target: Target<'_>,
        tile: &TilePlan,
        source: Source<'_, 'f>,
        (casters, culled): (TileCasters, Option<&CulledInstances>),
    ) -> (Pass<'p, 'f, Rendering>, TileDraws<'f>) {
        let buffers = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass(tile_name(tile));
        buffers.read_in(&mut pass);
        let (buffer, views) = source.views;
        let token = pass.storage_buffer(buffer);
        // The graph limits viewport and scissor to the tile.
        let part = Subresource::FULL.rect(tile.rect.into());
        match target.depth {
            None => pass.subresource(part).depth(target.texture, target.contents),
            Some(depth) => {
                pass.subresource(part).color(target.texture, target.contents);
                pass.subresource(part).depth_read(depth)
            }
        };
        let draws = TileDraws {
            layout: &self.view_layout,
            views: token,
            view: tile.view,
            caster_view: map.caster_view(tile, views),
            all: source.casters,
            culled: casters.read_in(&mut pass, culled),
            casters: casters.listed,
        };
        (pass, draws)
    }
}

/// The draws of some casters into a tile.
pub(super) struct TileDraws<'f> {
    pub(super) layout: &'f wgpu::BindGroupLayout,
    pub(super) views: BufferToken,
    /// Index of the view in `views`.
    pub(super) view: u32,
    pub(super) caster_view: CasterView,
    pub(super) all: &'f dyn ShadowCasters,
    pub(super) casters: Vec<u32>,
    /// Casters that the GPU has culled.
    pub(super) culled: Option<CulledTokens>,
}

impl TileDraws<'_> {
    /// Records the draws.
    pub(super) fn record(&self, ctx: &mut RenderContext<'_>) -> BodyResult {
        let group = ctx.bind_group(self.layout, &[Bind::BufferRange(self.views, 0..VIEW_BYTES)])?;
        ctx.pass.set_bind_group(0, &group, &[self.view * VIEW_BYTES as u32]);
        let mut draws = 0;
        if let (Some(culled), Some(gpu)) = (self.culled, self.all.gpu()) {
            draws += gpu.draw(ctx, &self.caster_view, culled)?;
        }
        draws += self.all.draw(&mut ctx.pass, &self.caster_view, &self.casters);
        ctx.report_draws(draws);
        Ok(())
    }
}
