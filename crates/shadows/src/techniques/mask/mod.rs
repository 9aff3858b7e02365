//! Screen masks: an image of shadows with a layer for each light.

pub(super) mod pass;

use shadowgraph_core::Format;
use shadowgraph_scene::Light;

/// The format of a screen mask: visibility in red, green and blue.
pub(crate) const MASK_FORMAT: Format = Format::Rgba8Unorm;

/// Largest number of lights with a layer in a screen mask; shadows of further lights are evaluated at each lookup.
pub const MAX_MASK_LAYERS: usize = 16;

/// The side of a workgroup of the passes that write masks, pixels.
pub(super) const WORKGROUP_PX: u32 = 8;

/// The binding of a mask that is read.
pub(super) const MASK: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: false },
    view_dimension: wgpu::TextureViewDimension::D2Array,
    multisampled: false,
};

/// The binding of a mask that is written.
pub(super) const TARGET: wgpu::BindingType = wgpu::BindingType::StorageTexture {
    access: wgpu::StorageTextureAccess::WriteOnly,
    format: MASK_FORMAT,
    view_dimension: wgpu::TextureViewDimension::D2Array,
};

/// Returns the lights that have a layer, in the order of the layers: the first [`MAX_MASK_LAYERS`] that cast shadows, in the
/// scene's order (directional lights come first).
#[must_use]
pub fn masked_lights(lights: &[Light]) -> Vec<u32> {
    let casting = (0u32..).zip(lights).filter(|(_, light)| light.casts_shadow);
    casting.map(|(index, _)| index).take(MAX_MASK_LAYERS).collect()
}

/// Creates a placeholder of one texel for a missing mask.
pub(super) fn no_mask(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("no shadow mask"),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: MASK_FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}
