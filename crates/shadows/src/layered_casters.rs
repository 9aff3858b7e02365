//! The casters of an engine's scene, for views that passes of a frame write.

use shadowgraph_core::{Buffer, BufferToken, Error as GraphError, Frame, RenderContext};
use shadowgraph_scene::Aabb;

/// Casters that are drawn in views that only the GPU knows: each view has a layer of a buffer of depths. See the WGSL module
/// `shadowgraph::layer_views`. A view has the static casters, the moving ones, or both.
///
/// Layers hold the bits of floats: 1 nearest to the light, 0 farthest and empty. Casters in front of the near plane have depth 1.
pub trait LayeredCasters: Sync {
    /// Adds the passes that find the casters of each view, and write the number of views that are drawn. There are at most `capacity` views.
    fn cull_layers<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        views: &mut Buffer,
        capacity: u32,
    ) -> LayeredInstances;

    /// Draws the casters into the layers. The viewport is as large as a layer. Returns the number of draw calls that it recorded, for
    /// statistics.
    ///
    /// # Errors
    /// For tokens of another pass.
    fn draw_layers(&self, ctx: &mut RenderContext<'_>, tokens: LayerTokens) -> Result<u32, GraphError>;

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
