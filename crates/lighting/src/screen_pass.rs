//! Fullscreen passes that evaluate shadows.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use shadowgraph_core::Format;
use shadowgraph_shaders::ModuleSource;
use shadowgraph_shadows::{ShadowTechnique, shadow_layout};

use crate::error::Error;
use crate::shader::module;
use crate::view_group::{OptionalBindings, ViewLayouts};

/// The pipelines of a fullscreen pass from a built-in shader. Group 0 is the view, 1 the shadows, 2 the pass's own bindings.
pub(crate) struct ScreenPass {
    device: wgpu::Device,
    pub(crate) view_layouts: ViewLayouts,
    pub(crate) shadow_layout: wgpu::BindGroupLayout,
    pub(crate) pass_layout: wgpu::BindGroupLayout,
    shader: ScreenShader,
    /// The technique's modules of each variant.
    modules: Vec<Vec<ModuleSource>>,
    pipelines: Mutex<BTreeMap<PipelineKey, wgpu::RenderPipeline>>,
}

/// A built-in shader, its entry points and its target.
#[derive(Clone, Copy)]
pub(crate) struct ScreenShader {
    pub(crate) file: &'static str,
    pub(crate) entries: [&'static str; 2],
    pub(crate) format: Format,
    pub(crate) blend: Option<wgpu::BlendState>,
}

/// The properties that distinguish the pipelines of a pass.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PipelineKey {
    /// The variant of the technique's modules.
    pub(crate) variant: u32,
    /// The value of the constants; its meaning depends on the shader.
    pub(crate) constant: u32,
    /// The optional bindings of group 0.
    pub(crate) bindings: OptionalBindings,
}

impl ScreenPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        technique: &dyn ShadowTechnique,
        shader: ScreenShader,
        bindings: &[wgpu::BindingType],
    ) -> Result<Self, Error> {
        let entry = |(binding, &ty): (u32, &_)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let entries: Vec<_> = (0..).zip(bindings).map(entry).collect();
        let pass_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(shader.file),
            entries: &entries,
        });
        let modules: Vec<_> =
            (0..technique.variant_count()).map(|variant| technique.modules(variant)).collect();
        // WGSL that does not compose is reported now and not in a later frame.
        shadowgraph_shaders::compose(shader.file, modules.first().map_or(&[], Vec::as_slice))?;
        Ok(Self {
            device: device.clone(),
            view_layouts: ViewLayouts::new(device),
            shadow_layout: shadow_layout(device, technique),
            pass_layout,
            shader,
            modules,
            pipelines: Mutex::default(),
        })
    }

    /// Returns the pipeline of a key, which is created with these constants on first use.
    pub(crate) fn pipeline(
        &self,
        key: PipelineKey,
        constants: &[(&'static str, f64)],
    ) -> Result<wgpu::RenderPipeline, Error> {
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&key) {
            return Ok(pipeline.clone());
        }
        let ScreenShader { file, entries: [vertex, fragment], format, blend } = self.shader;
        let modules = self.modules.get(key.variant as usize).or(self.modules.first());
        let modules = key.bindings.add_modules(modules.map_or(&[], Vec::as_slice));
        let module = module(&self.device, file, &modules)?;
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(file),
            bind_group_layouts: &[
                Some(self.view_layouts.get(key.bindings)),
                Some(&self.shadow_layout),
                Some(&self.pass_layout),
            ],
            immediate_size: 0,
        });
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(file),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                targets: &[Some(wgpu::ColorTargetState {
                    format,
                    blend,
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        pipelines.insert(key, pipeline.clone());
        Ok(pipeline)
    }
}

/// Returns the binding type of a texture that is read without a sampler.
pub(crate) const fn texels(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}
