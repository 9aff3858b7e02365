//! Forward lighting: one pass for all lights and materials.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use shadowgraph_core::{Contents, Frame, Texture, TextureDesc};
use shadowgraph_scene::gpu::{
    AlphaKey, Draw, DrawPipeline, GpuScene, MaterialFeatures, MaterialLayouts, MaterialUse, PipelineKey,
    vertex_layout,
};
use shadowgraph_shaders::ModuleSource;
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique, VertexBuffers, shadow_layout};

use crate::background::Background;
use crate::error::Error;
use crate::geometry::Geometry;
use crate::lit_target::{LitOutput, LitTarget};
use crate::prepass::DEPTH_FORMAT;
use crate::shader::module;
use crate::uniforms::ViewBuffers;
use crate::view_group::{OptionalBindings, ViewLayouts};

/// The pipelines and passes of forward lighting with one shadow technique.
pub struct Forward {
    builder: Arc<PipelineBuilder>,
    /// The technique's modules of each variant.
    modules: Vec<Vec<ModuleSource>>,
    /// The pipelines that frames have used.
    lit: Mutex<BTreeMap<LitKey, Arc<LitPipelines>>>,
    background: Background,
}

/// The properties that distinguish the pipelines of lit passes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct LitKey {
    /// The variant of the technique's modules.
    variant: u32,
    /// The light whose debug colours are shown; 0 for none.
    debug_light: u32,
    /// Whether the pass writes depth, because there is no prepass.
    writes_depth: bool,
    bindings: OptionalBindings,
    materials: MaterialFeatures,
}

/// The pipelines that light with one variant of a technique; each is created on first use.
pub struct LitPipelines {
    builder: Arc<PipelineBuilder>,
    shader: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    key: LitKey,
    /// Whether opaque draws are blended too, which does not change them: their alpha is 1.
    blends_all: bool,
    /// The pipelines by [`PipelineKey::index`].
    pipelines: Vec<OnceLock<wgpu::RenderPipeline>>,
}

impl LitPipelines {
    /// Returns the pipeline for draws with a key. Masked draws have that of opaque ones: the material says where there are holes.
    pub fn get(&self, key: PipelineKey) -> DrawPipeline<'_> {
        let alpha = match key.alpha {
            AlphaKey::Opaque | AlphaKey::Mask if !self.blends_all => AlphaKey::Opaque,
            _ => AlphaKey::Blend,
        };
        let key = PipelineKey { alpha, ..key };
        let create = || self.builder.pipeline(&self.shader, &self.layout, self.key, key);
        DrawPipeline { pipeline: self.pipelines[key.index()].get_or_init(create), material: MaterialUse::All }
    }
}

/// The state that all pipelines of a pass share.
struct PipelineBuilder {
    device: wgpu::Device,
    view_layouts: ViewLayouts,
    shadow_layout: wgpu::BindGroupLayout,
    /// The layouts of groups 2 and 3: material and draw.
    material_layouts: [wgpu::BindGroupLayout; 2],
    target: LitTarget,
}

impl Forward {
    /// Creates the pipelines that light materials of these layouts with the shadows of `technique`.
    ///
    /// # Errors
    /// [`Error::Shader`] if the technique's WGSL does not compose; the message has its file and line.
    pub fn new(
        device: &wgpu::Device,
        layouts: &MaterialLayouts,
        technique: &dyn ShadowTechnique,
        target: LitTarget,
    ) -> Result<Self, Error> {
        let forward = Self {
            builder: Arc::new(PipelineBuilder {
                device: device.clone(),
                view_layouts: ViewLayouts::new(device),
                shadow_layout: shadow_layout(device, technique),
                material_layouts: [layouts.material.clone(), layouts.draw.clone()],
                target,
            }),
            modules: (0..technique.variant_count()).map(|variant| technique.modules(variant)).collect(),
            lit: Mutex::default(),
            background: Background::default(),
        };
        // WGSL that does not compose is reported now and not in a later frame.
        shadowgraph_shaders::compose("forward.wgsl", forward.modules_for(0))?;
        Ok(forward)
    }

    /// Returns the pipeline of the background, if the view has a sky and light is drawn.
    fn background(
        &self,
        variant: u32,
        bindings: OptionalBindings,
    ) -> Result<Option<wgpu::RenderPipeline>, Error> {
        let PipelineBuilder { device, view_layouts, shadow_layout, target, .. } = &*self.builder;
        if !bindings.sky || target.output != LitOutput::Light {
            return Ok(None);
        }
        let layouts = [view_layouts.get(bindings), shadow_layout];
        let modules = self.modules_for(variant);
        self.background.pipeline(device, (variant, bindings), layouts, modules, target).map(Some)
    }

    fn modules_for(&self, variant: u32) -> &[ModuleSource] {
        self.modules.get(variant as usize).or(self.modules.first()).map_or(&[], Vec::as_slice)
    }

    /// Returns the pipelines that light a scene with a variant of the technique ([`ShadowOutputs::variant`]), which are composed
    /// on first use. With `writes_depth` they write depth, for passes without a prepass.
    ///
    /// # Errors
    /// [`Error::Shader`] if the variant's WGSL does not compose.
    pub fn pipelines(
        &self,
        scene: &GpuScene,
        variant: u32,
        writes_depth: bool,
    ) -> Result<Arc<LitPipelines>, Error> {
        self.pipelines_for(LitKey {
            variant,
            debug_light: 0,
            writes_depth,
            bindings: OptionalBindings::default(),
            materials: scene.material_features(),
        })
    }

    fn pipelines_for(&self, key: LitKey) -> Result<Arc<LitPipelines>, Error> {
        let mut cache = self.lit.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipelines) = cache.get(&key) {
            return Ok(pipelines.clone());
        }
        let mut modules = key.bindings.add_modules(self.modules_for(key.variant));
        modules.push(key.materials.module());
        let shader = module(&self.builder.device, "forward.wgsl", &modules)?;
        let builder = self.builder.clone();
        let by_material = PipelineKey::all().map(|_| OnceLock::new()).collect();
        let layout = builder.layout(key.bindings);
        // Software adapters compile blending into the shader, so with one kind of blending they compile one shader.
        let blends_all = !key.writes_depth
            && builder.target.output == LitOutput::Light
            && builder.device.adapter_info().device_type == wgpu::DeviceType::Cpu;
        let pipelines =
            Arc::new(LitPipelines { builder, shader, layout, key, blends_all, pipelines: by_material });
        cache.insert(key, pipelines.clone());
        Ok(pipelines)
    }

    /// Returns the layout of group 1 of the lit pass: the shadows.
    pub fn shadow_layout(&self) -> &wgpu::BindGroupLayout {
        &self.builder.shadow_layout
    }

    /// Returns the layout of group 0 of the lit pass: the view and the lights.
    pub fn view_layout(&self) -> &wgpu::BindGroupLayout {
        self.builder.view_layouts.get(OptionalBindings::default())
    }

    /// Adds the pass that draws the scene, lit and shadowed, into a new texture, and returns it. Where nothing is drawn
    /// the texture contains `background`, in its own encoding, or the sky if `view` has one. `depth` is the depth of the prepass.
    ///
    /// # Errors
    /// [`Error::Shader`] if the technique's WGSL does not compose in the variant that the frame needs.
    pub fn lit<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: &Texture,
        geometry: &Geometry<'f>,
        background: [f64; 4],
    ) -> Result<Texture, Error> {
        self.add_lit(frame, view, shadows, Depth::Prepass(depth), geometry, background)
    }

    /// Adds the pass like [`lit`](Self::lit), but without a prepass: fragments that are later overdrawn are lit too. Returns
    /// the lit texture and the depth.
    ///
    /// # Errors
    /// The same as [`lit`](Self::lit).
    pub fn lit_without_prepass<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        geometry: &Geometry<'f>,
        background: [f64; 4],
    ) -> Result<(Texture, Texture), Error> {
        let [width, height] = geometry.size_px;
        let desc = TextureDesc::d2(width, height, DEPTH_FORMAT).samples(self.builder.target.samples);
        let mut depth = frame.create_texture("depth", desc);
        let lit = self.add_lit(frame, view, shadows, Depth::Written(&mut depth), geometry, background)?;
        Ok((lit, depth))
    }

    /// Adds the pass that draws blended geometry, lit and shadowed, over `light`; no pass if there is none.
    ///
    /// # Errors
    /// The same as [`lit`](Self::lit).
    pub fn blended<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: &Texture,
        geometry: &Geometry<'f>,
        light: &mut Texture,
    ) -> Result<(), Error> {
        if geometry.draws.blend.is_empty() || self.builder.target.output != LitOutput::Light {
            return Ok(());
        }
        let (variant, debug_light) = self.builder.target.variant(shadows);
        let bindings = view.optional_bindings();
        let materials = geometry.scene.material_features();
        let pipelines =
            self.pipelines_for(LitKey { variant, debug_light, writes_depth: false, bindings, materials })?;
        let buffers = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass("blended");
        buffers.read_in(&mut pass);
        let (shadows, view) = (shadows.read_in(&mut pass), view.read_in(&mut pass));
        pass.depth_read(depth);
        pass.color(light, Contents::Preserve);
        let (scene, draws) = (geometry.scene, geometry.draws);
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.builder.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.builder.shadow_layout)?;
            ctx.pass.set_bind_group(0, &view, &[]);
            ctx.pass.set_bind_group(1, &shadows, &[]);
            let draws = scene.draw(&mut ctx.pass, &draws.blend, &|draw| Some(pipelines.get(draw.key)));
            ctx.report_draws(draws);
            Ok(())
        });
        Ok(())
    }

    fn add_lit<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: Depth<'_>,
        geometry: &Geometry<'f>,
        background: [f64; 4],
    ) -> Result<Texture, Error> {
        let (variant, debug_light) = self.builder.target.variant(shadows);
        let writes_depth = matches!(depth, Depth::Written(_));
        let background_pipeline = self.background(variant, view.background_bindings())?;
        let bindings = view.optional_bindings();
        let materials = geometry.scene.material_features();
        let pipelines =
            self.pipelines_for(LitKey { variant, debug_light, writes_depth, bindings, materials })?;
        let [width, height] = geometry.size_px;
        let (texture, pass) = match self.builder.target.output {
            LitOutput::Surface => ("surfaces", "surfaces"),
            _ => ("lit", "forward"),
        };
        let LitTarget { format, samples, .. } = self.builder.target;
        let desc = TextureDesc::d2(width, height, format);
        let mut color = frame.create_texture(texture, desc);
        let multisampled = (samples > 1).then(|| frame.create_texture("lit samples", desc.samples(samples)));
        let buffers = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass(pass);
        buffers.read_in(&mut pass);
        let shadows = shadows.read_in(&mut pass);
        let view = view.read_in(&mut pass);
        let (solid, scene, draws) = (geometry.solid_in(&mut pass), geometry.scene, geometry.draws);
        match depth {
            Depth::Prepass(depth) => pass.depth_read(depth),
            Depth::Written(depth) => pass.depth(depth, Contents::clear_depth(0.0)),
        };
        match multisampled {
            Some(mut multisampled) => {
                pass.color(&mut multisampled, Contents::clear_color(background));
                pass.resolve(&mut color);
            }
            None => {
                pass.color(&mut color, Contents::clear_color(background));
            }
        }
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.builder.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.builder.shadow_layout)?;
            ctx.pass.set_bind_group(0, &view, &[]);
            ctx.pass.set_bind_group(1, &shadows, &[]);
            let pipeline_for = |draw: &Draw| Some(pipelines.get(draw.key));
            solid.record(ctx, &pipeline_for)?;
            if let Some(pipeline) = &background_pipeline {
                ctx.pass.set_pipeline(pipeline);
                ctx.pass.draw(0..3, 0..1);
                ctx.report_draws(1);
            }
            if self.builder.target.output == LitOutput::Light {
                let draws = scene.draw(&mut ctx.pass, &draws.blend, &pipeline_for);
                ctx.report_draws(draws);
            }
            Ok(())
        });
        Ok(color)
    }
}

/// The source of the depth of a lit pass.
enum Depth<'d> {
    /// A prepass has written it.
    Prepass(&'d Texture),
    /// The pass writes it.
    Written(&'d mut Texture),
}

impl PipelineBuilder {
    fn layout(&self, bindings: OptionalBindings) -> wgpu::PipelineLayout {
        let [material, draw] = &self.material_layouts;
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("forward"),
            bind_group_layouts: &[
                Some(self.view_layouts.get(bindings)),
                Some(&self.shadow_layout),
                Some(material),
                Some(draw),
            ],
            immediate_size: 0,
        })
    }

    fn pipeline(
        &self,
        shader: &wgpu::ShaderModule,
        layout: &wgpu::PipelineLayout,
        lit: LitKey,
        key: PipelineKey,
    ) -> wgpu::RenderPipeline {
        let constants = self.target.constants(lit.debug_light);
        // Blended geometry is drawn only for the output of light.
        let blended = key.alpha == AlphaKey::Blend && self.target.output == LitOutput::Light;
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("forward"),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module: shader,
                entry_point: Some("vs_forward"),
                compilation_options: Default::default(),
                buffers: &[Some(vertex_layout())],
            },
            primitive: key.primitive_state(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                // Blended geometry does not write depth.
                depth_write_enabled: Some(lit.writes_depth && key.alpha != AlphaKey::Blend),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.target.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: shader,
                entry_point: Some("fs_forward"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                targets: &[Some(wgpu::ColorTargetState {
                    format: self.target.format,
                    blend: blended.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
