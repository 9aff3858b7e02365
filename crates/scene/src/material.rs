//! Metallic-roughness materials, textures and images.

use glam::{Vec3, Vec4};

/// A metallic-roughness material. Texture values multiply the factors.
#[derive(Clone, Debug, PartialEq)]
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
    /// How alpha is used.
    pub alpha: AlphaMode,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// Whether the base colour is shown as it is, without lighting. It casts shadows all the same.
    pub unlit: bool,
    /// What shadow it casts; `None`: as its alpha says, `On` where alpha is ignored, `Clip` where it cuts, `Tint` where it blends.
    pub casts: Option<CasterMode>,
    /// Whether others' shadows fall on it.
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
    /// Returns what shadow it casts.
    #[must_use]
    pub fn caster_mode(&self) -> CasterMode {
        self.casts.unwrap_or(match self.alpha {
            AlphaMode::Opaque => CasterMode::On,
            AlphaMode::Mask { .. } => CasterMode::Clip,
            AlphaMode::Blend => CasterMode::Tint,
        })
    }
}

/// What shadow a material casts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CasterMode {
    /// That of all of its surface, whatever its alpha.
    On,
    /// That of where its alpha is at least the cutoff of [`AlphaMode::Mask`]; one half, where there is none.
    Clip,
    /// One as dense as its alpha: the larger it is, the more texels of a shadow map it fills, by a pattern of noise.
    Dither,
    /// A coloured one: where alpha is a and the colour c, the part `(1 - a) * mix(1, c, a * (2 - a))` of the light passes. So much
    /// gets past the surface, in its colour the more the denser it is; what is wholly opaque stops all of it.
    Tint,
    /// None.
    Off,
}

/// How a material's alpha is used.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Drawn where alpha is at least the cutoff, else not at all.
    Mask {
        /// 0 or more; above 1 nothing is drawn.
        cutoff: f32,
    },
    /// Blended over what lies behind.
    Blend,
}

/// The use of an image by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into the scene's images.
    pub image: usize,
    /// How the image is filtered and repeated.
    pub sampler: Sampler,
    /// Which texture coordinates of the vertices: 0 or 1.
    pub uv_set: u8,
    /// Two rows: `uv' = M * (u, v, 1)`.
    pub uv_transform: [[f32; 3]; 2],
}

impl TextureRef {
    /// The `uv_transform` that changes nothing.
    pub const UV_IDENTITY: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// Makes a reference to an image with the default sampler, texture coordinates 0, untransformed.
    #[must_use]
    pub fn new(image: usize) -> Self {
        Self { image, sampler: Sampler::default(), uv_set: 0, uv_transform: Self::UV_IDENTITY }
    }
}

/// How an image is filtered and what lies beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Sampler {
    /// Beyond the left and right edges.
    pub wrap_u: Wrap,
    /// Beyond the upper and lower edges.
    pub wrap_v: Wrap,
    /// When a texel is larger than a pixel.
    pub mag: Filter,
    /// When a texel is smaller than a pixel.
    pub min: Filter,
    /// Between mip levels; `None`: only the largest level is used.
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

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image mirrored, then again.
    MirrorRepeat,
    /// The nearest texel of the edge.
    ClampToEdge,
}

/// How a value between texels is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Filter {
    /// The nearest one.
    Nearest,
    /// Linear between neighbours.
    Linear,
}

/// A decoded image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// The name in the file, else the name of the image's own file; empty if it has neither.
    pub name: String,
    /// Pixels, above 0.
    pub width: u32,
    /// Pixels, above 0.
    pub height: u32,
    /// Rows from the top, `width * height * 4` bytes; sRGB or linear is up to the use.
    pub rgba8: Vec<u8>,
}
