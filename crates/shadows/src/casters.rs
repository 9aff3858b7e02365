//! What an engine tells about the things that cast shadows.

use shadowgraph_scene::{Aabb, CullVolume};

use crate::plan::TileKind;

/// The things that can cast shadows. Implement it for a scene of your own.
///
/// Casters are numbered; what a number stands for is the implementer's affair. All coordinates here are
/// absolute, in f64.
pub trait ShadowCasters: Sync {
    /// Appends the numbers of all casters that touch the volume, ascending. Casters that only come near may
    /// be among them; none that touches may be missing. A [`CullTree`](shadowgraph_scene::CullTree) does it fast.
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>);

    /// Returns the bounds of all casters, [`Aabb::EMPTY`] where there are none.
    fn bounds(&self) -> Aabb;

    /// Returns the bounds of one caster. By default those of all: then no caster is left out for what it covers.
    fn bounds_of(&self, caster: u32) -> Aabb {
        let _ = caster;
        self.bounds()
    }

    /// Returns a number that changes whenever what a caster draws does; `None` if it may change at any time. Tiles whose
    /// casters all have one are cached where the settings say so.
    fn version(&self, caster: u32) -> Option<u64> {
        let _ = caster;
        None
    }

    /// Tells whether light passes through a caster and takes on its colour. Such ones are drawn in passes of their own: see
    /// [`CasterPass`].
    fn tints(&self, caster: u32) -> bool {
        let _ = caster;
        false
    }

    /// Returns the bounds of everything that shadows can fall on: cascades end there, if that is before the shadow
    /// distance. By default the bounds of all casters; with surfaces that receive shadows and cast none, theirs too.
    fn receivers(&self) -> Aabb {
        self.bounds()
    }

    /// Draws the casters into the pass, as `view.target` says. Viewport, scissor and group 0
    /// ([`caster_view_layout`]) are already set: its matrix `clip_from_world` takes positions relative to the
    /// frame's origin. Leave all of these as they are.
    ///
    /// Pipelines are the implementer's own, so vertices can be moved (skinning, wind), many instances be drawn at once, and
    /// `view` tells which level of detail is enough. Bounds must hold what is drawn, wherever it is moved.
    ///
    /// Returns how many draw calls it recorded, for those who measure.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32;
}

/// What a pipeline that draws casters must be made for: depth compared with `GreaterEqual` (it is reversed), one sample, no
/// depth bias (it is applied where the map is read).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CasterTarget {
    /// What is drawn.
    pub pass: CasterPass,
    /// The format of depth.
    pub format: wgpu::TextureFormat,
    /// Whether the view is a spot light's pyramid rather than a box. In both, casters between the light and
    /// the near plane are to be kept with depth 1 (`unclipped_depth`, or its emulation).
    pub perspective: bool,
}

/// The format of what translucent casters let through.
pub const TINT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// What of casters is drawn. Without casters that [tint](ShadowCasters::tints) there is only `Depth`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CasterPass {
    /// The depth of casters that do not tint: written, no colour.
    #[default]
    Depth,
    /// The depth of all surface of casters that tint, however little they do: written, no colour.
    TintDepth,
    /// What light passes through casters that tint: the one colour target, of [`TINT_FORMAT`],
    /// is multiplied by it. Depth is that of `Depth`: tested, not written.
    Tint,
}

/// The tile that casters are drawn into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CasterView {
    /// What pipelines must be made for.
    pub target: CasterTarget,
    /// Whose tile it is, by place in the scene's list of lights.
    pub light: u32,
    /// Which of its tiles.
    pub kind: TileKind,
    /// Width and height of the tile, pixels.
    pub size_px: [u32; 2],
    /// The width of a texel in the world, metres; for spot and point lights at 1 m along the tile's axis. Detail that is
    /// smaller casts no shadow of its own.
    pub texel_world: f32,
}

/// Returns the layout of bind group 0 of pipelines that draw casters: at binding 0 a storage buffer, read by vertices
/// and fragments at a dynamic offset, that is a [`ShadowView`](crate::ShadowView) and so begins with the matrix
/// `clip_from_world`.
#[must_use]
pub fn caster_view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("depth view"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: true,
                min_binding_size: std::num::NonZeroU64::new(size_of::<crate::ShadowView>() as u64),
            },
            count: None,
        }],
    })
}
