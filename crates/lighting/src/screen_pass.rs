//! Passes over the whole picture that ask for shadows.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use shadowgraph_core::Format;
use shadowgraph_shaders::ModuleSource;
use shadowgraph_shadows::{ShadowTechnique, shadow_layout};

use crate::Error;
use crate::shader::module;
use crate::view_group::{Extras, ViewLayouts};

/// What such passes are made of: a built-in file with `vs` and `fs` entry points. Group 0 is the view's, 1 the technique's, 2 its own.
pub(crate) struct ScreenPass {
    device: wgpu::Device,
    pub(crate) view_layouts: ViewLayouts,
    pub(crate) shadow_layout: wgpu::BindGroupLayout,
    pub(crate) own_layout: wgpu::BindGroupLayout,
    shader: ScreenShader,
    /// The technique's modules in each of its variants.
    modules: Vec<Vec<ModuleSource>>,
    made: Mutex<BTreeMap<Key, wgpu::RenderPipeline>>,
}

/// A built-in file, and how it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct ScreenShader {
    pub(crate) file: &'static str,
    pub(crate) entries: [&'static str; 2],
    pub(crate) format: Format,
    pub(crate) blend: Option<wgpu::BlendState>,
}

/// What pipelines differ in.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Key {
    /// Of the technique's modules.
    pub(crate) variant: u32,
    /// Of the constants, whatever they mean to the shader.
    pub(crate) constant: u32,
    /// What is bound with the view.
    pub(crate) extras: Extras,
}

impl ScreenPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        technique: &dyn ShadowTechnique,
        shader: ScreenShader,
        own: &[wgpu::BindingType],
    ) -> Result<Self, Error> {
        let entry = |(binding, &ty): (u32, &_)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let entries: Vec<_> = (0..).zip(own).map(entry).collect();
        let own_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(shader.file),
            entries: &entries,
        });
        let modules: Vec<_> =
            (0..technique.variant_count()).map(|variant| technique.modules(variant)).collect();
        // What does not compose is told now, not in some frame.
        shadowgraph_shaders::compose(shader.file, modules.first().map_or(&[], Vec::as_slice))?;
        Ok(Self {
            device: device.clone(),
            view_layouts: ViewLayouts::new(device),
            shadow_layout: shadow_layout(device, technique),
            own_layout,
            shader,
            modules,
            made: Mutex::default(),
        })
    }

    /// Returns the pipeline of a key, with these constants if it is made now.
    pub(crate) fn pipeline(
        &self,
        key: Key,
        constants: &[(&'static str, f64)],
    ) -> Result<wgpu::RenderPipeline, Error> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = made.get(&key) {
            return Ok(pipeline.clone());
        }
        let ScreenShader { file, entries: [vertex, fragment], format, blend } = self.shader;
        let modules = self.modules.get(key.variant as usize).or(self.modules.first());
        let modules = key.extras.with(modules.map_or(&[], Vec::as_slice));
        let module = module(&self.device, file, &modules)?;
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(file),
            bind_group_layouts: &[
                Some(self.view_layouts.of(key.extras)),
                Some(&self.shadow_layout),
                Some(&self.own_layout),
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
        made.insert(key, pipeline.clone());
        Ok(pipeline)
    }
}

/// A texture that is read texel by texel.
pub(crate) const fn texels(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}
