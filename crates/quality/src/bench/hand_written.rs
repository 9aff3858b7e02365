//! The passes of `minimal_lit` without the graph, hand-written for exactly this frame: textures, views and bind groups are
//! created once, and a frame only writes buffers and encodes.

use std::sync::Arc;

use shadowgraph_core::Format;
use shadowgraph_lighting::{Forward, GpuView, LitOutput, LitPipelines, LitTarget, Prepass, ViewUniforms};
use shadowgraph_shadows::{
    CasterPass, MapPlan, ShadowCasters as _, ShadowInputs, ShadowPlan, ShadowView, TINT_FORMAT, plan_shadows,
};
use wgpu::{BindingResource, TextureUsages};

use super::objects::{attachment, begin, buffer, comparison_sampler, group, range};
use super::{Clock, Counts, FrameTime};
use shadowgraph::RenderView;
use shadowgraph::{Gpu, Renderer};

use crate::Error;

const DEPTH: Format = Format::Depth32Float;
const VIEW_BYTES: u32 = size_of::<ShadowView>() as u32;

/// Everything that stays the same from frame to frame.
pub(super) struct HandWritten<'v> {
    renderer: &'v Renderer,
    view: &'v RenderView<'v>,
    counts: Counts,
    /// The view, the lights, the views of shadow maps, the lights' shadows.
    buffers: [wgpu::Buffer; 4],
    /// The cascades and the atlas, if used.
    maps: [Option<wgpu::TextureView>; 2],
    depth: wgpu::TextureView,
    lit: wgpu::TextureView,
    target: wgpu::TextureView,
    groups: Groups,
    prepass: Prepass,
    pipelines: Arc<LitPipelines>,
    tonemap: wgpu::RenderPipeline,
}

struct Groups {
    casters: wgpu::BindGroup,
    prepass: wgpu::BindGroup,
    view: wgpu::BindGroup,
    shadows: wgpu::BindGroup,
    tonemap: wgpu::BindGroup,
}

/// CPU data of a frame, computed before encoding.
struct FrameData {
    view: ViewUniforms,
    shadows: ShadowPlan,
}

impl<'v> HandWritten<'v> {
    /// Creates the resources of frames that draw `view` into `target`.
    pub(super) fn new(
        gpu: &Gpu,
        renderer: &'v Renderer,
        view: &'v RenderView<'v>,
        target: &wgpu::Texture,
    ) -> Result<Self, Error> {
        let device = &gpu.device;
        let frame_data = frame_data(renderer, view)?;
        let buffers = bytes(&frame_data).map(|bytes| buffer(device, bytes.len() as u64));
        let [width, height] = view.options.size_px;
        let depth = attachment(device, [width, height], DEPTH, TextureUsages::empty());
        let lit = attachment(device, [width, height], Format::Rgba16Float, TextureUsages::TEXTURE_BINDING);
        let map = |plan: &Option<MapPlan>| {
            let map = |plan: &MapPlan| {
                let format = plan.depth.texture_format();
                attachment(device, plan.size_px, format, TextureUsages::TEXTURE_BINDING)
            };
            plan.as_ref().map(map)
        };
        let maps = [map(&frame_data.shadows.cascades), map(&frame_data.shadows.atlas)];
        let (layouts, technique) = (renderer.casters().scene.layouts(), renderer.technique());
        let (format, output) = (Format::Rgba16Float, LitOutput::Light);
        let forward = Forward::new(device, layouts, technique, LitTarget { format, output, samples: 1 })?;
        let prepass = Prepass::new(device, layouts, 1)?;
        let tonemap = tonemap(device, target.format())?;
        Ok(Self {
            counts: counts(&frame_data, view),
            pipelines: forward.pipelines(
                &renderer.casters().scene,
                frame_data.shadows.variant().index(),
                false,
            )?,
            groups: Groups::new(device, (&forward, &prepass, &tonemap), &buffers, &maps, &lit),
            prepass,
            tonemap,
            target: target.create_view(&wgpu::TextureViewDescriptor::default()),
            renderer,
            view,
            buffers,
            maps,
            depth,
            lit,
        })
    }

    /// Returns the contents of each frame.
    pub(super) fn counts(&self) -> Counts {
        self.counts
    }

    /// Encodes and submits one frame.
    pub(super) fn frame(&self, gpu: &Gpu) -> Result<FrameTime, Error> {
        let mut clock = Clock::start();
        let frame_data = frame_data(self.renderer, self.view)?;
        let plan = clock.lap();
        for (buffer, bytes) in self.buffers.iter().zip(bytes(&frame_data)) {
            gpu.queue.write_buffer(buffer, 0, &bytes);
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode(&mut encoder, &frame_data.shadows);
        drop(frame_data);
        let record = clock.lap();
        let commands = encoder.finish();
        let finish = clock.lap();
        gpu.queue.submit([commands]);
        Ok(FrameTime { plan, record, finish, submit: clock.lap(), ..FrameTime::default() })
    }

    fn encode(&self, encoder: &mut wgpu::CommandEncoder, shadows: &ShadowPlan) {
        let plans = [&shadows.cascades, &shadows.atlas];
        for ((label, plan), map) in ["cascades", "atlas"].into_iter().zip(plans).zip(&self.maps) {
            if let (Some(plan), Some(map)) = (plan, map) {
                self.shadow_map(encoder, label, (plan, &shadows.views), map);
            }
        }
        self.prepass(encoder);
        self.lit(encoder);
        self.tonemap(encoder);
    }

    fn shadow_map(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        label: &str,
        (plan, views): (&MapPlan, &[ShadowView]),
        map: &wgpu::TextureView,
    ) {
        let mut pass = begin(encoder, label, None, Some((map, true)));
        for tile in plan.tiles.iter().filter(|tile| !tile.casters.is_empty()) {
            pass.set_bind_group(0, &self.groups.casters, &[tile.view * VIEW_BYTES]);
            let rect = tile.rect;
            let [x, y, width, height] = [rect.x, rect.y, rect.width, rect.height].map(|px| px as f32);
            pass.set_viewport(x, y, width, height, 0.0, 1.0);
            pass.set_scissor_rect(rect.x, rect.y, rect.width, rect.height);
            let format = plan.depth.texture_format();
            let view = tile.caster_view(&views[tile.view as usize], CasterPass::Depth, format);
            self.renderer.casters().draw(&mut pass, &view, &tile.casters);
        }
    }

    fn prepass(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = begin(encoder, "depth prepass", None, Some((&self.depth, true)));
        pass.set_bind_group(0, &self.groups.prepass, &[0]);
        let pipelines = self.prepass.pipelines();
        self.renderer
            .casters()
            .scene
            .draw(&mut pass, &self.view.draws.solid, &|draw| Some(pipelines.get(draw.key)));
    }

    fn lit(&self, encoder: &mut wgpu::CommandEncoder) {
        let background = self.view.ambient_light.background();
        let mut pass = begin(encoder, "forward", Some((&self.lit, background)), Some((&self.depth, false)));
        pass.set_bind_group(0, &self.groups.view, &[]);
        pass.set_bind_group(1, &self.groups.shadows, &[]);
        for draws in [&self.view.draws.solid, &self.view.draws.blend] {
            self.renderer.casters().scene.draw(&mut pass, draws, &|draw| Some(self.pipelines.get(draw.key)));
        }
    }

    fn tonemap(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = begin(encoder, "tonemap", Some((&self.target, [0.0; 4])), None);
        pass.set_pipeline(&self.tonemap);
        pass.set_bind_group(0, &self.groups.tonemap, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Groups {
    fn new(
        device: &wgpu::Device,
        (forward, prepass, tonemap): (&Forward, &Prepass, &wgpu::RenderPipeline),
        [view_buffer, lights, shadow_views, shadow_lights]: &[wgpu::Buffer; 4],
        maps: &[Option<wgpu::TextureView>; 2],
        lit: &wgpu::TextureView,
    ) -> Self {
        let depth_layout = prepass.pipelines().view_layout();
        // wgpu clears it to zero, which means lit.
        let no_map = attachment(device, [1, 1], DEPTH, TextureUsages::TEXTURE_BINDING);
        let map = |map: &Option<wgpu::TextureView>| map.clone().unwrap_or_else(|| no_map.clone());
        let (cascades, atlas) = (map(&maps[0]), map(&maps[1]));
        let sampler = comparison_sampler(device);
        // There are no tinted shadows.
        let tints = attachment(device, [1; 2], TINT_FORMAT, TextureUsages::TEXTURE_BINDING);
        let tints = BindingResource::TextureView(&tints);
        let shadows = [
            shadow_views.as_entire_binding(),
            shadow_lights.as_entire_binding(),
            BindingResource::TextureView(&cascades),
            BindingResource::TextureView(&atlas),
            tints.clone(),
            tints,
            BindingResource::TextureView(&no_map),
            BindingResource::TextureView(&no_map),
            uniform(shadow_views),
            uniform(shadow_lights),
            BindingResource::Sampler(&sampler),
        ];
        let view_and_lights = [view_buffer.as_entire_binding(), lights.as_entire_binding()];
        let light = [BindingResource::TextureView(lit)];
        Self {
            casters: group(device, depth_layout, [range(shadow_views, VIEW_BYTES)]),
            prepass: group(device, depth_layout, [range(view_buffer, size_of::<GpuView>() as u32)]),
            view: group(device, forward.view_layout(), view_and_lights),
            shadows: group(device, forward.shadow_layout(), shadows),
            tonemap: group(device, &tonemap.get_bind_group_layout(0), light),
        }
    }
}

/// Binds as much of a buffer as a uniform block may have.
fn uniform(buffer: &wgpu::Buffer) -> BindingResource<'_> {
    range(buffer, buffer.size().min(1 << 16) as u32)
}

fn tonemap(device: &wgpu::Device, format: Format) -> Result<wgpu::RenderPipeline, Error> {
    let module = shadowgraph_shaders::compose("tonemap.wgsl", &[])?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("tonemap.wgsl"),
        source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module)),
    });
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("tonemap"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_tonemap"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_tonemap"),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    }))
}

fn frame_data(renderer: &Renderer, view: &RenderView<'_>) -> Result<FrameData, Error> {
    let options = view.options;
    let (camera, size_px, lights) = (&options.camera, options.size_px, renderer.scene().lights());
    let (casters, settings) = (renderer.casters(), &options.shadows);
    let origin_world = casters.scene.origin_world();
    let aspect = f64::from(size_px[0]) / f64::from(size_px[1]);
    let inputs = ShadowInputs { view: 0, camera, aspect, lights, casters, origin_world, settings };
    Ok(FrameData {
        view: ViewUniforms::new(camera, size_px, lights, origin_world, &view.ambient_light),
        shadows: plan_shadows(&inputs)?,
    })
}

/// Returns the contents of the buffers, in order.
fn bytes(frame_data: &FrameData) -> [Vec<u8>; 4] {
    let variant = frame_data.shadows.variant();
    [
        frame_data.view.view_bytes(),
        frame_data.view.light_bytes(),
        frame_data.shadows.view_bytes(variant),
        frame_data.shadows.light_bytes(variant),
    ]
}

fn counts(frame_data: &FrameData, view: &RenderView<'_>) -> Counts {
    let maps = [&frame_data.shadows.cascades, &frame_data.shadows.atlas];
    let casters = maps.into_iter().flatten().flat_map(|map| &map.tiles).map(|tile| tile.casters.len());
    let draws = casters.sum::<usize>() + 2 * view.draws.solid.len() + view.draws.blend.len() + 1;
    Counts { passes: maps.into_iter().flatten().count() + 3, uploads: 4, draws }
}
