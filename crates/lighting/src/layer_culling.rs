//! The pass that culls a scene's instances for views that the GPU has written.

use std::sync::OnceLock;

use bytemuck::{Pod, Zeroable};
use shadowgraph_core::{Bind, Buffer, BufferDesc, Contents, Error as GraphError, Frame, RenderContext};
use shadowgraph_scene::gpu::{CullFlags, Draw, DrawPipeline, GpuScene, LAYER_DRAW_BYTES, LayerDraws};
use shadowgraph_shadows::{LayerTokens, LayeredInstances, TintTokens};

use crate::error::Error;
use crate::shader::module;

/// Threads of a workgroup: `GROUP` of `cull_layers.wgsl`.
const GROUP: u32 = 64;
/// The largest number of workgroups.
const MAX_WORKGROUPS: u32 = 4096;
/// The size of a pair of an instance and a view, bytes.
const PAIR_BYTES: u64 = 8;
/// The least capacity of the list of pairs.
const MIN_PAIRS: u32 = 1 << 18;

/// The instances that are culled for layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerQuery {
    /// The most views.
    pub capacity: u32,
    /// The flags that instances have.
    pub required: CullFlags,
    /// The flags that they do not have.
    pub excluded: CullFlags,
}

/// `CullLayers` of `cull_layers.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct CullLayers {
    instance_count: u32,
    batch_count: u32,
    required: u32,
    excluded: u32,
    pair_capacity: u32,
    view_capacity: u32,
    moving: u32,
    tinting: u32,
}

/// The entry points, in their order.
const ENTRIES: [&str; 6] =
    ["clear_counts", "count_pairs", "choose_views", "recount_pairs", "write_draws", "write_pairs"];

/// The compute pass that finds the instances of views that an earlier pass has written, and writes an indirect draw for each batch of
/// instances with the same mesh and material.
pub struct LayerCullPass {
    device: wgpu::Device,
    shader: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    /// The pipelines of [`ENTRIES`], created on first use.
    pipelines: OnceLock<Vec<wgpu::ComputePipeline>>,
}

impl LayerCullPass {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let buffer = |binding: u32| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match binding {
                    2 => wgpu::BufferBindingType::Uniform,
                    _ => wgpu::BufferBindingType::Storage { read_only: binding < 2 },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("cull layers"),
            entries: &[0, 1, 2, 3, 4, 5, 6].map(buffer),
        });
        let shader = module(device, "cull_layers.wgsl", &[])?;
        Ok(Self { device: device.clone(), shader, layout, pipelines: OnceLock::new() })
    }

    /// Adds the pass. It writes the number of views that are drawn: fewer than there are if they have more instances than fit into the list
    /// of pairs.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        scene: &'f GpuScene,
        views: &mut Buffer,
        query: LayerQuery,
    ) -> LayeredInstances {
        let inputs = scene.cull_inputs();
        let pair_capacity = MIN_PAIRS.max(inputs.instance_count.saturating_mul(2));
        let block = CullLayers {
            instance_count: inputs.instance_count,
            batch_count: inputs.batch_count,
            required: query.required.bits(),
            excluded: query.excluded.bits(),
            pair_capacity,
            view_capacity: query.capacity,
            moving: CullFlags::MOVING.bits(),
            tinting: CullFlags::TINTING_CASTERS.bits(),
        };
        let block = frame.uniform(bytemuck::bytes_of(&block));
        let batches = u64::from(inputs.batch_count.max(1));
        let count_bytes = 4 * (u64::from(query.capacity) + batches);
        let mut counts = frame.create_buffer("layer counts", BufferDesc::new(count_bytes));
        let mut draws = frame.create_buffer("layer draws", BufferDesc::new(batches * LAYER_DRAW_BYTES));
        let pair_bytes = u64::from(pair_capacity) * PAIR_BYTES;
        let pairs = BufferDesc::new(pair_bytes).unordered(PAIR_BYTES as u32);
        let mut pairs = frame.create_buffer("layer pairs", pairs);
        let mut pass = frame.compute_pass("cull layers");
        let views = Bind::Buffer(pass.storage_buffer_mut(views, Contents::Preserve));
        let [counts, arguments, list] = [&mut counts, &mut draws, &mut pairs]
            .map(|buffer| Bind::Buffer(pass.storage_buffer_mut(buffer, Contents::Overwrite)));
        let pipelines = self.pipelines.get_or_init(|| self.create());
        pass.body(move |ctx| {
            let [batches, all] = [inputs.batches, inputs.instances].map(Bind::ExternalBuffer);
            let bindings = [all, batches, Bind::Uniform(block), views, counts, arguments, list];
            let group = ctx.bind_group(&self.layout, &bindings)?;
            ctx.pass.set_bind_group(0, &group, &[]);
            let all = inputs.instance_count.div_ceil(GROUP).clamp(1, MAX_WORKGROUPS);
            for (pipeline, workgroups) in pipelines.iter().zip([16, all, 1, all, 1, all]) {
                ctx.pass.set_pipeline(pipeline);
                ctx.pass.dispatch_workgroups(workgroups, 1, 1);
            }
            Ok(())
        });
        LayeredInstances { draws, pairs }
    }

    fn create(&self) -> Vec<wgpu::ComputePipeline> {
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("cull layers"),
            bind_group_layouts: &[Some(&self.layout)],
            immediate_size: 0,
        });
        let first_instance = self.device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE);
        let constants = [("FIRST_INSTANCE", f64::from(u8::from(first_instance)))];
        let create = |entry| {
            self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&layout),
                module: &self.shader,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                cache: None,
            })
        };
        ENTRIES.into_iter().map(create).collect()
    }
}

/// Records the draws of layers, of the batches that have a pipeline, and returns the number of draw calls. `layout` is that of group 0, with
/// tints or without.
///
/// # Errors
/// For tokens of another pass.
pub fn draw_layers<'p>(
    ctx: &mut RenderContext<'_>,
    scene: &GpuScene,
    layout: &wgpu::BindGroupLayout,
    (tokens, tints): (LayerTokens, Option<TintTokens>),
    pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
) -> Result<u32, GraphError> {
    let batch = Bind::BufferRange(tokens.draws, 0..LAYER_DRAW_BYTES);
    let mut bindings = vec![Bind::Buffer(tokens.views), Bind::Buffer(tokens.depths), batch];
    bindings.extend(tints.into_iter().flat_map(|tints| [tints.depths, tints.densities]).map(Bind::Buffer));
    let views = ctx.bind_group(layout, &bindings)?;
    let instances = Bind::ExternalBuffer(scene.cull_inputs().instances);
    let pairs = ctx.bind_group(&scene.layouts().draw, &[instances, Bind::Buffer(tokens.pairs)])?;
    let draws = LayerDraws { views: &views, pairs: &pairs, draws: ctx.buffer(tokens.draws)? };
    Ok(scene.draw_layers(&mut ctx.pass, draws, pipeline_for))
}
