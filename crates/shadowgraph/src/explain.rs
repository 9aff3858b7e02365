//! What a technique says about single points, for debugging.

use std::borrow::Cow;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use shadowgraph_core::{Bind, Contents, Format, Frame, Subresource, Texture, TextureDesc};
use shadowgraph_lighting::ViewBuffers;
use shadowgraph_shadows::binding::{STORAGE, UNIFORM, layout};
use shadowgraph_shadows::{
    EXPLANATION_VALUES, ExplanationValues, ShadowExplanation, ShadowFact, ShadowOutputs, shadow_layout,
};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::render_view::RenderView;
use crate::renderer::Renderer;
use crate::renderer::aov::ViewOutput;
use crate::renderer::counts::read_back_error;
use crate::view_options::ViewOptions;

/// A point on a surface that a light may reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowPoint {
    /// The index of the light in the scene's list.
    pub light: u32,
    /// Position, metres relative to the frame's origin.
    pub position: Vec3,
    /// Geometric normal towards the camera, unit length.
    pub normal: Vec3,
    /// Metres in front of the camera.
    pub view_depth_m: f32,
    /// The change of the position to the next pixel right, and to that below, on the plane of the surface, metres.
    pub to_next_pixels: [Vec3; 2],
    /// The pixel, column and row from the top left.
    pub pixel: [u32; 2],
}

/// What a technique says about a point.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedShadow {
    /// Red, green and blue of the light that arrives, 0 to 1, without what techniques compute in screen space.
    pub visibility: Vec3,
    /// Where the technique reads it from.
    pub facts: Vec<ShadowFact>,
}

/// Asks the technique of a renderer about points: [`ShadowTechnique::explanation`](shadowgraph_shadows::ShadowTechnique::explanation).
pub struct ShadowExplainer {
    explanation: ShadowExplanation,
    view_layout: wgpu::BindGroupLayout,
    shadow_layout: wgpu::BindGroupLayout,
    points_layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

/// `POINTS` of `explain.wgsl`.
const POINTS: usize = 64;

/// The width of the results: the values of the technique, and the visibility.
const RESULTS: usize = EXPLANATION_VALUES + 3;

impl ShadowExplainer {
    /// Creates the pipeline for a renderer's technique; `None` if the technique does not explain points.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose, or a failure of the GPU.
    pub fn new(gpu: &Gpu, renderer: &Renderer) -> Result<Option<Self>, Error> {
        let Some(explanation) = renderer.technique().explanation() else { return Ok(None) };
        gpu.checked(|| Self::unchecked(&gpu.device, renderer, explanation)).map(Some)
    }

    fn unchecked(
        device: &wgpu::Device,
        renderer: &Renderer,
        explanation: ShadowExplanation,
    ) -> Result<Self, Error> {
        let technique = renderer.technique();
        let modules = [technique.modules(0), explanation.modules.clone()].concat();
        let module = shadowgraph_shaders::compose("explain.wgsl", &modules)?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("explain.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let view_layout = layout(device, "explain", &[UNIFORM, STORAGE]);
        let shadow_layout = shadow_layout(device, technique);
        let points_layout = layout(device, "explain", &[UNIFORM, WRITTEN]);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("explain"),
            bind_group_layouts: &[Some(&view_layout), Some(&shadow_layout), Some(&points_layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("explain"),
            layout: Some(&pipeline_layout),
            module: &shader,
            entry_point: Some("cs_explain"),
            compilation_options: Default::default(),
            cache: None,
        });
        Ok(Self { explanation, view_layout, shadow_layout, points_layout, pipeline })
    }

    /// Draws the shadows of a view, and returns what the technique says about points of it. `renderer` must have the technique of the one
    /// that the pipeline was created for. A pipeline without the view's buffers among its outputs has no answers.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn explain(
        &self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        options: &ViewOptions,
        points: &[ShadowPoint],
    ) -> Result<Vec<ExplainedShadow>, Error> {
        renderer.begin_frame(gpu, options)?;
        let view = renderer.view(options, None);
        let mut explained = Vec::with_capacity(points.len());
        for points in points.chunks(POINTS) {
            explained.extend(gpu.checked(|| self.explain_in(gpu, renderer, &view, points))?);
        }
        Ok(explained)
    }

    /// Explains as many points as a block has.
    fn explain_in(
        &self,
        gpu: &Gpu,
        renderer: &Renderer,
        view: &RenderView<'_>,
        points: &[ShadowPoint],
    ) -> Result<Vec<ExplainedShadow>, Error> {
        let mut frame = renderer.graph().frame();
        let ViewOutput { view: buffers, shadows, .. } = renderer.add(&mut frame, view)?;
        let Some(buffers) = buffers else { return Ok(Vec::new()) };
        let results = self.add_to(&mut frame, &buffers, &shadows, points);
        let request = frame.read_back_texture(&results, Subresource::FULL);
        let mut executed = gpu.submit(|encoder| renderer.execute(frame, gpu, encoder, None))?;
        let texels = executed.read_back(request).ok_or_else(read_back_error)?;
        Ok(self.decode(&texels.wait(&gpu.device)?))
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        points: &[ShadowPoint],
    ) -> Texture {
        let mut blocks = [PointBlock::zeroed(); POINTS];
        blocks.iter_mut().zip(points).for_each(|(block, point)| *block = PointBlock::new(point));
        let block = frame.uniform(bytemuck::bytes_of(&blocks));
        let count = points.len() as u32;
        let desc = TextureDesc::d2(RESULTS as u32, count, Format::R32Float);
        let mut results = frame.create_texture("explanations", desc);
        let mut pass = frame.compute_pass("explain");
        let shadows = shadows.read_in(&mut pass);
        let (camera, lights) = (pass.uniform_buffer(&view.view), pass.storage_buffer(&view.lights));
        let target = pass.storage_texture_mut(&mut results, Contents::Overwrite);
        pass.body(move |ctx| {
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(camera), Bind::Buffer(lights)])?,
                shadows.bind_group(ctx, &self.shadow_layout)?,
                ctx.bind_group(&self.points_layout, &[Bind::Uniform(block), Bind::Texture(target)])?,
            ];
            ctx.pass.set_pipeline(&self.pipeline);
            for (index, group) in (0..).zip(&groups) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.dispatch_workgroups(count, 1, 1);
            Ok(())
        });
        results
    }

    /// Reads rows of results.
    fn decode(&self, texels: &[u8]) -> Vec<ExplainedShadow> {
        let values: Vec<f32> = texels.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
        let rows = values.as_chunks::<RESULTS>().0.iter();
        let decoded = rows.map(|row| {
            let (facts, visibility) = row.split_at(EXPLANATION_VALUES);
            let mut values: ExplanationValues = [0.0; EXPLANATION_VALUES];
            values.copy_from_slice(facts);
            let facts = (self.explanation.describe)(&values);
            ExplainedShadow { visibility: Vec3::from_slice(visibility), facts }
        });
        decoded.collect()
    }
}

/// `Point` of `explain.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct PointBlock {
    position: Vec3,
    view_depth: f32,
    normal: Vec3,
    light: u32,
    right: Vec3,
    gap: f32,
    down: Vec3,
    gap_: f32,
    pixel: [f32; 2],
    end: [f32; 2],
}

impl PointBlock {
    fn new(point: &ShadowPoint) -> Self {
        let &ShadowPoint { light, position, normal, view_depth_m, to_next_pixels, pixel } = point;
        let [right, down] = to_next_pixels;
        let pixel = pixel.map(|place| place as f32 + 0.5);
        let view_depth = view_depth_m;
        Self { position, view_depth, normal, light, right, down, pixel, ..Self::zeroed() }
    }
}

const WRITTEN: wgpu::BindingType = wgpu::BindingType::StorageTexture {
    access: wgpu::StorageTextureAccess::WriteOnly,
    format: Format::R32Float,
    view_dimension: wgpu::TextureViewDimension::D2,
};
