//! `screen`: shadows of another technique, collected in a screen mask before anything is lit.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use shadowgraph_core::{Bind, Contents, Frame, Texture, TextureDesc, Uniform};
use shadowgraph_shaders::{MASK_ONLY, ModuleSource, SCREEN, compose};

use super::layout::{STORAGE, UNIFORM, layout};
use super::mask::{MASK, MASK_FORMAT, SURFACES, TARGET, WORKGROUP_PX, masked_lights, no_mask};
use crate::technique::{Screen, ShadowBinding, ShadowOutputs, ShadowTechnique};
use crate::{Error, Needs, ScreenSettings, ShadowInputs};

/// Asks another technique once for each pixel and light, in a compute pass, and blurs what it says. Whoever lights reads one
/// texel: its shaders know nothing of the other technique, unless something is blended or there are more lights than layers.
///
/// After Engel, "Cascaded Shadow Maps" (ShaderX5, 2006), *shadow prepass*, and Pranckevičius, "Deferred Cascaded Shadow
/// Maps" (2009).
pub struct ScreenShadows {
    inner: Box<dyn ShadowTechnique>,
    device: wgpu::Device,
    layout: wgpu::BindGroupLayout,
    types: Vec<wgpu::BindingType>,
    view_layout: wgpu::BindGroupLayout,
    collect_layout: wgpu::BindGroupLayout,
    /// For each of the inner technique's variants that frames have asked for.
    collect: Mutex<BTreeMap<u32, Arc<wgpu::ComputePipeline>>>,
    blur_layout: wgpu::BindGroupLayout,
    blur: wgpu::ComputePipeline,
    no_mask: wgpu::Texture,
}

impl ScreenShadows {
    /// Collects the shadows of `inner`.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device, inner: Box<dyn ShadowTechnique>) -> Result<Self, Error> {
        let mut types = inner.binding_types();
        types.extend([MASK, UNIFORM]);
        let view_layout = layout(device, "view", &[STORAGE; 2]);
        let blur_layout = layout(device, "blur", &[SURFACES, MASK, TARGET, UNIFORM]);
        let module = compose("blur.wgsl", &[])?;
        let screen = Self {
            layout: layout(device, "screen shadows", &types),
            types,
            collect_layout: layout(device, "collect", &[SURFACES, TARGET, UNIFORM]),
            collect: Mutex::default(),
            blur: pipeline(device, module, "cs_blur", &[&view_layout, &blur_layout]),
            view_layout,
            blur_layout,
            no_mask: no_mask(device),
            inner,
            device: device.clone(),
        };
        // What does not compose is told now, not in some frame.
        screen.collector(0)?;
        Ok(screen)
    }

    /// The pipeline that asks the inner technique in one of its variants.
    fn collector(&self, variant: u32) -> Result<Arc<wgpu::ComputePipeline>, Error> {
        let mut known = self.collect.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = known.get(&variant) {
            return Ok(pipeline.clone());
        }
        let module = compose("collect.wgsl", &self.inner.modules(variant))?;
        let layouts = [&self.view_layout, self.inner.bind_group_layout(), &self.collect_layout];
        let pipeline = Arc::new(pipeline(&self.device, module, "cs_collect", &layouts));
        known.insert(variant, pipeline.clone());
        Ok(pipeline)
    }

    /// Adds the pass that asks for everything that the picture shows.
    fn collect<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        screen: &Screen,
        shadows: &ShadowOutputs<'f>,
        layers: Uniform,
        count: u32,
    ) -> Result<Texture, Error> {
        let pipeline = self.collector(shadows.variant)?;
        let [width, height] = screen.size_px;
        let desc = TextureDesc::d2(width, height, MASK_FORMAT).layers(count);
        let mut mask = frame.create_texture("shadow mask", desc);
        let mut pass = frame.compute_pass("collect");
        let shadows = shadows.read_in(&mut pass);
        let (view, lights) = (pass.storage_buffer(&screen.view), pass.storage_buffer(&screen.lights));
        let surfaces = pass.sample(&screen.surfaces);
        let target = pass.storage_texture_mut(&mut mask, Contents::Cover);
        pass.body(move |ctx| {
            let own = [Bind::Texture(surfaces), Bind::TextureArray(target), Bind::Uniform(layers)];
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                shadows.bind_group(ctx, self.inner.bind_group_layout())?,
                ctx.bind_group(&self.collect_layout, &own)?,
            ];
            dispatch(&mut ctx.pass, &pipeline, &groups, [width, height, count]);
            Ok(())
        });
        Ok(mask)
    }

    /// Adds the pass that blurs a mask.
    fn blur<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        screen: &Screen,
        mask: &Texture,
        layers: Uniform,
        count: u32,
    ) -> Texture {
        let [width, height] = screen.size_px;
        let desc = TextureDesc::d2(width, height, MASK_FORMAT).layers(count);
        let mut blurred = frame.create_texture("blurred shadow mask", desc);
        let mut pass = frame.compute_pass("blur");
        let (view, lights) = (pass.storage_buffer(&screen.view), pass.storage_buffer(&screen.lights));
        let (surfaces, mask) = (pass.sample(&screen.surfaces), pass.sample(mask));
        let target = pass.storage_texture_mut(&mut blurred, Contents::Cover);
        pass.body(move |ctx| {
            let own = [
                Bind::Texture(surfaces),
                Bind::TextureArray(mask),
                Bind::TextureArray(target),
                Bind::Uniform(layers),
            ];
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                ctx.bind_group(&self.blur_layout, &own)?,
            ];
            dispatch(&mut ctx.pass, &self.blur, &groups, [width, height, count]);
            Ok(())
        });
        blurred
    }

    /// The variant without any of the inner technique.
    fn mask_only(&self) -> u32 {
        self.inner.variant_count()
    }
}

impl ShadowTechnique for ScreenShadows {
    fn name(&self) -> &str {
        "screen"
    }

    fn needs(&self, inputs: &ShadowInputs<'_>) -> Needs {
        self.inner.needs(inputs)
    }

    fn reads_surfaces(&self) -> bool {
        true
    }

    fn variant_count(&self) -> u32 {
        self.mask_only() + 1
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        let first = self.types.len() - 2;
        let numbered = |module: ModuleSource| {
            let source = module.source.replace("@binding(MASK)", &format!("@binding({first})"));
            let source = source.replace("@binding(LAYERS)", &format!("@binding({})", first + 1));
            ModuleSource::new(module.file, source)
        };
        if variant >= self.mask_only() {
            return vec![numbered(MASK_ONLY)];
        }
        let mut modules = self.inner.modules(variant);
        if let Some(module) = modules.first_mut() {
            let path = "#define_import_path shadowgraph::";
            let source = module.source.replace(&format!("{path}technique"), &format!("{path}collected"));
            *module = ModuleSource::new(module.file.clone(), source);
        }
        modules.insert(0, numbered(SCREEN));
        modules
    }

    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        self.types.clone()
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        screen: Option<&Screen>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let screen = screen.ok_or(Error::NoSurfaces { technique: "screen" })?;
        let mut outputs = self.inner.add_to(frame, inputs, Some(screen))?;
        let casting = inputs.lights.iter().filter(|light| light.casts_shadow).count();
        let lights = masked_lights(inputs.lights);
        let settings = &inputs.settings.screen;
        let layers = frame.uniform(&record(&lights, settings));
        let count = lights.len() as u32;
        let mask = frame.node("collected shadows", |frame| {
            if count == 0 {
                return Ok(frame.import_texture("no shadow mask", &self.no_mask, true));
            }
            let mask = self.collect(frame, screen, &outputs, layers, count)?;
            let blurs = settings.blur_m > 0.0;
            Ok::<_, Error>(if blurs { self.blur(frame, screen, &mask, layers, count) } else { mask })
        })?;
        outputs.bindings.extend([ShadowBinding::TextureArray(mask.clone()), ShadowBinding::Uniform(layers)]);
        outputs.debug.push(("shadow mask", mask));
        if casting == lights.len() && !screen.has_blended {
            outputs.variant = self.mask_only();
        }
        Ok(outputs)
    }
}

/// A `MaskLayers` of `layers.wgsl`.
fn record(lights: &[u32], settings: &ScreenSettings) -> Vec<u8> {
    let mut of_layers = [u32::MAX; super::MAX_MASK_LAYERS];
    of_layers[..lights.len()].copy_from_slice(lights);
    let head = [settings.blur_m, settings.blur_max_px, settings.depth_threshold];
    [&(lights.len() as u32).to_le_bytes(), bytemuck::cast_slice(&head), bytemuck::cast_slice(&of_layers)]
        .concat()
}

fn pipeline(
    device: &wgpu::Device,
    module: shadowgraph_shaders::naga::Module,
    entry: &str,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::ComputePipeline {
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(entry),
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    });
    let layouts: Vec<_> = layouts.iter().copied().map(Some).collect();
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&pipeline_layout),
        module: &shader,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

fn dispatch(
    pass: &mut wgpu::ComputePass<'_>,
    pipeline: &wgpu::ComputePipeline,
    groups: &[wgpu::BindGroup],
    [width, height, layers]: [u32; 3],
) {
    pass.set_pipeline(pipeline);
    for (index, group) in (0..).zip(groups) {
        pass.set_bind_group(index, group, &[]);
    }
    pass.dispatch_workgroups(width.div_ceil(WORKGROUP_PX), height.div_ceil(WORKGROUP_PX), layers);
}
