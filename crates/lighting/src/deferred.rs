//! Deferred lighting: each pixel of a G-buffer is lit once.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use shadowgraph_core::{Bind, Contents, Frame, Texture, TextureDesc};
use shadowgraph_shaders::ModuleSource;
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique, shadow_layout};

use crate::view_group::{Extras, ViewLayouts};
use crate::{Error, GBuffer, LitTarget, ViewBuffers};

/// The pass that lights a G-buffer with the shadows of one technique.
pub struct Deferred {
    device: wgpu::Device,
    view_layouts: ViewLayouts,
    shadow_layout: wgpu::BindGroupLayout,
    gbuffer_layout: wgpu::BindGroupLayout,
    target: LitTarget,
    /// The technique's modules in each of its variants.
    modules: Vec<Vec<ModuleSource>>,
    made: Mutex<BTreeMap<Key, wgpu::RenderPipeline>>,
}

/// What pipelines differ in: the technique's variant, whose debug colours are shown, what is bound with the view.
type Key = (u32, u32, Extras);

impl Deferred {
    /// Makes what its pipelines share. The target has one sample a pixel.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose; [`Error::Samples`] for a target of several.
    pub fn new(
        device: &wgpu::Device,
        technique: &dyn ShadowTechnique,
        target: LitTarget,
    ) -> Result<Self, Error> {
        if target.samples != 1 {
            return Err(Error::Samples { samples: target.samples });
        }
        let deferred = Self {
            device: device.clone(),
            view_layouts: ViewLayouts::new(device),
            shadow_layout: shadow_layout(device, technique),
            gbuffer_layout: gbuffer_layout(device),
            target,
            modules: (0..technique.variant_count()).map(|variant| technique.modules(variant)).collect(),
            made: Mutex::default(),
        };
        // What does not compose is told now, not in some frame.
        shadowgraph_shaders::compose("deferred.wgsl", deferred.modules_of(0))?;
        Ok(deferred)
    }

    fn modules_of(&self, variant: u32) -> &[ModuleSource] {
        self.modules.get(variant as usize).or(self.modules.first()).map_or(&[], Vec::as_slice)
    }

    /// Adds the pass that lights what is seen into a new texture, and returns it. Where nothing is drawn it holds
    /// `background`, in the texture's own terms.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose in the variant that the frame asks for.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: &Texture,
        gbuffer: &GBuffer,
        background: [f64; 4],
    ) -> Result<Texture, Error> {
        let (variant, debug_light) = self.target.variant(shadows);
        let pipeline = self.pipeline((variant, debug_light, view.extras()))?;
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let desc = TextureDesc::d2(size.width, size.height, self.target.format);
        let mut light = frame.create_texture("lit", desc);
        let mut pass = frame.render_pass("deferred");
        let (shadows, view) = (shadows.read_in(&mut pass), view.read_in(&mut pass));
        let GBuffer { base_color, material, normals, glow } = gbuffer;
        let texels = [depth, base_color, material, normals, glow].map(|texture| pass.sample(texture));
        pass.color(&mut light, Contents::clear_color(background));
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.shadow_layout)?;
            let gbuffer = ctx.bind_group(&self.gbuffer_layout, &texels.map(Bind::Texture))?;
            ctx.pass.set_pipeline(&pipeline);
            for (index, group) in (0..).zip([&view, &shadows, &gbuffer]) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.draw(0..3, 0..1);
            ctx.note_draws(1);
            Ok(())
        });
        Ok(light)
    }

    fn pipeline(&self, key: Key) -> Result<wgpu::RenderPipeline, Error> {
        let (variant, debug_light, extras) = key;
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = made.get(&key) {
            return Ok(pipeline.clone());
        }
        let modules = extras.with(self.modules_of(variant));
        let module = shadowgraph_shaders::compose("deferred.wgsl", &modules)?;
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("deferred.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("deferred"),
            bind_group_layouts: &[
                Some(self.view_layouts.of(extras)),
                Some(&self.shadow_layout),
                Some(&self.gbuffer_layout),
            ],
            immediate_size: 0,
        });
        let constants = self.target.constants(debug_light);
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("deferred"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_deferred"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs_deferred"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                targets: &[Some(self.target.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        made.insert(key, pipeline.clone());
        Ok(pipeline)
    }
}

/// Group 2: depth, and the textures of the G-buffer in their order.
fn gbuffer_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    use wgpu::TextureSampleType::{Depth, Float, Uint};
    let float = Float { filterable: false };
    let entry = |(binding, sample_type)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    let entries: Vec<_> = (0..).zip([Depth, float, float, Uint, float]).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("G-buffer"),
        entries: &entries,
    })
}
