//! The pass that culls a scene's instances on the GPU.

use std::fmt::Display;
use std::ops::Range;
use std::sync::OnceLock;

use glam::DVec3;
use shadowgraph_core::{
    Bind, Buffer, BufferDesc, Compute, Contents, Error as GraphError, Format, Frame, Pass, RenderContext,
    Texture, TextureDesc,
};
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
    /// The name, for [`CullCounts`].
    pub name: String,
    /// The volume that they intersect.
    pub volume: ConvexVolume,
    /// The flags that they have.
    pub required: CullFlags,
    /// The flags that they do not have.
    pub excluded: CullFlags,
}

/// How many instances the culled views of a frame draw. The passes that cull [publish](Frame::publish) it.
#[derive(Clone, Debug, Default)]
pub struct CullCounts(pub Vec<CullCount>);

/// How many instances some views draw.
#[derive(Clone, Debug)]
pub struct CullCount {
    /// The names of the views.
    pub views: Vec<String>,
    /// The buffer that has the counts.
    pub buffer: Buffer,
    /// The bytes of the counts: a `u32` for each view.
    pub bytes: Range<u64>,
}

impl CullCounts {
    /// Returns the counts that have been published.
    pub fn published_in(frame: &Frame<'_>) -> Self {
        frame.published::<Self>().cloned().unwrap_or_default()
    }

    /// Publishes the counts without those of a view, whose instances are culled again.
    pub(crate) fn remove(frame: &mut Frame<'_>, view: &str) {
        let mut counts = Self::published_in(frame);
        counts.0.retain(|count| count.views.iter().all(|name| name != view));
        frame.publish(counts);
    }
}

/// The compute pass that finds the visible instances of views, and writes an indirect draw for each view and batch of instances with the
/// same mesh and material. Instances stay in order, so images equal those of instances that the CPU culls. Instances are tested as boxes in their
/// own space.
pub struct CullPass {
    device: wgpu::Device,
    shader: wgpu::ShaderModule,
    /// Group 0.
    layout: wgpu::BindGroupLayout,
    /// The pipelines, created on first use.
    by_volume: OnceLock<wgpu::ComputePipeline>,
    by_history: OnceLock<Tested>,
    by_depth: OnceLock<Tested>,
    /// `rank_chunks`, `write_instances`, `write_draws`.
    compaction: OnceLock<[wgpu::ComputePipeline; 3]>,
}

/// A pipeline that tests instances, and the layout of its group 1.
struct Tested {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

/// Bits for the instances that a camera saw in its last frame, and sees in this one.
pub(crate) struct SeenHistory<'t> {
    pub(crate) before: &'t Texture,
    pub(crate) now: &'t mut Texture,
}

/// What instances are tested against besides the volumes of views.
enum Test<'t> {
    None,
    /// What the camera saw in its last frame.
    History(&'t Texture),
    /// What the depth that is drawn does not hide.
    Depth {
        seen: SeenHistory<'t>,
        camera: &'t Buffer,
        pyramid: &'t Buffer,
    },
}

impl CullPass {
    /// The names of the buffers that a pass writes.
    pub const BUFFERS: [&'static str; 4] = ["visible bits", "ranks", "visible instances", "draws"];
    /// The view of what is visible, in [`add_unhidden`](Self::add_unhidden).
    pub(crate) const VISIBLE: u32 = 0;
    /// The view of what is visible and was not seen before.
    pub(crate) const NEW: u32 = 1;

    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let entry = |binding| match binding {
            2 => (binding, UNIFORM),
            _ => (binding, wgpu::BufferBindingType::Storage { read_only: binding < 2 }),
        };
        let entries = [0, 1, 2, 3, 4, 5, 6].map(entry).map(|(binding, ty)| buffer(binding, ty));
        Ok(Self {
            device: device.clone(),
            shader: module(device, "cull.wgsl", &[])?,
            layout: layout(device, &entries),
            by_volume: OnceLock::new(),
            by_history: OnceLock::new(),
            by_depth: OnceLock::new(),
            compaction: OnceLock::new(),
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
        let add = |views| self.add_group(frame, scene, views, Test::None, &note);
        CulledInstances { groups: groups.map(add).collect() }
    }

    /// Adds the pass for instances that a camera saw in its last frame.
    pub(crate) fn add_seen<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        scene: &'f GpuScene,
        view: &CullView,
        seen_before: &Texture,
        note: &dyn Display,
    ) -> CulledInstances {
        let views = std::slice::from_ref(view);
        CulledInstances {
            groups: vec![self.add_group(frame, scene, views, Test::History(seen_before), note)],
        }
    }

    /// Adds the pass for instances that nothing hides. The instances of [`NEW`](Self::NEW) and of further views are among those of
    /// [`VISIBLE`](Self::VISIBLE); `pyramid` is that of the depth that has been drawn.
    pub(crate) fn add_unhidden<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        scene: &'f GpuScene,
        views: &[CullView],
        seen: SeenHistory<'_>,
        (camera, pyramid): (&Buffer, &Buffer),
        note: &dyn Display,
    ) -> CulledInstances {
        let test = Test::Depth { seen, camera, pyramid };
        CulledInstances { groups: vec![self.add_group(frame, scene, views, test, note)] }
    }

    fn add_group<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        scene: &'f GpuScene,
        views: &[CullView],
        test: Test<'_>,
        note: &dyn Display,
    ) -> CulledGroup {
        let inputs = scene.cull_inputs();
        let count = views.len() as u32;
        let chunks = inputs.instance_count.div_ceil(CHUNK);
        let names: Vec<String> = views.iter().map(|view| view.name.clone()).collect();
        let uploaded = frame.upload_buffer("culled views", view_bytes(&inputs, views, scene.origin_world()));
        let words = |words: u32| BufferDesc::new(4 * u64::from(words));
        let [bits, ranks, instances, draws] = Self::BUFFERS;
        let mut bits = frame.create_buffer(bits, words(2 * count * chunks));
        let mut ranks = frame.create_buffer(ranks, words(count * (chunks + 1)));
        let mut instances = frame.create_buffer(instances, BufferDesc::new(inputs.list_bytes(count)));
        let mut draws = frame.create_buffer(draws, BufferDesc::new(inputs.draw_bytes(count)));
        let mut pass = frame.compute_pass("cull");
        pass.note(format_args!("{note}"));
        let views = Bind::Buffer(pass.uniform_buffer(&uploaded));
        let mut write =
            |buffer: &mut Buffer| Bind::Buffer(pass.storage_buffer_mut(buffer, Contents::Overwrite));
        let [bits, ranks, list, arguments] =
            [&mut bits, &mut ranks, &mut instances, &mut draws].map(&mut write);
        let (tested, tests) = self.test(&mut pass, test);
        let pipeline = tested.map_or_else(|| self.by_volume(), |tested| &tested.pipeline);
        let compaction = self.compaction.get_or_init(|| self.create_compaction());
        pass.body(move |ctx| {
            let [batches, all] = [inputs.batches, inputs.instances].map(Bind::ExternalBuffer);
            let group = ctx.bind_group(&self.layout, &[all, batches, views, bits, ranks, list, arguments])?;
            ctx.pass.set_bind_group(0, &group, &[]);
            if let Some(tested) = tested {
                let group = ctx.bind_group(&tested.layout, &tests)?;
                ctx.pass.set_bind_group(1, &group, &[]);
            }
            let of_chunks = chunks.min(MAX_WORKGROUPS);
            let of_batches = inputs.batch_count.div_ceil(CHUNK).max(1);
            let workgroups = [[of_chunks, 1], [count, 1], [of_chunks, count], [of_batches, count]];
            for (pipeline, [x, y]) in std::iter::once(pipeline).chain(compaction).zip(workgroups) {
                ctx.pass.set_pipeline(pipeline);
                ctx.pass.dispatch_workgroups(x, y, 1);
            }
            Ok(())
        });
        let mut counts = CullCounts::published_in(frame);
        let bytes = inputs.count_bytes(count);
        counts.0.push(CullCount { views: names, buffer: draws.clone(), bytes });
        frame.publish(counts);
        CulledGroup { draws, instances }
    }

    /// Declares what a pass reads and writes for a test, and returns its pipeline and its bindings.
    fn test<'f>(
        &'f self,
        pass: &mut Pass<'_, 'f, Compute>,
        test: Test<'_>,
    ) -> (Option<&'f Tested>, Vec<Bind<'f>>) {
        match test {
            Test::None => (None, Vec::new()),
            Test::History(before) => {
                let tested = self.by_history.get_or_init(|| self.create_tested("cull_seen", &[SEEN_BEFORE]));
                (Some(tested), vec![Bind::Texture(pass.sample(before))])
            }
            Test::Depth { seen, camera, pyramid } => {
                let entries = [SEEN_BEFORE, SEEN_NOW, buffer(2, UNIFORM), OCCLUDERS];
                let tested = self.by_depth.get_or_init(|| self.create_tested("cull_hidden", &entries));
                let bindings = vec![
                    Bind::Texture(pass.sample(seen.before)),
                    Bind::Texture(pass.storage_texture_mut(seen.now, Contents::Overwrite)),
                    Bind::Buffer(pass.uniform_buffer(camera)),
                    Bind::Buffer(pass.storage_buffer(pyramid)),
                ];
                (Some(tested), bindings)
            }
        }
    }

    fn by_volume(&self) -> &wgpu::ComputePipeline {
        self.by_volume.get_or_init(|| self.create_pipeline("cull_instances", &self.pipeline_layout(None)))
    }

    fn create_tested(&self, entry: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> Tested {
        let layout = layout(&self.device, entries);
        Tested { pipeline: self.create_pipeline(entry, &self.pipeline_layout(Some(&layout))), layout }
    }

    fn create_compaction(&self) -> [wgpu::ComputePipeline; 3] {
        let layout = self.pipeline_layout(None);
        ["rank_chunks", "write_instances", "write_draws"].map(|entry| self.create_pipeline(entry, &layout))
    }

    fn pipeline_layout(&self, tests: Option<&wgpu::BindGroupLayout>) -> wgpu::PipelineLayout {
        let groups: Vec<_> = [Some(&self.layout), tests].into_iter().filter(Option::is_some).collect();
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("cull"),
            bind_group_layouts: &groups,
            immediate_size: 0,
        })
    }

    fn create_pipeline(&self, entry: &str, layout: &wgpu::PipelineLayout) -> wgpu::ComputePipeline {
        let first_instance = self.device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE);
        let constants = [("FIRST_INSTANCE", f64::from(u8::from(first_instance)))];
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(layout),
            module: &self.shader,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            cache: None,
        })
    }
}

const UNIFORM: wgpu::BufferBindingType = wgpu::BufferBindingType::Uniform;
/// `seen_before` of `cull.wgsl`.
const SEEN_BEFORE: wgpu::BindGroupLayoutEntry = texture(0);
/// `seen_now` of `cull.wgsl`.
const SEEN_NOW: wgpu::BindGroupLayoutEntry = wgpu::BindGroupLayoutEntry {
    ty: wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format: SEEN_FORMAT,
        view_dimension: wgpu::TextureViewDimension::D2,
    },
    ..texture(1)
};
/// `occluders` of `cull.wgsl`.
const OCCLUDERS: wgpu::BindGroupLayoutEntry = buffer(3, wgpu::BufferBindingType::Storage { read_only: true });

/// The format of [`SeenHistory`].
const SEEN_FORMAT: Format = Format::R32Uint;

/// Describes the textures of [`SeenHistory`] for a number of instances.
pub(crate) fn seen_desc(instances: u32) -> TextureDesc {
    // Two words for each chunk.
    let words = 2 * instances.div_ceil(CHUNK).max(1);
    let width = words.min(SEEN_WIDTH);
    TextureDesc::d2(width, words.div_ceil(width), SEEN_FORMAT)
}

/// The width of large textures of [`SeenHistory`].
const SEEN_WIDTH: u32 = 2048;

const fn texture(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
}

const fn buffer(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    }
}

fn layout(device: &wgpu::Device, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("cull"), entries })
}

/// Returns `views` of `cull.wgsl`. Planes that do not fit into the block are left out.
fn view_bytes(inputs: &CullInputs<'_>, views: &[CullView], origin_world: DVec3) -> Vec<u8> {
    let count = views.len() as u32;
    let mut elements = vec![[count, inputs.instance_count, inputs.batch_count, inputs.slot_count]];
    let mut planes = Vec::new();
    for CullView { volume, required, excluded, .. } in views {
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
