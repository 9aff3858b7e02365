//! Pipelines by what they are made of.

use super::declaration::{Attachments, Depth};
use super::shader::{Program, Source};
use crate::error::Error;
use crate::internal;
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A pipeline, and the layout of its group 0.
#[derive(Clone)]
pub(super) struct Made<P> {
    pub(super) pipeline: P,
    /// Kept, since asking wgpu for it costs more than finding the pipeline.
    pub(super) layout: wgpu::BindGroupLayout,
}

struct Cached<K, P> {
    program: Arc<Program>,
    key: K,
    /// For further pipelines of the same source.
    module: wgpu::ShaderModule,
    made: Made<P>,
    used: u64,
}

/// Pipelines of one kind, by a hash of program and key; those that share one by chance lie in one list.
struct Table<K, P>(FxHashMap<u64, Vec<Cached<K, P>>>);

/// The pipelines of one-line passes, for one device.
///
/// A pipeline is expensive to make, so it stays as long as the shader that it was made of is still held by somebody,
/// and as long as other things if not: that is for shaders that are made anew in each frame.
#[derive(Default)]
pub(crate) struct Pipelines {
    frame: u64,
    vertex: Option<wgpu::ShaderModule>,
    render: Table<Attachments, wgpu::RenderPipeline>,
    compute: Table<(), wgpu::ComputePipeline>,
}

impl Pipelines {
    /// Starts a frame and drops what was last used before frame `oldest`.
    pub(crate) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        self.render.drop_unused(oldest);
        self.compute.drop_unused(oldest);
    }

    /// Returns the pipeline that draws a program's fragment stage over attachments.
    pub(super) fn render(
        &mut self,
        device: &wgpu::Device,
        program: &Arc<Program>,
        attachments: &Attachments,
    ) -> Result<Made<wgpu::RenderPipeline>, Error> {
        let vertex = &mut self.vertex;
        self.render.get(self.frame, device, program, attachments, |module| {
            let vertex = vertex.get_or_insert_with(|| internal::fullscreen(device));
            render_pipeline(device, program, vertex, module, attachments)
        })
    }

    /// Returns the pipeline of a compute program.
    pub(super) fn compute(
        &mut self,
        device: &wgpu::Device,
        program: &Arc<Program>,
    ) -> Result<Made<wgpu::ComputePipeline>, Error> {
        self.compute.get(self.frame, device, program, &(), |module| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(&program.name),
                layout: None,
                module,
                entry_point: program.entry.as_deref(),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants(program),
                    ..Default::default()
                },
                cache: None,
            })
        })
    }

    #[cfg(test)]
    pub(crate) fn len(&self) -> (usize, usize) {
        (self.render.len(), self.compute.len())
    }
}

/// What both kinds of pipeline can be asked for.
trait Pipeline: Clone {
    fn group_layout(&self, group: u32) -> wgpu::BindGroupLayout;
}

impl Pipeline for wgpu::RenderPipeline {
    fn group_layout(&self, group: u32) -> wgpu::BindGroupLayout {
        self.get_bind_group_layout(group)
    }
}

impl Pipeline for wgpu::ComputePipeline {
    fn group_layout(&self, group: u32) -> wgpu::BindGroupLayout {
        self.get_bind_group_layout(group)
    }
}

impl<K, P> Default for Table<K, P> {
    fn default() -> Self {
        Self(FxHashMap::default())
    }
}

impl<K: Clone + Eq + Hash, P: Pipeline> Table<K, P> {
    fn get(
        &mut self,
        frame: u64,
        device: &wgpu::Device,
        program: &Arc<Program>,
        key: &K,
        create: impl FnOnce(&wgpu::ShaderModule) -> P,
    ) -> Result<Made<P>, Error> {
        let mut hasher = FxHasher::default();
        program.hash.hash(&mut hasher);
        key.hash(&mut hasher);
        let hash = hasher.finish();
        let is = |own: &Arc<Program>| Arc::ptr_eq(own, program) || own.is(program);
        let list = self.0.get_mut(&hash);
        if let Some(own) =
            list.and_then(|list| list.iter_mut().find(|own| own.key == *key && is(&own.program)))
        {
            own.used = frame;
            if !Arc::ptr_eq(&own.program, program) {
                // The one who asks now is the likelier to keep it.
                own.program = program.clone();
            }
            return Ok(own.made.clone());
        }
        let module = match self.module(program) {
            Some(module) => module,
            None => module(device, program)?,
        };
        let pipeline = program.checked(device, "", || create(&module))?;
        let made = made(device, program, pipeline)?;
        let (program, key) = (program.clone(), key.clone());
        self.0.entry(hash).or_default().push(Cached {
            program,
            key,
            module,
            made: made.clone(),
            used: frame,
        });
        Ok(made)
    }

    /// The module of another pipeline of the same source.
    fn module(&self, program: &Program) -> Option<wgpu::ShaderModule> {
        let mut all = self.0.values().flatten();
        all.find(|own| own.program.source == program.source).map(|own| own.module.clone())
    }

    fn drop_unused(&mut self, oldest: u64) {
        self.0.retain(|_, list| {
            list.retain(|own| own.used >= oldest || Arc::strong_count(&own.program) > 1);
            !list.is_empty()
        });
    }

    #[cfg(test)]
    fn len(&self) -> usize {
        self.0.values().map(Vec::len).sum()
    }
}

fn module(device: &wgpu::Device, program: &Program) -> Result<wgpu::ShaderModule, Error> {
    match &program.source {
        Source::Module(module) => Ok(module.clone()),
        Source::Wgsl(text) => program.checked(device, "", || {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(&program.name),
                source: wgpu::ShaderSource::Wgsl((&**text).into()),
            })
        }),
    }
}

/// Finds the layout of group 0, and refuses a program that binds anything in another: nobody would fill it, and wgpu
/// would say so only at the end of the caller's encoder.
fn made<P: Pipeline>(device: &wgpu::Device, program: &Program, pipeline: P) -> Result<Made<P>, Error> {
    for group in 1..device.limits().max_bind_groups {
        let empty = || {
            let layout = &pipeline.group_layout(group);
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &[] })
        };
        if program.checked(device, "", empty).is_err() {
            return Err(program.refused(format!(
                "it binds something in group {group}, and a one-line pass fills group 0 alone: move it there, or declare \
                 the pass with `render_pass` or `compute_pass` and a body"
            )));
        }
    }
    let layout = program.checked(device, "", || pipeline.group_layout(0))?;
    Ok(Made { pipeline, layout })
}

fn constants(program: &Program) -> Vec<(&str, f64)> {
    program.constants.iter().map(|(name, value)| (&**name, *value)).collect()
}

fn render_pipeline(
    device: &wgpu::Device,
    program: &Program,
    vertex: &wgpu::ShaderModule,
    module: &wgpu::ShaderModule,
    attachments: &Attachments,
) -> wgpu::RenderPipeline {
    let state = |&(format, blend): &(_, _)| wgpu::ColorTargetState {
        format,
        blend,
        write_mask: wgpu::ColorWrites::ALL,
    };
    let targets: Vec<_> = attachments.colors.iter().map(|color| Some(state(color))).collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&program.name),
        layout: None,
        vertex: internal::vertex(vertex),
        primitive: Default::default(),
        depth_stencil: attachments.depth.map(depth_state),
        multisample: wgpu::MultisampleState { count: attachments.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: program.entry.as_deref(),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants(program),
                ..Default::default()
            },
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn depth_state(depth: Depth) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: depth.format,
        depth_write_enabled: Some(depth.write),
        depth_compare: Some(depth.compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}
