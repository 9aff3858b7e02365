//! Bind group 0 of lit passes: the view, the lights, the light clusters and ambient occlusion.

use shadowgraph_core::{Bind, BufferToken, Error as GraphError, Pass, Resources, ShaderPass, TextureToken};
use shadowgraph_shaders::{CLUSTERED, FEW_LIGHTS, ModuleSource, OCCLUDED, SKY_LIGHT};

use crate::uniforms::{LightBinding, ViewBuffers};

/// How lights are read, and the bindings of group 0 that exist besides them and the view, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct OptionalBindings {
    lights: LightBinding,
    /// The lights of each cluster.
    clusters: bool,
    /// Ambient occlusion.
    occlusion: bool,
    /// The sky.
    pub(crate) sky: bool,
    /// Whether the background has a ground below the sky; its height is bound with the sky.
    ground: bool,
}

impl OptionalBindings {
    const COUNT: usize = 24;

    /// Returns the bindings with an [`index`](Self::index).
    fn from_index(index: usize) -> Self {
        let lights = [LightBinding::Storage, LightBinding::Uniform, LightBinding::Sun][index / 8];
        Self {
            lights,
            clusters: index & 1 != 0,
            occlusion: index & 2 != 0,
            sky: index & 4 != 0,
            ground: false,
        }
    }

    /// Returns the number of the layout.
    pub(crate) fn index(self) -> usize {
        let flags = [self.clusters, self.occlusion, self.sky].into_iter().zip([1, 2, 4]);
        flags.map(|(exists, bit)| usize::from(exists) * bit).sum::<usize>() + 8 * self.lights as usize
    }

    /// Creates the layout of group 0.
    fn layout(self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let uniform = buffer(wgpu::BufferBindingType::Uniform);
        let storage = buffer(wgpu::BufferBindingType::Storage { read_only: true });
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let (both, fragment) = (wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::ShaderStages::FRAGMENT);
        let mut types = vec![
            (both, uniform),
            (both, if self.lights == LightBinding::Storage { storage } else { uniform }),
        ];
        if self.clusters {
            types.push((fragment, texture(wgpu::TextureSampleType::Uint)));
        }
        if self.occlusion {
            types.push((fragment, texture(wgpu::TextureSampleType::Float { filterable: false })));
        }
        if self.sky {
            types.push((both, uniform));
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
        match self.lights {
            LightBinding::Storage => {}
            LightBinding::Uniform => all.push(FEW_LIGHTS),
            LightBinding::Sun => {
                all.push(FEW_LIGHTS.with_value("ONLY_SUN: bool = false", "ONLY_SUN: bool = true"))
            }
        }
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
            let has_ground = format!("HAS_GROUND: bool = {}", self.ground);
            add(&SKY_LIGHT.with_value("HAS_GROUND: bool = true", &has_ground), "ENVIRONMENT");
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
    bindings: OptionalBindings,
}

impl ViewBuffers {
    /// Returns how lights are read, and the bindings that exist besides them and the view.
    pub(crate) fn optional_bindings(&self) -> OptionalBindings {
        OptionalBindings {
            lights: self.light_binding,
            clusters: self.clusters.is_some(),
            occlusion: self.occlusion.is_some(),
            sky: self.sky.is_some(),
            ground: false,
        }
    }

    /// Returns the same for a pass that draws the background.
    pub(crate) fn background_bindings(&self) -> OptionalBindings {
        OptionalBindings { ground: self.ground_height.is_some(), ..self.optional_bindings() }
    }

    /// Declares that `pass` reads all of the buffers.
    pub(crate) fn read_in<K: ShaderPass>(&self, pass: &mut Pass<'_, '_, K>) -> ViewTokens {
        self.read_with(pass, self.optional_bindings())
    }

    /// Declares that `pass` reads some of the bindings.
    pub(crate) fn read_with<K: ShaderPass>(
        &self,
        pass: &mut Pass<'_, '_, K>,
        bindings: OptionalBindings,
    ) -> ViewTokens {
        ViewTokens {
            view: pass.uniform_buffer(&self.view),
            lights: match bindings.lights {
                LightBinding::Storage => pass.storage_buffer(&self.lights),
                LightBinding::Uniform | LightBinding::Sun => pass.uniform_buffer(&self.lights),
            },
            clusters: self
                .clusters
                .as_ref()
                .filter(|_| bindings.clusters)
                .map(|clusters| pass.sample(clusters)),
            occlusion: self
                .occlusion
                .as_ref()
                .filter(|_| bindings.occlusion)
                .map(|occlusion| pass.sample(occlusion)),
            sky: self.sky.as_ref().filter(|_| bindings.sky).map(|sky| pass.uniform_buffer(sky)),
            bindings,
        }
    }
}

impl ViewTokens {
    pub(crate) fn bind_group(
        &self,
        resources: &Resources<'_>,
        layouts: &ViewLayouts,
    ) -> Result<wgpu::BindGroup, GraphError> {
        let mut all: [Bind<'_>; 5] = std::array::from_fn(|_| Bind::Buffer(self.view));
        let optional =
            [self.clusters.map(Bind::Texture), self.occlusion.map(Bind::Texture), self.sky.map(Bind::Buffer)];
        let mut count = 1;
        for bind in [Some(Bind::Buffer(self.lights))].into_iter().chain(optional).flatten() {
            all[count] = bind;
            count += 1;
        }
        resources.bind_group(layouts.get(self.bindings), &all[..count])
    }
}
