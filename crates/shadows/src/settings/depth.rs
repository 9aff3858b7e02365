//! Depth formats of maps.

use crate::declare_settings;

declare_settings! {
    /// The format of a shadow map.
    #[derive(Copy, Eq, Hash)]
    #[default(Depth32)]
    pub enum DepthFormat {
        /// 16 bits: half the memory. Enough for directional lights; for spot and point lights only with a near plane that is
        /// not much nearer than what they light.
        Depth16;
        /// At least 24 bits.
        Depth24;
        /// 32 bits, floating.
        Depth32;
    }
}

impl DepthFormat {
    /// All formats, from coarse to fine.
    pub const ALL: [Self; 3] = [Self::Depth16, Self::Depth24, Self::Depth32];

    /// Returns the texture format.
    #[must_use]
    pub fn texture_format(self) -> wgpu::TextureFormat {
        match self {
            Self::Depth16 => wgpu::TextureFormat::Depth16Unorm,
            Self::Depth24 => wgpu::TextureFormat::Depth24Plus,
            Self::Depth32 => wgpu::TextureFormat::Depth32Float,
        }
    }

    /// Returns the smallest difference of depth that the format resolves; 0 where shaders compute no finer.
    #[must_use]
    pub fn step(self) -> f32 {
        match self {
            Self::Depth16 => 1.0 / 65_535.0,
            // As fixed or as floating point, whichever the device has for it.
            Self::Depth24 => 1.0 / 16_777_215.0,
            Self::Depth32 => 0.0,
        }
    }
}
