//! The casters of an engine's scene, for views that passes of a frame write.

use shadowgraph_core::{
    Buffer, BufferToken, Contents, Error as GraphError, Frame, Pass, RenderContext, Rendering,
};
use shadowgraph_scene::Aabb;

/// Casters that are drawn in views that only the GPU knows: each view has a layer of a buffer of depths. The WGSL module
/// `shadowgraph::layer_views` has the types. A view has the static casters, the moving ones, or both.
///
/// `shadowgraph-lighting` and `shadowgraph-scene` implement it for a `GpuScene`: `LayerCullPass` and `draw_layers` with `cull_layers.wgsl`,
/// `LayerPipelines` with `depth_layers.wgsl`. An engine with its own scene does the same:
///
/// - **Culling** ([`cull_layers`](Self::cull_layers)): of the first `min(count, capacity)` views of `LayerViews`, it finds the casters whose bounds
///   may intersect the view, or what is nearer to the light than it. `clip_from_world` takes positions relative to the frame's origin. It writes
///   `LayerViews::drawn`, how many of the first views fit into its lists (the others are requested again in the next frame), and `pairs`, the
///   number of casters over all views. What `draws` and `pairs` of [`LayeredInstances`] contain is up to the engine.
/// - **Drawing** ([`draw_layers`](Self::draw_layers)): instances are pairs of a caster and a view. There is no depth attachment; the colour attachment is
///   [`R8Unorm`](wgpu::TextureFormat::R8Unorm), and nothing is written to it. The fragment stage keeps the largest depth: with s = `side_px`, it is
///   `atomicMax(&depths[(view * s + y) * s + x], bitcast<u32>(depth))` at pixel (x, y). Depth is z/w, less `slope_bias` times its change to the next
///   pixel, clamped to 0 to 1. Geometry in front of the near plane must not be clipped: output a z of w / 2, and pass z and w to the fragment stage.
///   Dithered casters take their noise at pixel + `noise_px`, so that it stays in place.
///
/// Layers hold the bits of floats: 1 nearest to the light, 0 farthest and empty. Casters in front of the near plane have depth 1. Casters that
/// [tint](crate::ShadowCasters::tints) are drawn into layers of their own; they are found for static views if they are static, and for
/// views with moving casters in any case, since those may hide them.
pub trait LayeredCasters: Sync {
    /// Adds the passes that find the casters of each view, and write the number of views that are drawn. There are at most `capacity` views.
    fn cull_layers<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        views: &mut Buffer,
        capacity: u32,
    ) -> LayeredInstances;

    /// Draws the casters that do not tint into the layers. The viewport is as large as a layer. Returns the number of draw calls that it recorded, for
    /// statistics.
    ///
    /// # Errors
    /// For tokens of another pass.
    fn draw_layers(&self, ctx: &mut RenderContext<'_>, tokens: LayerTokens) -> Result<u32, GraphError>;

    /// Returns whether any caster tints. The default is that none does.
    fn any_tints(&self) -> bool {
        false
    }

    /// Draws the casters that tint into layers of tints, where the depth that the other casters have in their layer is not nearer. With
    /// `tint_layer` in place of the view's index, the depth is kept by `atomicMax` as above, and the density is added to three numbers in a word
    /// (see the WGSL module `shadowgraph::tint_density`). Returns the number of draw calls. The default draws nothing.
    ///
    /// # Errors
    /// For tokens of another pass.
    fn draw_layer_tints(
        &self,
        ctx: &mut RenderContext<'_>,
        tokens: LayerTokens,
        tints: TintTokens,
    ) -> Result<u32, GraphError> {
        let _ = (ctx, tokens, tints);
        Ok(0)
    }

    /// Appends the numbers of all casters that move, ascending.
    fn all_moving(&self, casters: &mut Vec<u32>);

    /// Returns a number that grows when a static caster is inserted, changed or removed. A caster that begins or ceases to move is removed
    /// or inserted.
    fn static_version(&self) -> u64;

    /// Appends the bounds, before and after, of static casters that have changed since a version. Returns false if that is not known.
    fn static_changes(&self, since: u64, bounds: &mut Vec<Aabb>) -> bool;
}

/// The casters of some views: indirect draws, and pairs of an instance and a view.
#[derive(Clone, Debug)]
pub struct LayeredInstances {
    /// The arguments of indirect draws.
    pub draws: Buffer,
    /// The pairs.
    pub pairs: Buffer,
}

/// The buffers of layers, for the body of the pass that draws them.
#[derive(Clone, Copy, Debug)]
pub struct LayerTokens {
    /// The views.
    pub views: BufferToken,
    /// The depths of all layers, written.
    pub depths: BufferToken,
    /// The arguments of indirect draws.
    pub draws: BufferToken,
    /// The pairs of an instance and a view.
    pub pairs: BufferToken,
}

impl LayerTokens {
    /// Declares the accesses of a pass that draws into the layers of some views.
    pub(crate) fn in_pass(
        pass: &mut Pass<'_, '_, Rendering>,
        drawn: &LayeredInstances,
        views: &Buffer,
        depths: &mut Buffer,
    ) -> Self {
        pass.indirect_buffer(&drawn.draws);
        Self {
            views: pass.storage_buffer(views),
            depths: pass.storage_buffer_mut(depths, Contents::Preserve),
            draws: pass.storage_buffer(&drawn.draws),
            pairs: pass.storage_buffer(&drawn.pairs),
        }
    }
}

/// The buffers of layers of tints. A view's layer is its `tint_layer`.
#[derive(Clone, Copy, Debug)]
pub struct TintTokens {
    /// The depth of the nearest caster that tints, as bits of a float, written.
    pub depths: BufferToken,
    /// The density of all, written.
    pub densities: BufferToken,
}
