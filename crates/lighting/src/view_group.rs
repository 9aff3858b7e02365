//! Bind group 0 of lit passes: the view, the lights, the light clusters and ambient occlusion.

use shadowgraph_core::{Bind, BufferToken, Error as GraphError, Pass, Resources, ShaderPass, TextureToken};
use shadowgraph_shaders::{CLUSTERED, ModuleSource, OCCLUDED};

use crate::uniforms::ViewBuffers;

/// The bindings of group 0 that exist besides the view and the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OptionalBindings {
    /// The lights of each cluster.
    clusters: bool,
    /// Ambient occlusion.
    occlusion: bool,
}

impl OptionalBindings {
    pub(crate) const ALL: [Self; 4] = [
        Self { clusters: false, occlusion: false },
        Self { clusters: true, occlusion: false },
        Self { clusters: false, occlusion: true },
        Self { clusters: true, occlusion: true },
    ];

    /// Returns the index in [`ALL`](Self::ALL).
    pub(crate) fn index(self) -> usize {
        usize::from(self.clusters) + 2 * usize::from(self.occlusion)
    }

    /// Creates the layout of group 0.
    fn layout(self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let buffer = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let (both, fragment) = (wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::ShaderStages::FRAGMENT);
        let mut types = vec![(both, buffer), (both, buffer)];
        if self.clusters {
            types.push((fragment, texture(wgpu::TextureSampleType::Uint)));
        }
        if self.occlusion {
            types.push((fragment, texture(wgpu::TextureSampleType::Float { filterable: false })));
        }
        let entry =
            |(binding, (visibility, ty))| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let entries: Vec<_> = (0..).zip(types).map(entry).collect();
        let label = Some("view");
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
    }

    /// Returns the modules of a technique together with those of the bindings.
    pub(crate) fn add_modules(self, modules: &[ModuleSource]) -> Vec<ModuleSource> {
        let mut all = modules.to_vec();
        all.extend(self.clusters.then_some(CLUSTERED));
        if self.occlusion {
            let number = if self.clusters { "3" } else { "2" };
            all.push(ModuleSource::new(OCCLUDED.file, OCCLUDED.source.replace("OCCLUSION", number)));
        }
        all
    }
}

/// The layouts of group 0, by [`OptionalBindings::index`].
pub(crate) struct ViewLayouts([wgpu::BindGroupLayout; 4]);

impl ViewLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self(OptionalBindings::ALL.map(|bindings| bindings.layout(device)))
    }

    pub(crate) fn get(&self, bindings: OptionalBindings) -> &wgpu::BindGroupLayout {
        &self.0[bindings.index()]
    }
}

/// The tokens of a pass that has declared to read group 0.
pub(crate) struct ViewTokens {
    view: BufferToken,
    lights: BufferToken,
    clusters: Option<TextureToken>,
    occlusion: Option<TextureToken>,
}

impl ViewBuffers {
    /// Returns the bindings that exist besides the view and the lights.
    pub(crate) fn optional_bindings(&self) -> OptionalBindings {
        OptionalBindings { clusters: self.clusters.is_some(), occlusion: self.occlusion.is_some() }
    }

    /// Declares that `pass` reads all of the buffers.
    pub(crate) fn read_in<K: ShaderPass>(&self, pass: &mut Pass<'_, '_, K>) -> ViewTokens {
        ViewTokens {
            view: pass.storage_buffer(&self.view),
            lights: pass.storage_buffer(&self.lights),
            clusters: self.clusters.as_ref().map(|clusters| pass.sample(clusters)),
            occlusion: self.occlusion.as_ref().map(|occlusion| pass.sample(occlusion)),
        }
    }
}

impl ViewTokens {
    pub(crate) fn bind_group(
        &self,
        resources: &Resources<'_>,
        layouts: &ViewLayouts,
    ) -> Result<wgpu::BindGroup, GraphError> {
        let bindings =
            OptionalBindings { clusters: self.clusters.is_some(), occlusion: self.occlusion.is_some() };
        let (view, lights, layout) =
            (Bind::Buffer(self.view), Bind::Buffer(self.lights), layouts.get(bindings));
        match (self.clusters.map(Bind::Texture), self.occlusion.map(Bind::Texture)) {
            (None, None) => resources.bind_group(layout, &[view, lights]),
            (Some(one), None) | (None, Some(one)) => resources.bind_group(layout, &[view, lights, one]),
            (Some(clusters), Some(occlusion)) => {
                resources.bind_group(layout, &[view, lights, clusters, occlusion])
            }
        }
    }
}
