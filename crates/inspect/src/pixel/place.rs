//! Where the place of a pixel is in a texture.

use serde::Serialize;
use shadowgraph_core::{
    Aspect, Extent, Plan, ResourceDesc, ResourceId, Subresource, TexelLayout, TextureDesc,
};
use wgpu_types::TextureDimension;

/// A pixel of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct PixelPlace {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// Width and height of the image.
    pub size_px: [u32; 2],
}

/// A texel at the place of the pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelTexel {
    /// Mip level.
    pub mip: u32,
    /// Layer.
    pub layer: u32,
    /// Whether it is stencil, of a format that has depth too.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_stencil: bool,
    /// Column and row in the mip level.
    pub at: [u32; 2],
    /// The channels, red first; sRGB formats as they are stored.
    pub value: Vec<f64>,
    /// Why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

impl PixelTexel {
    /// Returns whether another one is of the same mip level, layer and aspect.
    pub(super) fn is_at(&self, other: &Self) -> bool {
        (self.mip, self.layer, self.is_stencil) == (other.mip, other.layer, other.is_stencil)
    }

    /// Returns the subresource of the texel.
    pub(super) fn subresource(&self) -> Subresource {
        let whole = Subresource::FULL.mip(self.mip).layer(self.layer);
        if self.is_stencil { whole.aspect(Aspect::Stencil) } else { whole }
    }
}

impl PixelPlace {
    /// Returns whether a resource is a texture with the proportions of the image, of which passes write no tiles.
    pub(super) fn is_in(&self, plan: &Plan, resource: ResourceId) -> bool {
        let ResourceDesc::Texture(desc) = plan.resource(resource).desc else { return false };
        let is_tiled = || {
            let order = plan.order().iter();
            let mut accesses = order.flat_map(|&pass| plan.accesses(pass));
            accesses.any(|access| access.resource == resource && access.subresource.bounds().is_some())
        };
        self.is_proportional(&desc) && !is_tiled()
    }

    fn is_proportional(&self, desc: &TextureDesc) -> bool {
        let [width, height] = self.size_px.map(u64::from);
        let [own_width, own_height] = [desc.size.width, desc.size.height].map(u64::from);
        // Half sizes are rounded.
        let skew = (own_width * height).abs_diff(own_height * width);
        let is_image = desc.dimension == TextureDimension::D2 && own_width > 1 && own_height > 1;
        is_image && skew <= 2 * width.max(height)
    }

    /// Returns the texels in the bytes of a part, which has one mip level and one aspect.
    pub(super) fn texels(
        &self,
        desc: &TextureDesc,
        part: &Subresource,
        bytes: &Result<Vec<u8>, String>,
    ) -> Vec<PixelTexel> {
        let (mip, is_stencil) = (part.first_mip(), part.selected_aspect() == Aspect::Stencil);
        let Extent { width, height, .. } = desc.size.mip_level_size(mip, desc.dimension);
        let at = [0, 1].map(|axis| {
            let [pixel, size, own] =
                [self.pixel[axis], self.size_px[axis], [width, height][axis]].map(u64::from);
            (((2 * pixel + 1) * own / (2 * size.max(1))) as u32).min([width, height][axis].saturating_sub(1))
        });
        let texel = |layer, value: Result<Vec<f64>, String>| {
            let (value, problem) = match value {
                Ok(value) => (value, None),
                Err(problem) => (Vec::new(), Some(problem)),
            };
            PixelTexel { mip, layer, is_stencil, at, value, problem }
        };
        let layout = TexelLayout::for_format(desc.format, part.selected_aspect());
        let (bytes, layout) = match (bytes, layout) {
            (Ok(bytes), Some(layout)) => (bytes, layout),
            (Ok(_), None) => {
                let problem = format!("texels of {:?} cannot be read", desc.format);
                return vec![texel(part.first_layer(), Err(problem))];
            }
            (Err(problem), _) => return vec![texel(part.first_layer(), Err(problem.clone()))],
        };
        let layer_bytes = (width as usize * height as usize * layout.bytes()).max(1);
        let index = at[1] as usize * width as usize + at[0] as usize;
        (part.first_layer()..)
            .zip(bytes.chunks_exact(layer_bytes))
            .filter_map(|(layer, bytes)| {
                let value = layout.values(bytes.get(index * layout.bytes()..)?)?;
                Some(texel(layer, Ok(value)))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowgraph_core::Format;

    const PLACE: PixelPlace = PixelPlace { pixel: [5, 3], size_px: [8, 4] };

    fn bytes(count: u8) -> Result<Vec<u8>, String> {
        Ok((0..count).collect())
    }

    #[test]
    fn a_texel_is_found_in_each_resolution_and_layer() {
        let full = TextureDesc::d2(8, 4, Format::R8Uint);
        let at = |desc: &TextureDesc, mip, count| {
            let texels = PLACE.texels(desc, &Subresource::FULL.mip(mip), &bytes(count));
            texels.into_iter().map(|texel| (texel.layer, texel.at, texel.value)).collect::<Vec<_>>()
        };
        assert_eq!(at(&full, 0, 32), [(0, [5, 3], vec![29.0])]);
        let mut layers = TextureDesc { mip_levels: 2, ..full };
        layers.size.depth_or_array_layers = 2;
        assert_eq!(at(&layers, 1, 16), [(0, [2, 1], vec![6.0]), (1, [2, 1], vec![14.0])]);
    }

    #[test]
    fn textures_of_other_proportions_have_no_such_texel() {
        let is_proportional =
            |width, height| PLACE.is_proportional(&TextureDesc::d2(width, height, Format::R8Unorm));
        assert!(is_proportional(8, 4) && is_proportional(4, 2) && is_proportional(16, 8));
        assert!(!is_proportional(64, 64) && !is_proportional(1, 1) && !is_proportional(256, 1));
    }

    #[test]
    fn a_texture_that_cannot_be_copied_has_its_reason() {
        let desc = TextureDesc::d2(8, 4, Format::Depth24Plus);
        let [texel] = &PLACE.texels(&desc, &Subresource::FULL, &Err("24 bits".into()))[..] else {
            return assert_eq!(0, 1, "one texel");
        };
        assert_eq!(texel.problem.as_deref(), Some("24 bits"));
    }
}
