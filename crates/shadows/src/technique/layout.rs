//! The layout of bind group 1.

use super::ShadowTechnique;

/// Common types of bindings, and layouts of them.
pub mod binding {
    /// A read-only storage buffer.
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

    /// A depth map.
    pub const DEPTH_MAP: wgpu::BindingType = texture(wgpu::TextureSampleType::Depth);

    /// A float texture that is sampled with a filter.
    pub const FILTERED_MAP: wgpu::BindingType = texture(wgpu::TextureSampleType::Float { filterable: true });

    /// A float texture that is read without a filter.
    pub const FLOAT_MAP: wgpu::BindingType = texture(wgpu::TextureSampleType::Float { filterable: false });

    /// A filtering sampler.
    pub const SAMPLER: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);

    /// A comparison sampler.
    pub const COMPARISON_SAMPLER: wgpu::BindingType =
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);

    /// Creates a layout with these bindings, numbered from 0, for fragment and compute shaders. Storage textures are visible to
    /// compute shaders only.
    pub fn layout(device: &wgpu::Device, label: &str, types: &[wgpu::BindingType]) -> wgpu::BindGroupLayout {
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
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        })
    }

    const fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        }
    }
}

/// Creates the layout of a technique's bind group 1, for lit passes and compute passes.
pub fn shadow_layout(device: &wgpu::Device, technique: &dyn ShadowTechnique) -> wgpu::BindGroupLayout {
    binding::layout(device, technique.name(), &technique.binding_types())
}
