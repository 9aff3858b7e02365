//! The parts of the material model that a scene uses: shaders leave out the others.

use shadowgraph_shaders::ModuleSource;

use crate::material::{Material, TextureRef};

/// The parts of the material model that a scene's materials use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct MaterialFeatures {
    /// Bit i: some material has texture i, in the order of [`Material::textures`].
    textures: u8,
    /// Whether some texture has a transform, or reads the second uv set.
    uv_transforms: bool,
}

impl MaterialFeatures {
    /// Returns those that a material uses.
    #[must_use]
    pub fn new(material: &Material) -> Self {
        let mut features = Self::default();
        for (slot, texture) in material.textures().into_iter().enumerate() {
            let Some(TextureRef { uv_transform, uv_set, .. }) = texture else { continue };
            features.textures |= 1 << slot;
            features.uv_transforms |= uv_set == 1 || uv_transform != TextureRef::UV_IDENTITY;
        }
        features
    }

    /// Returns those that either uses.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            textures: self.textures | other.textures,
            uv_transforms: self.uv_transforms || other.uv_transforms,
        }
    }

    /// Returns the replacement of `material_features.wgsl`.
    #[must_use]
    pub fn module(self) -> ModuleSource {
        let Self { textures, uv_transforms } = self;
        let source = format!(
            "#define_import_path shadowgraph::material_features\n\
             const TEXTURES: u32 = {textures}u;\n\
             const UV_TRANSFORMS: bool = {uv_transforms};\n"
        );
        ModuleSource::new(format!("material_features.wgsl {textures} {uv_transforms}"), source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::ImageKey;

    #[test]
    fn a_scene_uses_what_any_of_its_materials_uses() {
        let texture = TextureRef::new(ImageKey::default());
        let plain = Material::default();
        let colored = Material { base_color_texture: Some(texture), ..Material::default() };
        let second = TextureRef { uv_set: 1, ..texture };
        let glowing = Material { emissive_texture: Some(second), ..Material::default() };
        let [plain, colored, glowing] =
            [plain, colored, glowing].map(|material| MaterialFeatures::new(&material));
        assert_eq!(plain, MaterialFeatures::default());
        assert_eq!(colored, MaterialFeatures { textures: 0b00001, uv_transforms: false });
        assert_eq!(colored.union(glowing), MaterialFeatures { textures: 0b10001, uv_transforms: true });
    }
}
