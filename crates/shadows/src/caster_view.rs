//! The tiles that casters are drawn into.

/// The target of a pipeline that draws casters: depth compare `GreaterEqual` (depth is reversed), one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CasterTarget {
    /// The kind of pass.
    pub pass: CasterPass,
    /// The depth format.
    pub format: wgpu::TextureFormat,
    /// Whether the view is a spot light's pyramid rather than a box. In both, casters between the light and
    /// the near plane must be kept with depth 1 (`unclipped_depth`, or its emulation).
    pub perspective: bool,
    /// The slope-scaled depth bias, in thousandths of the depth's change per texel, by which casters are pushed away from the light; see
    /// [`slope_scale`](Self::slope_scale). 0 but for [`BiasMethod::Raster`](crate::BiasMethod::Raster): other biases are applied when the map is
    /// read.
    pub slope_bias_milli: u32,
}

impl CasterTarget {
    /// Returns `slope_bias_milli` for [`wgpu::DepthBiasState::slope_scale`]: negative, as depth is reversed.
    #[must_use]
    pub fn slope_scale(&self) -> f32 {
        -0.001 * self.slope_bias_milli as f32
    }
}

/// The format of the transmittance of translucent casters.
pub const TINT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The passes that draw casters. Without casters that [tint](crate::ShadowCasters::tints) there is only `Depth`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CasterPass {
    /// The depth of casters that do not tint: written, no colour.
    #[default]
    Depth,
    /// The depth of all surfaces of casters that tint, at any opacity: written, no colour.
    TintDepth,
    /// The transmittance of casters that tint: the colour target, of [`TINT_FORMAT`],
    /// is multiplied by it. The depth of `Depth` is tested, not written.
    Tint,
}

/// The tile that casters are drawn into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CasterView {
    /// The target of pipelines.
    pub target: CasterTarget,
    /// Index of the light in the scene.
    pub light: u32,
    /// The kind of tile.
    pub kind: TileKind,
    /// Width and height of the tile, pixels.
    pub size_px: [u32; 2],
    /// The width of a texel in the world, metres; for spot and point lights at 1 m along the tile's axis. Smaller details
    /// cast no visible shadow.
    pub texel_world: f32,
}

/// The kind of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TileKind {
    /// The only tile of its light.
    Whole,
    /// A cascade, counted from 0, the nearest to the camera.
    Cascade(u32),
    /// A cube face of a point light: 0 +X, 1 -X, 2 +Y, 3 -Y, 4 +Z, 5 -Z.
    Face(u32),
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
