//! Bind group 0 of passes that light: the view, the lights, and which of them reach where.

use shadowgraph_core::{Bind, BufferToken, Error as GraphError, Pass, Resources, ShaderPass};
use shadowgraph_shaders::{CLUSTERED, ModuleSource};

use crate::ViewBuffers;

/// The layouts of group 0, without and with clusters of lights.
pub(crate) struct ViewLayouts {
    pub(crate) plain: wgpu::BindGroupLayout,
    pub(crate) clustered: wgpu::BindGroupLayout,
}

impl ViewLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let entry = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = |entries: &[_]| {
            let label = Some("view");
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries })
        };
        Self {
            plain: layout(&[entry(0), entry(1)]),
            clustered: layout(&[
                entry(0),
                entry(1),
                wgpu::BindGroupLayoutEntry { visibility: wgpu::ShaderStages::FRAGMENT, ..entry(2) },
            ]),
        }
    }
}

/// The buffers in a pass that has declared to read them.
pub(crate) struct ViewTokens {
    view: BufferToken,
    lights: BufferToken,
    clusters: Option<BufferToken>,
}

impl ViewBuffers {
    /// Declares that `pass` reads all of them.
    pub(crate) fn read_in<K: ShaderPass>(&self, pass: &mut Pass<'_, '_, K>) -> ViewTokens {
        ViewTokens {
            view: pass.storage_buffer(&self.view),
            lights: pass.storage_buffer(&self.lights),
            clusters: self.clusters.as_ref().map(|clusters| pass.storage_buffer(clusters)),
        }
    }
}

impl ViewTokens {
    pub(crate) fn bind_group(
        &self,
        resources: &Resources<'_>,
        layouts: &ViewLayouts,
    ) -> Result<wgpu::BindGroup, GraphError> {
        let (view, lights) = (Bind::Buffer(self.view), Bind::Buffer(self.lights));
        match self.clusters {
            None => resources.bind_group(&layouts.plain, &[view, lights]),
            Some(clusters) => {
                resources.bind_group(&layouts.clustered, &[view, lights, Bind::Buffer(clusters)])
            }
        }
    }
}

/// The modules of a technique, with that of clusters where pixels ask the lights of theirs.
pub(crate) fn with_clusters(modules: &[ModuleSource], clustered: bool) -> Vec<ModuleSource> {
    modules.iter().cloned().chain(clustered.then_some(CLUSTERED)).collect()
}
