//! Bind group 0 of lit passes: the view, the lights, the light clusters and ambient occlusion.

use shadowgraph_core::{Bind, BufferToken, Error as GraphError, Pass, Resources, ShaderPass, TextureToken};
use shadowgraph_shaders::{CLUSTERED, ModuleSource, OCCLUDED, SKY_LIGHT};

use crate::uniforms::ViewBuffers;

/// The bindings of group 0 that exist besides the view and the lights, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OptionalBindings {
    /// The lights of each cluster.
    clusters: bool,
    /// Ambient occlusion.
    occlusion: bool,
    /// The sky.
    pub(crate) sky: bool,
}

impl OptionalBindings {
    const COUNT: usize = 8;

    /// Returns the bindings with an [`index`](Self::index).
    fn from_index(index: usize) -> Self {
        Self { clusters: index & 1 != 0, occlusion: index & 2 != 0, sky: index & 4 != 0 }
    }

    pub(crate) fn index(self) -> usize {
        usize::from(self.clusters) + 2 * usize::from(self.occlusion) + 4 * usize::from(self.sky)
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
        if self.sky {
            // As a storage buffer, it would be one too many for some techniques.
            let ty = wgpu::BufferBindingType::Uniform;
            let uniforms =
                wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
            types.push((fragment, uniforms));
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
        // The number of the next binding.
        let mut binding = 2 + usize::from(self.clusters);
        let mut add = |module: &ModuleSource, placeholder: &str| {
            all.push(module.with_value(placeholder, &binding.to_string()));
            binding += 1;
        };
        if self.occlusion {
            add(&OCCLUDED, "OCCLUSION");
        }
        if self.sky {
            add(&SKY_LIGHT, "ENVIRONMENT");
        }
        all
    }
}

/// The layouts of group 0, by [`OptionalBindings::index`].
pub(crate) struct ViewLayouts([wgpu::BindGroupLayout; OptionalBindings::COUNT]);

impl ViewLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self(std::array::from_fn(|index| OptionalBindings::from_index(index).layout(device)))
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
    sky: Option<BufferToken>,
}

impl ViewBuffers {
    /// Returns the bindings that exist besides the view and the lights.
    pub(crate) fn optional_bindings(&self) -> OptionalBindings {
        OptionalBindings {
            clusters: self.clusters.is_some(),
            occlusion: self.occlusion.is_some(),
            sky: self.sky.is_some(),
        }
    }

    /// Declares that `pass` reads all of the buffers.
    pub(crate) fn read_in<K: ShaderPass>(&self, pass: &mut Pass<'_, '_, K>) -> ViewTokens {
        ViewTokens {
            view: pass.storage_buffer(&self.view),
            lights: pass.storage_buffer(&self.lights),
            clusters: self.clusters.as_ref().map(|clusters| pass.sample(clusters)),
            occlusion: self.occlusion.as_ref().map(|occlusion| pass.sample(occlusion)),
            sky: self.sky.as_ref().map(|sky| pass.uniform_buffer(sky)),
        }
    }
}

impl ViewTokens {
    pub(crate) fn bind_group(
        &self,
        resources: &Resources<'_>,
        layouts: &ViewLayouts,
    ) -> Result<wgpu::BindGroup, GraphError> {
        let bindings = OptionalBindings {
            clusters: self.clusters.is_some(),
            occlusion: self.occlusion.is_some(),
            sky: self.sky.is_some(),
        };
        let mut all: [Bind<'_>; 5] = std::array::from_fn(|_| Bind::Buffer(self.view));
        let optional =
            [self.clusters.map(Bind::Texture), self.occlusion.map(Bind::Texture), self.sky.map(Bind::Buffer)];
        let mut count = 1;
        for bind in [Some(Bind::Buffer(self.lights))].into_iter().chain(optional).flatten() {
            all[count] = bind;
            count += 1;
        }
        resources.bind_group(layouts.get(bindings), &all[..count])
    }
}
