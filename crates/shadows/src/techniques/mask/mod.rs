//! Screen masks: an image of shadows with a layer for each light.

pub(super) mod pass;

use crate::technique::MASK_FORMAT;

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
