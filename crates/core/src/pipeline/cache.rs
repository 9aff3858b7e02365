//! Pipelines by the shader and the targets that they are made of.

use super::shader::{ProgrammableStage, Source};
use crate::desc::Format;
use crate::device::MAX_COLOR_ATTACHMENTS;
use crate::error::Error;
use crate::internal;
use arrayvec::ArrayVec;
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A pipeline, and the layout of its group 0.
#[derive(Clone)]
pub(crate) struct CachedPipeline<P> {
    pub(crate) pipeline: P,
    /// Kept, since getting it from wgpu costs more than finding the pipeline.
    pub(crate) layout: wgpu::BindGroupLayout,
}

struct Entry<K, P> {
    stage: Arc<ProgrammableStage>,
    key: K,
    /// Kept for further pipelines of the same source.
    module: wgpu::ShaderModule,
    cached: CachedPipeline<P>,
    used: u64,
}

/// Pipelines of one kind, by a hash of stage and key; colliding ones share a list.
struct Table<K, P>(FxHashMap<u64, Vec<Entry<K, P>>>);

/// The pipelines of one-line passes, for one device.
///
/// A pipeline is expensive to create, so it is kept while its shader exists elsewhere. After that it is dropped when idle, like
/// other objects, so that shaders that are created in each frame find their pipelines too.
#[derive(Default)]
pub(crate) struct PipelineCache {
    frame: u64,
    vertex: Option<wgpu::ShaderModule>,
    render: Table<PipelineTargets, wgpu::RenderPipeline>,
    compute: Table<(), wgpu::ComputePipeline>,
}

impl PipelineCache {
    /// Starts a frame and drops what was last used before frame `oldest`.
    pub(crate) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        self.render.drop_unused(oldest);
        self.compute.drop_unused(oldest);
    }

    /// Returns the pipeline that draws a fragment stage into targets.
    pub(crate) fn render(
        &mut self,
        device: &wgpu::Device,
        stage: &Arc<ProgrammableStage>,
        targets: &PipelineTargets,
    ) -> Result<CachedPipeline<wgpu::RenderPipeline>, Error> {
        let vertex = &mut self.vertex;
        self.render.get_or_create(self.frame, device, stage, targets, |module| {
            let vertex = vertex.get_or_insert_with(|| internal::fullscreen(device));
            render_pipeline(device, stage, vertex, module, targets)
        })
    }

    /// Returns the pipeline of a compute stage.
    pub(crate) fn compute(
        &mut self,
        device: &wgpu::Device,
        stage: &Arc<ProgrammableStage>,
    ) -> Result<CachedPipeline<wgpu::ComputePipeline>, Error> {
        self.compute.get_or_create(self.frame, device, stage, &(), |module| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(&stage.name),
                layout: None,
                module,
                entry_point: stage.entry_point.as_deref(),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants(stage),
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

/// Both kinds of pipeline.
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
    fn get_or_create(
        &mut self,
        frame: u64,
        device: &wgpu::Device,
        stage: &Arc<ProgrammableStage>,
        key: &K,
        create: impl FnOnce(&wgpu::ShaderModule) -> P,
    ) -> Result<CachedPipeline<P>, Error> {
        let mut hasher = FxHasher::default();
        stage.hash.hash(&mut hasher);
        key.hash(&mut hasher);
        let hash = hasher.finish();
        let same = |other: &Arc<ProgrammableStage>| Arc::ptr_eq(other, stage) || other.is_equivalent(stage);
        let list = self.0.get_mut(&hash);
        if let Some(entry) =
            list.and_then(|list| list.iter_mut().find(|entry| entry.key == *key && same(&entry.stage)))
        {
            entry.used = frame;
            if !Arc::ptr_eq(&entry.stage, stage) {
                // The latest user is the likeliest to keep the shader.
                entry.stage = stage.clone();
            }
            return Ok(entry.cached.clone());
        }
        let module = match self.module(stage) {
            Some(module) => module,
            None => create_module(device, stage)?,
        };
        let pipeline = stage.checked(device, "", || create(&module))?;
        let cached = with_layout(device, stage, pipeline)?;
        let entry =
            Entry { stage: stage.clone(), key: key.clone(), module, cached: cached.clone(), used: frame };
        self.0.entry(hash).or_default().push(entry);
        Ok(cached)
    }

    /// Returns the module of another pipeline of the same source.
    fn module(&self, stage: &ProgrammableStage) -> Option<wgpu::ShaderModule> {
        let mut all = self.0.values().flatten();
        all.find(|entry| entry.stage.source == stage.source).map(|entry| entry.module.clone())
    }

    fn drop_unused(&mut self, oldest: u64) {
        self.0.retain(|_, list| {
            list.retain(|entry| entry.used >= oldest || Arc::strong_count(&entry.stage) > 1);
            !list.is_empty()
        });
    }

    #[cfg(test)]
    fn len(&self) -> usize {
        self.0.values().map(Vec::len).sum()
    }
}

fn create_module(device: &wgpu::Device, stage: &ProgrammableStage) -> Result<wgpu::ShaderModule, Error> {
    match &stage.source {
        Source::Module(module) => Ok(module.clone()),
        Source::Wgsl(text) => stage.checked(device, "", || {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(&stage.name),
                source: wgpu::ShaderSource::Wgsl((&**text).into()),
            })
        }),
    }
}

/// Finds the layout of group 0. A shader that binds anything in another group is an error here: nothing fills that group,
/// and wgpu would report it only at the end of the caller's encoder.
fn with_layout<P: Pipeline>(
    device: &wgpu::Device,
    stage: &ProgrammableStage,
    pipeline: P,
) -> Result<CachedPipeline<P>, Error> {
    for group in 1..device.limits().max_bind_groups {
        let empty = || {
            let layout = &pipeline.group_layout(group);
            device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &[] })
        };
        if stage.checked(device, "", empty).is_err() {
            return Err(stage.error(format!(
                "it has bindings in group {group}, but a one-line pass binds group 0 only: move them there, or declare \
                 the pass with `render_pass` or `compute_pass` and a body"
            )));
        }
    }
    let layout = stage.checked(device, "", || pipeline.group_layout(0))?;
    Ok(CachedPipeline { pipeline, layout })
}

fn constants(stage: &ProgrammableStage) -> Vec<(&str, f64)> {
    stage.constants.iter().map(|(name, value)| (&**name, *value)).collect()
}

fn render_pipeline(
    device: &wgpu::Device,
    stage: &ProgrammableStage,
    vertex: &wgpu::ShaderModule,
    module: &wgpu::ShaderModule,
    targets: &PipelineTargets,
) -> wgpu::RenderPipeline {
    let state = |&(format, blend): &(Format, Option<wgpu::BlendState>)| wgpu::ColorTargetState {
        format,
        blend: blend.or_else(|| replacing_blend(device, format, targets.depth)),
        write_mask: wgpu::ColorWrites::ALL,
    };
    let color_states: Vec<_> = targets.colors.iter().map(|color| Some(state(color))).collect();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&stage.name),
        layout: None,
        vertex: internal::vertex(vertex),
        primitive: Default::default(),
        depth_stencil: targets.depth.map(depth_state),
        multisample: wgpu::MultisampleState { count: targets.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: stage.entry_point.as_deref(),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants(stage),
                ..Default::default()
            },
            targets: &color_states,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Returns blending that replaces the target, where that makes first frames faster: Mesa's software driver compiles a shader
/// for whole tiles and again for partial ones, but only once if it is blended.
fn replacing_blend(
    device: &wgpu::Device,
    format: Format,
    depth: Option<DepthTarget>,
) -> Option<wgpu::BlendState> {
    let is_compiled_twice = depth.is_none() && device.adapter_info().driver == "llvmpipe";
    let flags = || format.guaranteed_format_features(device.features()).flags;
    let is_blendable = is_compiled_twice && flags().contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
    is_blendable.then_some(wgpu::BlendState::REPLACE)
}

fn depth_state(depth: DepthTarget) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: depth.format,
        depth_write_enabled: Some(depth.write),
        depth_compare: Some(depth.compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

/// The attachments that a render pipeline is made for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct PipelineTargets {
    pub(crate) colors: ArrayVec<(Format, Option<wgpu::BlendState>), MAX_COLOR_ATTACHMENTS>,
    pub(crate) depth: Option<DepthTarget>,
    pub(crate) samples: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DepthTarget {
    pub(crate) format: Format,
    pub(crate) write: bool,
    pub(crate) compare: wgpu::CompareFunction,
}
