//! The pass that culls a scene's instances on the GPU.

use std::fmt::Display;
use std::sync::OnceLock;

use glam::DVec3;
use shadowgraph_core::{Bind, Buffer, BufferDesc, Contents, Error as GraphError, Frame, RenderContext};
use shadowgraph_scene::ConvexVolume;
use shadowgraph_scene::gpu::{CullFlags, CullInputs, CulledView, Draw, DrawPipeline, GpuScene};
use shadowgraph_shadows::{CulledGroup, CulledInstances, CulledTokens};

use crate::error::Error;
use crate::shader::module;

/// Instances of a chunk: `CHUNK` of `cull.wgsl`.
const CHUNK: u32 = 64;
/// Elements of the block of views: `ELEMENTS` of `cull.wgsl`.
const ELEMENTS: usize = 1024;
/// The largest number of workgroups of a dimension, which every device has.
const MAX_WORKGROUPS: u32 = 65_535;

/// The instances that a view draws.
#[derive(Clone, Debug, PartialEq)]
pub struct CullView {
    /// The volume that they intersect.
    pub volume: ConvexVolume,
    /// The flags that they have.
    pub required: CullFlags,
    /// The flags that they do not have.
    pub excluded: CullFlags,
}

/// The compute pass that finds the visible instances of views, and writes an indirect draw for each view and batch of instances with the
/// same mesh and material. Instances stay in order, so images equal those of instances that the CPU culls. Instances are tested as boxes in their
/// own space.
pub struct CullPass {
    device: wgpu::Device,
    layout: wgpu::BindGroupLayout,
    shader: wgpu::ShaderModule,
    /// `cull_instances`, `rank_chunks`, `write_instances`, `write_draws`; created on first use.
    pipelines: OnceLock<[wgpu::ComputePipeline; 4]>,
}

impl CullPass {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let entry = |binding| wgpu::BindGroupLayoutEntry {
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
            label: Some("cull"),
            entries: &[0, 1, 2, 3, 4, 5, 6].map(entry),
        });
        let shader = module(device, "cull.wgsl", &[])?;
        Ok(Self { device: device.clone(), layout, shader, pipelines: OnceLock::new() })
    }

    fn create_pipelines(&self) -> [wgpu::ComputePipeline; 4] {
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("cull"),
            bind_group_layouts: &[Some(&self.layout)],
            immediate_size: 0,
        });
        let first_instance = self.device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE);
        let constants = [("FIRST_INSTANCE", f64::from(u8::from(first_instance)))];
        ["cull_instances", "rank_chunks", "write_instances", "write_draws"].map(|entry| {
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
        })
    }

    /// Adds the pass, and returns the culled instances of each view. `note` says why the GPU culls, for plans.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        scene: &'f GpuScene,
        views: &[CullView],
        note: impl Display,
    ) -> CulledInstances {
        let groups = views.chunks(CulledInstances::VIEWS);
        let add = |views| self.add_group(frame, scene, views, &note);
        CulledInstances { groups: groups.map(add).collect() }
    }

    fn add_group<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        scene: &'f GpuScene,
        views: &[CullView],
        note: &dyn Display,
    ) -> CulledGroup {
        let inputs = scene.cull_inputs();
        let count = views.len() as u32;
        let chunks = inputs.instance_count.div_ceil(CHUNK);
        let uploaded = frame.upload_buffer("culled views", view_bytes(&inputs, views, scene.origin_world()));
        let words = |words: u32| BufferDesc::new(4 * u64::from(words));
        let mut bits = frame.create_buffer("visible bits", words(2 * count * chunks));
        let mut ranks = frame.create_buffer("ranks", words(count * (chunks + 1)));
        let mut instances =
            frame.create_buffer("visible instances", BufferDesc::new(inputs.list_bytes(count)));
        let mut draws = frame.create_buffer("draws", BufferDesc::new(inputs.draw_bytes(count)));
        let mut pass = frame.compute_pass("cull");
        pass.note(format_args!("{note}"));
        let views = Bind::Buffer(pass.uniform_buffer(&uploaded));
        let mut write =
            |buffer: &mut Buffer| Bind::Buffer(pass.storage_buffer_mut(buffer, Contents::Overwrite));
        let [bits, ranks, list, arguments] =
            [&mut bits, &mut ranks, &mut instances, &mut draws].map(&mut write);
        let pipelines = self.pipelines.get_or_init(|| self.create_pipelines());
        pass.body(move |ctx| {
            let [batches, all] = [inputs.batches, inputs.instances].map(Bind::ExternalBuffer);
            let group = ctx.bind_group(&self.layout, &[all, batches, views, bits, ranks, list, arguments])?;
            ctx.pass.set_bind_group(0, &group, &[]);
            let of_chunks = chunks.min(MAX_WORKGROUPS);
            let of_batches = inputs.batch_count.div_ceil(CHUNK).max(1);
            let workgroups = [[of_chunks, 1], [count, 1], [of_chunks, count], [of_batches, count]];
            for (pipeline, [x, y]) in pipelines.iter().zip(workgroups) {
                ctx.pass.set_pipeline(pipeline);
                ctx.pass.dispatch_workgroups(x, y, 1);
            }
            Ok(())
        });
        CulledGroup { draws, instances }
    }
}

/// Returns `views` of `cull.wgsl`. Planes that do not fit into the block are left out.
fn view_bytes(inputs: &CullInputs<'_>, views: &[CullView], origin_world: DVec3) -> Vec<u8> {
    let count = views.len() as u32;
    let mut elements = vec![[count, inputs.instance_count, inputs.batch_count, inputs.slot_count]];
    let mut planes = Vec::new();
    for CullView { volume, required, excluded } in views {
        let first_plane = 1 + views.len() + planes.len();
        let of_view = volume.planes.iter().take(ELEMENTS - first_plane.min(ELEMENTS));
        planes.extend(of_view.map(|plane| {
            let distance = plane.distance + plane.normal.dot(origin_world);
            plane.normal.extend(distance).as_vec4().to_array().map(f32::to_bits)
        }));
        let end = 1 + views.len() + planes.len();
        elements.push([first_plane as u32, (end - first_plane) as u32, required.bits(), excluded.bits()]);
    }
    elements.extend(planes);
    elements.resize(ELEMENTS, [0; 4]);
    bytemuck::cast_slice(&elements).to_vec()
}

/// Records the draws of a culled view, of the batches that have a pipeline, and returns the number of draw calls.
///
/// # Errors
/// For tokens of another pass.
pub fn draw_culled<'p>(
    ctx: &mut RenderContext<'_>,
    scene: &GpuScene,
    culled: CulledTokens,
    pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
) -> Result<u32, GraphError> {
    let inputs = scene.cull_inputs();
    let instances = Bind::BufferRange(culled.instances, 0..inputs.view_bytes());
    let group =
        ctx.bind_group(&scene.layouts().draw, &[Bind::ExternalBuffer(inputs.instances), instances])?;
    let view = CulledView { group: &group, draws: ctx.buffer(culled.draws)?, view: culled.view };
    Ok(scene.draw_culled(&mut ctx.pass, view, pipeline_for))
}
