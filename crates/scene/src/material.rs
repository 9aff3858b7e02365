//! Metallic-roughness materials, textures and images.

use std::fmt;
use std::sync::Arc;

use glam::{Vec3, Vec4};
use serde::{Deserialize, Serialize};

use crate::keys::ImageKey;

/// A metallic-roughness material. Texture values multiply the factors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The name in the file; empty if it has none.
    pub name: String,
    /// Linear RGB and alpha, each 0 to 1.
    pub base_color: Vec4,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Emitted light, linear RGB: factor times strength, 0 or more.
    pub emissive: Vec3,
    /// Scales the x and y of the normal texture.
    pub normal_scale: f32,
    /// 0: occlusion texture without effect, 1: full effect.
    pub occlusion_strength: f32,
    /// The alpha mode.
    pub alpha: AlphaMode,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// Whether the base colour is shown without lighting. The material casts shadows in either case.
    pub unlit: bool,
    /// Kind of shadow that it casts; `None`: by its alpha mode, `On` for opaque, `Clip` for mask, `Tint` for blend.
    pub casts: Option<CasterMode>,
    /// Alpha below which [`CasterMode::Clip`] leaves holes in the shadow, 0 to 1; `None`: the cutoff of [`AlphaMode::Mask`], or one half in
    /// other modes.
    pub shadow_cutoff: Option<f32>,
    /// Whether it receives shadows.
    pub receives_shadows: bool,
    /// RGB in sRGB, alpha linear.
    pub base_color_texture: Option<TextureRef>,
    /// Green: roughness, blue: metallic; linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Tangent-space normals, linear, +Y up.
    pub normal_texture: Option<TextureRef>,
    /// Red: ambient occlusion, linear.
    pub occlusion_texture: Option<TextureRef>,
    /// RGB in sRGB.
    pub emissive_texture: Option<TextureRef>,
}

impl Default for Material {
    /// Returns glTF's default material: white, opaque, metallic and roughness 1.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            metallic: 1.0,
            roughness: 1.0,
            emissive: Vec3::ZERO,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            casts: None,
            shadow_cutoff: None,
            receives_shadows: true,
            base_color_texture: None,
            metallic_roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            emissive_texture: None,
        }
    }
}

impl Material {
    /// Returns how it casts shadows.
    #[must_use]
    pub fn caster_mode(&self) -> CasterMode {
        self.casts.unwrap_or(match self.alpha {
            AlphaMode::Opaque => CasterMode::On,
            AlphaMode::Mask { .. } => CasterMode::Clip,
            AlphaMode::Blend | AlphaMode::Transmit => CasterMode::Tint,
        })
    }

    /// Returns the alpha below which [`CasterMode::Clip`] leaves holes in the shadow.
    #[must_use]
    pub fn caster_cutoff(&self) -> f32 {
        self.shadow_cutoff.unwrap_or(match self.alpha {
            AlphaMode::Mask { cutoff } => cutoff,
            _ => 0.5,
        })
    }

    /// Returns the textures: base colour, metallic and roughness, normal, occlusion, emissive.
    #[must_use]
    pub fn textures(&self) -> [Option<TextureRef>; 5] {
        [
            self.base_color_texture,
            self.metallic_roughness_texture,
            self.normal_texture,
            self.occlusion_texture,
            self.emissive_texture,
        ]
    }

    /// Returns the textures for changes, in the order of [`textures`](Self::textures).
    pub fn textures_mut(&mut self) -> [&mut Option<TextureRef>; 5] {
        [
            &mut self.base_color_texture,
            &mut self.metallic_roughness_texture,
            &mut self.normal_texture,
            &mut self.occlusion_texture,
            &mut self.emissive_texture,
        ]
    }
}

/// Kind of shadow that a material casts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum CasterMode {
    /// The whole surface casts a shadow, regardless of alpha.
    On,
    /// The surface casts a shadow where alpha is at least [`Material::caster_cutoff`].
    Clip,
    /// The shadow is as dense as alpha: a noise pattern selects the texels of the shadow map that are filled.
    Dither,
    /// The shadow is coloured: for alpha a and colour c, the surface transmits the fraction `(1 - a) * mix(1, c, a * (2 - a))`
    /// of the light, `(1 - a) * c` with [`AlphaMode::Transmit`]. Higher alpha transmits less light with more of the colour; an
    /// alpha of 1 blocks all of it.
    Tint,
    /// The material casts no shadow.
    Off,
}

/// The alpha mode of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Drawn where alpha is at least the cutoff, else not at all.
    Mask {
        /// 0 or more; above 1 nothing is drawn.
        cutoff: f32,
    },
    /// Blended over what is behind.
    Blend,
    /// Blended like thin glass: what is behind is seen through the fraction `1 - alpha`, tinted by the base colour, and highlights
    /// do not fade with alpha.
    Transmit,
}

/// The use of an image by a material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TextureRef {
    /// The image of the scene.
    pub image: ImageKey,
    /// Filtering and wrapping.
    pub sampler: Sampler,
    /// The set of texture coordinates: 0 or 1.
    pub uv_set: u8,
    /// Two rows: `uv' = M * (u, v, 1)`.
    pub uv_transform: [[f32; 3]; 2],
}

impl TextureRef {
    /// The identity `uv_transform`.
    pub const UV_IDENTITY: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// Creates a reference to an image with the default sampler, texture coordinates 0, untransformed.
    #[must_use]
    pub fn new(image: ImageKey) -> Self {
        Self { image, sampler: Sampler::default(), uv_set: 0, uv_transform: Self::UV_IDENTITY }
    }
}

/// Filtering and wrapping of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Sampler {
    /// Wrapping beyond the left and right edges.
    pub wrap_u: Wrap,
    /// Wrapping beyond the upper and lower edges.
    pub wrap_v: Wrap,
    /// Magnification filter.
    pub mag: Filter,
    /// Minification filter.
    pub min: Filter,
    /// Filter between mip levels; `None`: only the largest level is used.
    pub mip: Option<Filter>,
}

impl Default for Sampler {
    /// Repeats, and filters linearly in and between mip levels.
    fn default() -> Self {
        Self {
            wrap_u: Wrap::Repeat,
            wrap_v: Wrap::Repeat,
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: Some(Filter::Linear),
        }
    }
}

/// Wrapping of texture coordinates beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Wrap {
    /// The image repeats.
    Repeat,
    /// The image repeats, mirrored every second time.
    MirrorRepeat,
    /// The texels of the edge extend outwards.
    ClampToEdge,
}

/// A texture filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// Linear interpolation between neighbours.
    Linear,
}

/// A decoded image.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    /// The name in the file, else the name of the image's own file; empty if it has neither.
    pub name: String,
    /// Pixels, above 0.
    pub width: u32,
    /// Pixels, above 0.
    pub height: u32,
    /// Rows from the top, `width * height * 4` bytes; the use determines whether they are sRGB or linear.
    pub rgba8: Vec<u8>,
    /// The KTX2 file (ETC1S or UASTC) that the pixels are from. Devices with a block-compressed format draw its mip levels
    /// in that format.
    pub ktx2: Option<Arc<[u8]>>,
}

impl Image {
    /// Creates an image of RGBA pixels, `width * height * 4` bytes.
    #[must_use]
    pub fn new(name: impl Into<String>, width: u32, height: u32, rgba8: Vec<u8>) -> Self {
        Self { name: name.into(), width, height, rgba8, ktx2: None }
    }

    /// Returns whether no pixel is translucent.
    #[cfg(feature = "gpu")]
    pub(crate) fn is_opaque(&self) -> bool {
        self.rgba8.as_chunks::<4>().0.iter().all(|[.., alpha]| *alpha == u8::MAX)
    }
}

impl fmt::Debug for Image {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Image({:?}, {}x{})", self.name, self.width, self.height)
    }
}

/// Decodes a colour channel from sRGB (IEC 61966-2-1) to linear light, 0 to 1. Alpha is always linear.
///
/// ```
/// use shadowgraph_scene::linear_from_srgb;
/// assert_eq!((linear_from_srgb(0), linear_from_srgb(255)), (0.0, 1.0));
/// assert!((linear_from_srgb(188) - 0.5).abs() < 0.01);
/// ```
pub fn linear_from_srgb(channel: u8) -> f64 {
    let value = f64::from(channel) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Encodes linear light, 0 to 1, as a colour channel in sRGB. Values out of range are clamped.
pub fn srgb_from_linear(light: f64) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let value = if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (value * 255.0).round() as u8
}
