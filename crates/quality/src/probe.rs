//! Evaluates a technique at arbitrary points, independent of what the camera sees.

use std::borrow::Cow;
use std::sync::Arc;

use shadowgraph_core::{
    Bind, Contents, Format, Frame, Graph, PassTime, Plan, ResourceDesc, Subresource, TextureDesc, Timer,
};
use shadowgraph_lighting::{Geometry, ViewUniforms};
use shadowgraph_scene::gpu::DrawList;
use shadowgraph_shadows::binding::{FLOAT_MAP, STORAGE, UNIFORM, layout};
use shadowgraph_shadows::{
    CullSettings, ShadowCounts, ShadowInputs, ShadowSettings, add_shadows, shadow_layout,
};

use super::Surfaces;
use super::comparator::pixel_m_at_1m;
use super::counting::CountingCasters;
use super::report::Cost;
use shadowgraph::RenderView;
use shadowgraph::SurfaceDrawer;
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// `RECEIVER_COARSER` of `receiver.wgsl`.
const COARSER: u32 = 8;

/// The side of a workgroup of `probe.wgsl`, points.
const WORKGROUP: u32 = 8;

/// The node around all passes of the technique.
const TECHNIQUE: &str = "technique";

/// Evaluates a renderer's technique in a compute pass, through the point function of the technique contract.
pub struct Probe {
    view_layout: wgpu::BindGroupLayout,
    shadow_layout: wgpu::BindGroupLayout,
    points_layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    /// Draws the surface buffers, if the technique reads them.
    surfaces: Option<SurfaceDrawer>,
}

/// World points to evaluate, on the GPU.
pub struct Points {
    texture: wgpu::Texture,
    size: [u32; 2],
}

/// A query: which light, and which of its maps.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// Index of the light in the scene's list.
    pub light: u32,
    /// Whether the next coarser of the maps that cover a point is used, if there is one.
    pub coarser: bool,
}

/// Visibility according to a technique at points, and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// Visibility at each point, 0 to 1; 0 where the image has no surface.
    pub visibility: Vec<f32>,
    /// Cost of the technique's passes.
    pub cost: Cost,
}

impl Points {
    /// Uploads the surfaces of an image. They are valid until the renderer moves to another origin.
    #[must_use]
    pub fn new(gpu: &Gpu, surfaces: &Surfaces) -> Self {
        let [width, height] = surfaces.size_px;
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("points"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Format::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 16), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), surfaces.texels(), layout, size);
        Self { texture, size: surfaces.size_px }
    }
}

impl Probe {
    /// Creates the pipeline for a renderer's technique.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose, or a failure of the GPU.
    pub fn new(gpu: &Gpu, renderer: &Renderer) -> Result<Self, Error> {
        gpu.checked(|| Self::unchecked(&gpu.device, renderer))
    }

    fn unchecked(device: &wgpu::Device, renderer: &Renderer) -> Result<Self, Error> {
        let module = shadowgraph_shaders::compose("probe.wgsl", &renderer.technique().modules(0))?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("probe.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let view_layout = layout(device, "probe", &[UNIFORM, STORAGE]);
        let points_layout = layout(device, "probe", &[UNIFORM, FLOAT_MAP, RESULTS]);
        let shadow_layout = shadow_layout(device, renderer.technique());
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("probe"),
            bind_group_layouts: &[Some(&view_layout), Some(&shadow_layout), Some(&points_layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("probe"),
            layout: Some(&pipeline_layout),
            module: &shader,
            entry_point: Some("cs_probe"),
            compilation_options: Default::default(),
            cache: None,
        });
        let layouts = renderer.casters().scene.layouts();
        let reads = renderer.technique().reads_surface_buffers();
        let surfaces = reads.then(|| SurfaceDrawer::new(device, layouts)).transpose()?;
        Ok(Self { view_layout, shadow_layout, points_layout, pipeline, surfaces })
    }

    /// Draws the shadows of a view, and evaluates them at all points.
    ///
    /// # Errors
    /// Settings out of range, or a failure of the GPU.
    pub fn evaluate(
        &self,
        gpu: &Gpu,
        renderer: &Renderer,
        options: &ViewOptions,
        points: &Points,
        query: Query,
    ) -> Result<Results, Error> {
        // Points may be outside the view, and are evaluated in coarser cascades than usual.
        let mut options = options.clone();
        options.shadows = ShadowSettings { cull: CullSettings::NONE, ..options.shadows.without_cache() };
        let view = renderer.view(&options, None);
        let (draws, casters) = (view.list_draws(), CountingCasters::new(renderer.casters()));
        let (mut graph, mut timer) = (renderer.graph(), Timer::new());
        let drawn = gpu.checked(|| {
            let inputs =
                ProbeInputs { renderer, view: &view, draws: &draws, casters: &casters, points, query };
            self.execute(gpu, &inputs, &mut graph, &mut timer)
        })?;
        let visibility =
            drawn.texels.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
        let times = timer.read(&gpu.device, &gpu.queue)?;
        let technique_times = times.iter().filter(|time| is_technique(&time.pass));
        let gpu_ms = technique_times.filter_map(PassTime::gpu_share_ms);
        let (draws, triangles) = casters.counts();
        let count_of =
            |name| drawn.counts.iter().find(|count| count.0 == name).map(|count| u64::from(count.1));
        let drawn_into_pages = count_of(ShadowCounts::CASTERS);
        let cost = Cost {
            gpu_ms: gpu_ms.reduce(|a, b| a + b),
            texture_bytes: texture_bytes(&drawn.plan),
            draws: draws + drawn_into_pages.unwrap_or(0),
            triangles: drawn_into_pages.is_none().then_some(triangles),
            pages: count_of(ShadowCounts::PAGES),
        };
        Ok(Results { visibility, cost })
    }

    fn execute<'f>(
        &'f self,
        gpu: &Gpu,
        inputs: &ProbeInputs<'f>,
        graph: &mut Graph,
        timer: &mut Timer,
    ) -> Result<Drawn, Error> {
        let ProbeInputs { renderer, view, draws, casters, points, query } = *inputs;
        let options = view.options;
        let scene = &renderer.casters().scene;
        let (lights, origin_world) = (renderer.scene().lights(), scene.origin_world());
        let mut frame = graph.frame();
        view.add_pose(&mut frame);
        let uniforms =
            ViewUniforms::new(&options.camera, options.size_px, lights, origin_world, &view.ambient_light);
        let buffers = uniforms.upload(&mut frame);
        let geometry = Geometry { scene, draws, culled: None, size_px: options.size_px };
        let surface_buffers = self
            .surfaces
            .as_ref()
            .map(|drawer| drawer.surface_buffers_with_prepass(&mut frame, &buffers, &geometry));
        let surface_buffers = surface_buffers.transpose()?;
        let shadow_inputs = ShadowInputs {
            view: 0,
            camera: &options.camera,
            aspect: options.aspect(),
            lights,
            casters,
            origin_world,
            settings: &options.shadows,
        };
        let add = |frame: &mut Frame<'f>| {
            add_shadows(renderer.technique(), frame, &shadow_inputs, surface_buffers.as_ref())
        };
        let shadows = frame.node(TECHNIQUE, add)?;

        let block = Query::to_bytes(query, pixel_m_at_1m(&options.camera, options.size_px[1]));
        let block = frame.uniform(&block);
        let point_texture = frame.import_texture("points", &points.texture, true);
        let [width, height] = points.size;
        let mut results = frame.create_texture("results", TextureDesc::d2(width, height, Format::R32Float));
        let mut pass = frame.compute_pass("probe");
        let shadows = shadows.read_in(&mut pass);
        let (eye, lights) = (pass.uniform_buffer(&buffers.view), pass.storage_buffer(&buffers.lights));
        let point_texture = pass.sample(&point_texture);
        let target = pass.storage_texture_mut(&mut results, Contents::Overwrite);
        pass.body(move |ctx| {
            let eye = ctx.bind_group(&self.view_layout, &[Bind::Buffer(eye), Bind::Buffer(lights)])?;
            let shadows = shadows.bind_group(ctx, &self.shadow_layout)?;
            let entries = [Bind::Uniform(block), Bind::Texture(point_texture), Bind::Texture(target)];
            let point_group = ctx.bind_group(&self.points_layout, &entries)?;
            ctx.pass.set_pipeline(&self.pipeline);
            for (index, group) in (0..).zip([&eye, &shadows, &point_group]) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.dispatch_workgroups(width.div_ceil(WORKGROUP), height.div_ceil(WORKGROUP), 1);
            Ok(())
        });
        let request = frame.read_back_texture(&results, Subresource::FULL);
        let counts = frame.published::<ShadowCounts>().ok().cloned();
        let counts = counts.map(|ShadowCounts { names, buffer, bytes, .. }| {
            (names, frame.read_back_buffer(&buffer, Subresource::FULL.bytes(bytes)))
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let compiled = graph.compile(frame)?;
        let mut executed = compiled.execute_timed(graph, &gpu.device, &mut encoder, timer)?;
        gpu.queue.submit([encoder.finish()]);
        let mut read_back = |request| -> Result<Vec<u8>, Error> {
            let bytes = executed.read_back(request).ok_or(Error::MissingReadback)?;
            Ok(bytes.wait(&gpu.device)?)
        };
        let texels = read_back(request)?;
        let counts =
            counts.map(|(names, request)| Ok::<_, Error>((names, read_back(request)?))).transpose()?;
        let counts = counts.map_or_else(Vec::new, |(names, bytes)| {
            let numbers = bytes.as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes));
            names.iter().copied().zip(numbers).collect()
        });
        Ok(Drawn { texels, counts, plan: executed.shared_plan() })
    }
}

/// What is read back of a frame.
struct Drawn {
    /// Visibility at the points.
    texels: Vec<u8>,
    /// What the technique's passes have counted.
    counts: Vec<(&'static str, u32)>,
    plan: Arc<Plan>,
}

#[derive(Clone, Copy)]
struct ProbeInputs<'f> {
    renderer: &'f Renderer,
    view: &'f RenderView<'f>,
    draws: &'f DrawList,
    casters: &'f CountingCasters<'f>,
    points: &'f Points,
    query: Query,
}

impl Query {
    /// Returns the bytes of `Query` of `probe.wgsl`.
    fn to_bytes(self, pixel_world: f32) -> [u8; 16] {
        let flags = if self.coarser { COARSER } else { 0 };
        bytemuck::cast([self.light, flags, pixel_world.to_bits(), 0])
    }
}

fn is_technique(path: &str) -> bool {
    path.strip_prefix(TECHNIQUE).is_some_and(|rest| rest.starts_with('/'))
}

/// Returns the size of the textures that the technique's passes write, each counted once.
fn texture_bytes(plan: &Plan) -> u64 {
    let passes = plan.order().iter().filter(|&&pass| is_technique(&plan.pass_path(pass)));
    let written = passes.flat_map(|&pass| plan.accesses(pass)).filter(|access| access.contents.is_some());
    let mut textures: Vec<_> = written.map(|access| access.resource).collect();
    textures.sort_unstable();
    textures.dedup();
    let bytes = textures.into_iter().map(|texture| match plan.resource(texture).desc {
        ResourceDesc::Texture(desc) => desc.bytes(),
        ResourceDesc::Buffer(_) => 0,
    });
    bytes.sum()
}

const RESULTS: wgpu::BindingType = wgpu::BindingType::StorageTexture {
    access: wgpu::StorageTextureAccess::WriteOnly,
    format: Format::R32Float,
    view_dimension: wgpu::TextureViewDimension::D2,
};
