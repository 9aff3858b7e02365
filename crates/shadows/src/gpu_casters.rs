//! The casters of an engine's scene, culled on the GPU.

use shadowgraph_core::{Error as GraphError, Frame, RenderContext};
use shadowgraph_scene::{ConvexVolume, CullVolume};

use crate::caster_view::CasterView;
use crate::culled::{CulledInstances, CulledTokens};

/// Casters that the GPU culls for cascades, so that the CPU does not list those of each frame. A scene with hundreds of casters costs less
/// with lists; see [`ShadowCasters::gpu`](crate::ShadowCasters::gpu).
///
/// Casters that [tint](crate::ShadowCasters::tints) are listed in any case, and so are [moving](crate::Mobility::Moving) ones that are
/// drawn over kept tiles.
pub trait GpuCasters: Sync {
    /// Adds the passes that find the opaque casters of each query.
    fn cull<'f>(&'f self, frame: &mut Frame<'f>, queries: &[CasterQuery]) -> CulledInstances;

    /// Draws the casters of a query into the pass for `view.target`, under the conditions of
    /// [`ShadowCasters::draw`](crate::ShadowCasters::draw). Returns the number of draw calls that it recorded, for statistics.
    ///
    /// # Errors
    /// For tokens of another pass.
    fn draw(
        &self,
        ctx: &mut RenderContext<'_>,
        view: &CasterView,
        culled: CulledTokens,
    ) -> Result<u32, GraphError>;

    /// Returns whether any caster may intersect the volume.
    fn any(&self, volume: &CullVolume) -> bool;

    /// Appends the numbers of the casters that tint and intersect the volume, ascending.
    fn tinting(&self, volume: &CullVolume, casters: &mut Vec<u32>);

    /// Appends the numbers of the opaque casters that move and intersect the volume, ascending.
    fn moving(&self, volume: &CullVolume, casters: &mut Vec<u32>);

    /// Returns the number of static casters.
    fn static_count(&self) -> usize;

    /// Returns a number that grows when a static caster is inserted, changed or removed. A caster that begins or ceases to move
    /// is removed or inserted.
    fn static_version(&self) -> u64;

    /// Returns whether a static caster that intersects the volume may have changed since a version. It is not called with versions that
    /// [`static_version`](Self::static_version) has not returned.
    fn has_changed(&self, since: u64, volume: &CullVolume) -> bool;
}

/// Casters to be found.
#[derive(Clone, Debug, PartialEq)]
pub struct CasterQuery {
    /// The name, for statistics.
    pub name: String,
    /// The volume that they intersect, or are near to.
    pub volume: ConvexVolume,
    /// Whether moving casters are left out.
    pub only_static: bool,
}
