//! The background of a lit pass.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use shadowgraph_shaders::ModuleSource;

use crate::error::Error;
use crate::lit_target::LitTarget;
use crate::prepass::DEPTH_FORMAT;
use crate::shader::module;
use crate::view_group::OptionalBindings;

/// The pipelines that draw the sky, and the ground with its shadows, where a lit pass has drawn nothing.
#[derive(Default)]
pub(crate) struct Background(Mutex<BTreeMap<BackgroundKey, wgpu::RenderPipeline>>);

/// The variant of the technique's modules, and the bindings of group 0.
type BackgroundKey = (u32, OptionalBindings);

impl Background {
    /// Returns the pipeline that draws with these layouts of groups 0 and 1, created on first use from the modules of the technique.
    ///
    /// # Errors
    /// [`Error::Shader`] if the modules do not compose.
    pub(crate) fn pipeline(
        &self,
        device: &wgpu::Device,
        key: BackgroundKey,
        layouts: [&wgpu::BindGroupLayout; 2],
        modules: &[ModuleSource],
        target: &LitTarget,
    ) -> Result<wgpu::RenderPipeline, Error> {
        let mut pipelines = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&key) {
            return Ok(pipeline.clone());
        }
        let shader = module(device, "background.wgsl", &key.1.add_modules(modules))?;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("background"),
            bind_group_layouts: &layouts.map(Some),
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("background"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("vs_background"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(false),
                // The far plane, where nothing is drawn.
                depth_compare: Some(wgpu::CompareFunction::Equal),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: target.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("fs_background"),
                compilation_options: Default::default(),
                targets: &[Some(target.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        pipelines.insert(key, pipeline.clone());
        Ok(pipeline)
    }
}
