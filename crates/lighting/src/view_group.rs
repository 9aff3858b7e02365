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
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let entry =
            |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let (both, fragment) = (wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::ShaderStages::FRAGMENT);
        let mut entries = vec![entry(0, both, buffer), entry(1, both, buffer)];
        // Those that are not asked for are bound all the same where the last one is, so that numbers stay: by the lights.
        if self.clusters || self.occlusion {
            entries.push(entry(2, fragment, buffer));
        }
        if self.occlusion {
            entries.push(entry(3, fragment, texture));
        }
        let label = Some("view");
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
    }

    /// The modules of a technique, with those of what is there.
    pub(crate) fn with(self, modules: &[ModuleSource]) -> Vec<ModuleSource> {
        let extras = [self.clusters.then_some(CLUSTERED), self.occlusion.then_some(OCCLUDED)];
        modules.iter().cloned().chain(extras.into_iter().flatten()).collect()
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
    clusters: Option<BufferToken>,
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
            clusters: self.clusters.as_ref().map(|clusters| pass.storage_buffer(clusters)),
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
        let (view, lights) = (Bind::Buffer(self.view), Bind::Buffer(self.lights));
        let clusters = Bind::Buffer(self.clusters.unwrap_or(self.lights));
        let layout = layouts.of(extras);
        match (self.occlusion, extras.clusters) {
            (Some(occlusion), _) => {
                resources.bind_group(layout, &[view, lights, clusters, Bind::Texture(occlusion)])
            }
            (None, true) => resources.bind_group(layout, &[view, lights, clusters]),
            (None, false) => resources.bind_group(layout, &[view, lights]),
        }
    }
}
