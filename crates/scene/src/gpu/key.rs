//! The properties of a draw that select its pipeline.

use crate::material::{AlphaMode, Material};

/// The properties of a material and an instance that select the pipeline. Ordered as draws are: opaque, mask, blend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PipelineKey {
    /// The alpha mode.
    pub alpha: AlphaKey,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// Whether the instance's transform mirrors, so that front faces wind clockwise.
    pub mirrored: bool,
}

/// [`AlphaMode`] without its cutoff.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum AlphaKey {
    /// Alpha is ignored.
    Opaque,
    /// Discarded where alpha is below the material's cutoff.
    Mask,
    /// Blended over what lies behind.
    Blend,
}

impl PipelineKey {
    /// Number of keys.
    pub const COUNT: usize = 12;

    /// Returns the key of a material on an instance whose transform mirrors or does not.
    #[must_use]
    pub fn new(material: &Material, mirrored: bool) -> Self {
        let alpha = match material.alpha {
            AlphaMode::Opaque => AlphaKey::Opaque,
            AlphaMode::Mask { .. } => AlphaKey::Mask,
            AlphaMode::Blend | AlphaMode::Transmit => AlphaKey::Blend,
        };
        Self { alpha, double_sided: material.double_sided, mirrored }
    }

    /// Returns every key, in order of [`index`](Self::index).
    ///
    /// ```
    /// use shadowgraph_scene::gpu::PipelineKey;
    /// assert!(PipelineKey::all().enumerate().all(|(i, key)| key.index() == i));
    /// assert_eq!(PipelineKey::all().count(), PipelineKey::COUNT);
    /// ```
    pub fn all() -> impl Iterator<Item = Self> {
        let sides = [(false, false), (false, true), (true, false), (true, true)];
        [AlphaKey::Opaque, AlphaKey::Mask, AlphaKey::Blend].into_iter().flat_map(move |alpha| {
            sides.map(|(double_sided, mirrored)| Self { alpha, double_sided, mirrored })
        })
    }

    /// Returns a unique number below [`COUNT`](Self::COUNT), for tables of pipelines.
    #[must_use]
    pub fn index(self) -> usize {
        self.alpha as usize * 4 + usize::from(self.double_sided) * 2 + usize::from(self.mirrored)
    }

    /// Returns the state with the front face, and with back-face culling unless the key is double-sided.
    #[must_use]
    pub fn primitive_state(self) -> wgpu::PrimitiveState {
        wgpu::PrimitiveState {
            front_face: if self.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
            cull_mode: (!self.double_sided).then_some(wgpu::Face::Back),
            ..wgpu::PrimitiveState::default()
        }
    }
}
