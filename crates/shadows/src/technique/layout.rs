//! Bind group 1, as techniques describe it.

use super::ShadowTechnique;

/// What bindings of techniques usually are.
pub mod binding {
    /// A storage buffer that is read.
    pub const STORAGE: wgpu::BindingType = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };

    /// A uniform block.
    pub const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };

    /// A map of depths.
    pub const DEPTH_MAP: wgpu::BindingType = texture(wgpu::TextureSampleType::Depth);

    /// A texture of numbers that samplers filter.
    pub const FILTERED_MAP: wgpu::BindingType = texture(wgpu::TextureSampleType::Float { filterable: true });

    /// A texture of numbers that are read one by one.
    pub const FLOAT_MAP: wgpu::BindingType = texture(wgpu::TextureSampleType::Float { filterable: false });

    /// A sampler that filters.
    pub const SAMPLER: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);

    /// A sampler that compares.
    pub const COMPARISON_SAMPLER: wgpu::BindingType =
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);

    const fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        }
    }
}

/// Makes the layout of a technique's bind group 1, for those who light and who compute.
pub fn shadow_layout(device: &wgpu::Device, technique: &dyn ShadowTechnique) -> wgpu::BindGroupLayout {
    layout(device, technique.name(), &technique.binding_types())
}

/// Makes a layout with these bindings, from 0, for those who light and who compute. What is written is only computed.
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    types: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entry = |(binding, &ty): (u32, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: match ty {
            wgpu::BindingType::StorageTexture { .. } => wgpu::ShaderStages::COMPUTE,
            _ => wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
        },
        ty,
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}
