//! Bind group 0 of passes that light: the view, the lights, which of them reach where, and what is occluded.

use shadowgraph_core::{Bind, BufferToken, Error as GraphError, Pass, Resources, ShaderPass, TextureToken};
use shadowgraph_shaders::{CLUSTERED, ModuleSource, OCCLUDED};

use crate::ViewBuffers;

/// What of group 0 is there beside the view and the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Extras {
    /// Each pixel asks the lights of its cluster.
    clusters: bool,
    /// The light from all around is occluded.
    occlusion: bool,
}

impl Extras {
    pub(crate) const ALL: [Self; 4] = [
        Self { clusters: false, occlusion: false },
        Self { clusters: true, occlusion: false },
        Self { clusters: false, occlusion: true },
        Self { clusters: true, occlusion: true },
    ];

    /// Its place in [`ALL`](Self::ALL).
    pub(crate) fn index(self) -> usize {
        usize::from(self.clusters) + 2 * usize::from(self.occlusion)
    }

    /// Makes the layout of group 0.
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
        let mut bindings = vec![(both, buffer), (both, buffer)];
        if self.clusters {
            bindings.push((fragment, texture(wgpu::TextureSampleType::Uint)));
        }
        if self.occlusion {
            bindings.push((fragment, texture(wgpu::TextureSampleType::Float { filterable: false })));
        }
        let entry =
            |(binding, (visibility, ty))| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let entries: Vec<_> = (0..).zip(bindings).map(entry).collect();
        let label = Some("view");
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
    }

    /// The modules of a technique, with those of what is there.
    pub(crate) fn with(self, modules: &[ModuleSource]) -> Vec<ModuleSource> {
        let mut all = modules.to_vec();
        all.extend(self.clusters.then_some(CLUSTERED));
        if self.occlusion {
            let number = if self.clusters { "3" } else { "2" };
            all.push(ModuleSource::new(OCCLUDED.file, OCCLUDED.source.replace("OCCLUSION", number)));
        }
        all
    }
}

/// The layouts of group 0, by [`Extras::index`].
pub(crate) struct ViewLayouts([wgpu::BindGroupLayout; 4]);

impl ViewLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self(Extras::ALL.map(|extras| extras.layout(device)))
    }

    pub(crate) fn of(&self, extras: Extras) -> &wgpu::BindGroupLayout {
        &self.0[extras.index()]
    }
}

/// What a pass binds that has declared to read it.
pub(crate) struct ViewTokens {
    view: BufferToken,
    lights: BufferToken,
    clusters: Option<TextureToken>,
    occlusion: Option<TextureToken>,
}

impl ViewBuffers {
    /// Returns what is there beside the view and the lights.
    pub(crate) fn extras(&self) -> Extras {
        Extras { clusters: self.clusters.is_some(), occlusion: self.occlusion.is_some() }
    }

    /// Declares that `pass` reads all of it.
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
        let extras = Extras { clusters: self.clusters.is_some(), occlusion: self.occlusion.is_some() };
        let (view, lights, layout) = (Bind::Buffer(self.view), Bind::Buffer(self.lights), layouts.of(extras));
        match (self.clusters.map(Bind::Texture), self.occlusion.map(Bind::Texture)) {
            (None, None) => resources.bind_group(layout, &[view, lights]),
            (Some(one), None) | (None, Some(one)) => resources.bind_group(layout, &[view, lights, one]),
            (Some(clusters), Some(occlusion)) => {
                resources.bind_group(layout, &[view, lights, clusters, occlusion])
            }
        }
    }
}
