//! Forward lighting: one pass for all lights and materials.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use shadowgraph_core::{Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_scene::gpu::{AlphaKey, Draw, DrawPipeline, MaterialKey, MaterialLayouts, vertex_layout};
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique, shadow_layout};

use shadowgraph_shaders::ModuleSource;

use crate::prepass::{DEPTH_FORMAT, Geometry};
use crate::shader::module;
use crate::view_group::{Extras, ViewLayouts};
use crate::{Error, ViewBuffers};

/// What the lit pass writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LitOutput {
    /// Light, scene-linear, exposure applied.
    #[default]
    Light,
    /// The visibility of this light as grey, with alpha 0 where nothing is drawn or the surface faces away. What is
    /// blended is left out, here and in the following.
    Visibility(u32),
    /// The technique's debug colours for the light that it names ([`ShadowOutputs::debug_light`]).
    Debug,
    /// The shading normal, each axis from -1..1 to 0..1.
    Normal,
    /// Positions relative to the frame's origin, metres, and in `w` the geometric normal: 1 + 4096 x + y of the unfolded
    /// octahedron, each axis 0 to 4095. 0 where nothing is drawn. Wants `Rgba32Float`.
    Surface,
}

/// Pipelines and nodes of forward lighting with one shadow technique.
pub struct Forward {
    recipe: Arc<Recipe>,
    /// The technique's modules in each of its variants.
    modules: Vec<Vec<ModuleSource>>,
    /// Those that frames have asked for.
    lit: Mutex<BTreeMap<LitKey, Arc<LitPipelines>>>,
}

/// What the pipelines of one lit pass differ in from those of another.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct LitKey {
    /// Of the technique's modules.
    variant: u32,
    /// Whose debug colours are shown; 0 where none are.
    debug_light: u32,
    /// There is no prepass.
    writes_depth: bool,
    extras: Extras,
}

/// The pipelines that light with one variant of a technique: each is made when it is first asked for.
pub struct LitPipelines {
    recipe: Arc<Recipe>,
    shader: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    key: LitKey,
    /// By [`MaterialKey::index`].
    made: Vec<OnceLock<wgpu::RenderPipeline>>,
}

impl LitPipelines {
    /// Returns what draws of a key are drawn with.
    pub fn get(&self, key: MaterialKey) -> DrawPipeline<'_> {
        let make = || self.recipe.pipeline(&self.shader, &self.layout, self.key, key);
        DrawPipeline { pipeline: self.made[key.index()].get_or_init(make), reads_material: true }
    }
}

/// What all pipelines of a pass share.
struct Recipe {
    device: wgpu::Device,
    view_layouts: ViewLayouts,
    shadow_layout: wgpu::BindGroupLayout,
    /// The materials' and the draws'.
    material_layouts: [wgpu::BindGroupLayout; 2],
    target: LitTarget,
}

/// What a lit pass draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LitTarget {
    /// The format of what it writes.
    pub format: Format,
    /// What it writes.
    pub output: LitOutput,
    /// How many samples each pixel has while it is drawn, 1 or 4; in the end it has one. Shadows are asked for once a pixel
    /// and surface, and a screen mask has one answer for all surfaces of a pixel.
    pub samples: u32,
}

impl Forward {
    /// Makes the pipelines that light `layouts`' materials with the shadows of `technique` into `target`.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose; the message has its file and line.
    pub fn new(
        device: &wgpu::Device,
        layouts: &MaterialLayouts,
        technique: &dyn ShadowTechnique,
        target: LitTarget,
    ) -> Result<Self, Error> {
        let forward = Self {
            recipe: Arc::new(Recipe {
                device: device.clone(),
                view_layouts: ViewLayouts::new(device),
                shadow_layout: shadow_layout(device, technique),
                material_layouts: [layouts.material.clone(), layouts.draw.clone()],
                target,
            }),
            modules: (0..technique.variant_count()).map(|variant| technique.modules(variant)).collect(),
            lit: Mutex::default(),
        };
        // What does not compose is told now, not in some frame.
        shadowgraph_shaders::compose("forward.wgsl", forward.modules_of(0))?;
        Ok(forward)
    }

    fn modules_of(&self, variant: u32) -> &[ModuleSource] {
        self.modules.get(variant as usize).or(self.modules.first()).map_or(&[], Vec::as_slice)
    }

    /// Returns the pipelines that light with a variant of the technique ([`ShadowOutputs::variant`]), and composes them if it
    /// is the first time. With `writes_depth` they draw depth themselves, for passes without a prepass.
    ///
    /// # Errors
    /// If the variant's WGSL does not compose.
    pub fn pipelines(&self, variant: u32, writes_depth: bool) -> Result<Arc<LitPipelines>, Error> {
        self.pipelines_of(LitKey { variant, debug_light: 0, writes_depth, extras: Extras::default() })
    }

    fn pipelines_of(&self, key: LitKey) -> Result<Arc<LitPipelines>, Error> {
        let mut known = self.lit.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipelines) = known.get(&key) {
            return Ok(pipelines.clone());
        }
        let modules = key.extras.with(self.modules_of(key.variant));
        let shader = module(&self.recipe.device, "forward.wgsl", &modules)?;
        let recipe = self.recipe.clone();
        let made = MaterialKey::all().map(|_| OnceLock::new()).collect();
        let layout = recipe.layout(key.extras);
        let pipelines = Arc::new(LitPipelines { recipe, shader, layout, key, made });
        known.insert(key, pipelines.clone());
        Ok(pipelines)
    }

    /// Returns the layout of group 1 of the lit pass: the technique's.
    pub fn shadow_layout(&self) -> &wgpu::BindGroupLayout {
        &self.recipe.shadow_layout
    }

    /// Returns the layout of group 0 of the lit pass: the buffers of the view and of the lights.
    pub fn view_layout(&self) -> &wgpu::BindGroupLayout {
        self.recipe.view_layouts.of(Extras::default())
    }

    /// Adds the pass that draws the scene, lit and shadowed, into a new texture, and returns it. Where
    /// nothing is drawn it holds `background`, in the texture's own terms. `depth` is the prepass's.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose in the variant that the frame asks for.
    pub fn lit<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: &Texture,
        geometry: Geometry<'f>,
        background: [f64; 4],
    ) -> Result<Texture, Error> {
        self.add_lit(frame, view, shadows, Depth::Prepass(depth), geometry, background)
    }

    /// Adds the pass like [`lit`](Self::lit) where there is no prepass: all that is drawn is lit, what is covered later too.
    /// Returns the depth besides.
    ///
    /// # Errors
    /// As `lit`.
    pub fn lit_without_prepass<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        geometry: Geometry<'f>,
        background: [f64; 4],
    ) -> Result<(Texture, Texture), Error> {
        let [width, height] = geometry.size_px;
        let desc = TextureDesc::d2(width, height, DEPTH_FORMAT).samples(self.recipe.target.samples);
        let mut depth = frame.create_texture("depth", desc);
        let lit = self.add_lit(frame, view, shadows, Depth::Own(&mut depth), geometry, background)?;
        Ok((lit, depth))
    }

    /// Adds the pass that draws what is blended, lit and shadowed, over `light`; none where nothing is.
    ///
    /// # Errors
    /// As [`lit`](Self::lit).
    pub fn blended<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: &Texture,
        geometry: Geometry<'f>,
        light: &mut Texture,
    ) -> Result<(), Error> {
        if geometry.draws.blend.is_empty() || self.recipe.target.output != LitOutput::Light {
            return Ok(());
        }
        let (variant, debug_light) = self.recipe.target.variant(shadows);
        let extras = view.extras();
        let pipelines = self.pipelines_of(LitKey { variant, debug_light, writes_depth: false, extras })?;
        let mut pass = frame.render_pass("blended");
        let (shadows, view) = (shadows.read_in(&mut pass), view.read_in(&mut pass));
        pass.depth_read(depth);
        pass.color(light, Contents::Preserve);
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.recipe.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.recipe.shadow_layout)?;
            ctx.pass.set_bind_group(0, &view, &[]);
            ctx.pass.set_bind_group(1, &shadows, &[]);
            let draws = &geometry.draws.blend;
            let draws = geometry.scene.draw(&mut ctx.pass, draws, &|draw| Some(pipelines.get(draw.key)));
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
        geometry: Geometry<'f>,
        background: [f64; 4],
    ) -> Result<Texture, Error> {
        // Debug colours are not in every variant.
        let (variant, debug_light) = self.recipe.target.variant(shadows);
        let writes_depth = matches!(depth, Depth::Own(_));
        let extras = view.extras();
        let pipelines = self.pipelines_of(LitKey { variant, debug_light, writes_depth, extras })?;
        let [width, height] = geometry.size_px;
        let (texture, pass) = match self.recipe.target.output {
            LitOutput::Surface => ("surfaces", "surfaces"),
            _ => ("lit", "forward"),
        };
        let LitTarget { format, samples, .. } = self.recipe.target;
        let desc = TextureDesc::d2(width, height, format);
        let mut color = frame.create_texture(texture, desc);
        let many = (samples > 1).then(|| frame.create_texture("lit samples", desc.samples(samples)));
        let mut pass = frame.render_pass(pass);
        let shadows = shadows.read_in(&mut pass);
        let view = view.read_in(&mut pass);
        match depth {
            Depth::Prepass(depth) => pass.depth_read(depth),
            Depth::Own(depth) => pass.depth(depth, Contents::clear_depth(0.0)),
        };
        match many {
            Some(mut many) => {
                pass.color(&mut many, Contents::clear_color(background));
                pass.resolve(&mut color);
            }
            None => {
                pass.color(&mut color, Contents::clear_color(background));
            }
        }
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.recipe.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.recipe.shadow_layout)?;
            ctx.pass.set_bind_group(0, &view, &[]);
            ctx.pass.set_bind_group(1, &shadows, &[]);
            let blend: &[Draw] =
                if self.recipe.target.output == LitOutput::Light { &geometry.draws.blend } else { &[] };
            for draws in [&geometry.draws.solid, blend] {
                let draws = geometry.scene.draw(&mut ctx.pass, draws, &|draw| Some(pipelines.get(draw.key)));
                ctx.report_draws(draws);
            }
            Ok(())
        });
        Ok(color)
    }
}

impl LitTarget {
    /// Which variant of the technique a pass asks for, and whose debug colours it shows. Those are not in every variant.
    pub(crate) fn variant(&self, shadows: &ShadowOutputs<'_>) -> (u32, u32) {
        match self.output {
            LitOutput::Debug => (0, shadows.debug_light),
            _ => (shadows.variant, 0),
        }
    }

    /// The numbers of `AOV` and `AOV_LIGHT` in the shaders.
    pub(crate) fn constants(&self, debug_light: u32) -> [(&'static str, f64); 2] {
        let (aov, light) = match self.output {
            LitOutput::Light => (0, 0),
            LitOutput::Visibility(light) => (1, light),
            LitOutput::Debug => (2, debug_light),
            LitOutput::Normal => (3, 0),
            LitOutput::Surface => (4, 0),
        };
        [("AOV", f64::from(aov)), ("AOV_LIGHT", f64::from(light))]
    }
}

/// Where the depth of a lit pass comes from.
enum Depth<'d> {
    /// A prepass has drawn it.
    Prepass(&'d Texture),
    /// The pass draws it.
    Own(&'d mut Texture),
}

impl Recipe {
    fn layout(&self, extras: Extras) -> wgpu::PipelineLayout {
        let [material, draw] = &self.material_layouts;
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("forward"),
            bind_group_layouts: &[
                Some(self.view_layouts.of(extras)),
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
        key: MaterialKey,
    ) -> wgpu::RenderPipeline {
        let constants = self.target.constants(lit.debug_light);
        // Only light is drawn for what is blended.
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
                // What is blended covers nothing.
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
