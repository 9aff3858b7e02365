//! The casters of an engine's scene.

use shadowgraph_scene::{Aabb, CullVolume};

use crate::caster_view::CasterView;
use crate::gpu_casters::GpuCasters;
use crate::layered_casters::LayeredCasters;
use crate::rays::GpuRayScene;

/// The shadow casters of a scene. Implement it for your own scene.
///
/// Casters are identified by numbers of the implementer's choice. All coordinates are
/// absolute, in f64.
pub trait ShadowCasters: Sync {
    /// Appends the numbers of all casters that intersect the volume, in ascending order. The result may contain casters
    /// near the volume; it must contain all that intersect it. A [`CullTree`](shadowgraph_scene::CullTree) does it fast.
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>);

    /// Returns the bounds of all casters; [`Aabb::EMPTY`] if there are none.
    fn bounds(&self) -> Aabb;

    /// Returns the bounds of one caster. The default is the bounds of all: then no caster is culled as redundant.
    fn caster_bounds(&self, caster: u32) -> Aabb {
        let _ = caster;
        self.bounds()
    }

    /// Returns a version that changes whenever what the caster draws or its bounds change; `None` if that may happen at any
    /// time. Versions must not be reused: a number that is given to another caster has another version. Tiles are kept from
    /// frame to frame while the versions of their casters stay the same.
    fn version(&self, caster: u32) -> Option<u64> {
        let _ = caster;
        None
    }

    /// Returns whether the caster moves often. What static casters draw is kept, and moving casters are added to a copy of
    /// it, so a caster that has changed recently should be `Moving` until it rests. The default is `Static` for casters with a
    /// version; without one a caster is drawn as a moving one.
    fn mobility(&self, caster: u32) -> Mobility {
        if self.version(caster).is_some() { Mobility::Static } else { Mobility::Moving }
    }

    /// Returns the caster's name, for plans, which say why a tile was drawn.
    fn caster_name(&self, caster: u32) -> Option<&str> {
        let _ = caster;
        None
    }

    /// Returns whether the caster is translucent and colours light. Such casters are drawn in separate passes: see
    /// [`CasterPass`](crate::CasterPass).
    fn tints(&self, caster: u32) -> bool {
        let _ = caster;
        false
    }

    /// Returns the bounds of all receivers: cascades cover no more than that. The default is the bounds of all casters; add
    /// those of surfaces that receive shadows and cast none.
    fn receivers(&self) -> Aabb {
        self.bounds()
    }

    /// Returns whether a receiver may intersect the volume. Cascades begin where the first receiver is in view. The default is whether the
    /// bounds of all receivers do; a [`CullTree`](shadowgraph_scene::CullTree) knows better.
    fn has_receiver_in(&self, volume: &CullVolume) -> bool {
        volume.intersects(&self.receivers())
    }

    /// Returns the casters' triangles, for techniques that [trace rays](crate::ShadowTechnique::traces_rays). Keep it up to date from frame to
    /// frame.
    fn rays(&self) -> Option<&GpuRayScene> {
        None
    }

    /// Returns the casters for culling on the GPU, if the cascades of this frame should be culled there. The default is `None`: casters are
    /// listed by [`cull`](Self::cull).
    fn gpu(&self) -> Option<&dyn GpuCasters> {
        None
    }

    /// Returns the casters for views that the GPU writes, for techniques that draw such views, as `virtual` does.
    fn layered(&self) -> Option<&dyn LayeredCasters> {
        None
    }

    /// Draws the casters into the pass for `view.target`. Viewport, scissor and group 0
    /// ([`caster_view_layout`](crate::caster_view_layout)) are already set: its matrix `clip_from_world` takes positions relative to the
    /// frame's origin. Do not change any of these.
    ///
    /// Pipelines are the implementer's, so vertices can be animated (skinning, wind), instances can be drawn together, and
    /// `view` determines a sufficient level of detail. Bounds must contain the geometry as it is drawn.
    ///
    /// Returns the number of draw calls that it recorded, for statistics.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32;
}

/// Whether a caster moves often.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mobility {
    /// It rarely changes: when it does, the tiles that it is drawn into are drawn again.
    #[default]
    Static,
    /// It changes often: it is added to the kept depth of the static casters.
    Moving,
}
