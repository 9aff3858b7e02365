//! The pass that evaluates a technique for all visible surfaces.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use shadowgraph_core::{Bind, Contents, Frame, Texture};
use shadowgraph_shaders::compose;

use crate::error::Error;
use crate::technique::binding::{FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{ShadowOutputs, ShadowTechnique, SurfaceBuffers, layout, shadow_layout};
use crate::techniques::compute::{dispatch, pipeline, shader};
use crate::techniques::mask::TARGET;
use crate::techniques::mask::pass::{Layers, mask_texture, workgroups};

/// The pass that writes a screen mask.
pub(super) struct EvaluatePass {
    device: wgpu::Device,
    view_layout: wgpu::BindGroupLayout,
    shadow_layout: wgpu::BindGroupLayout,
    layout: wgpu::BindGroupLayout,
    /// Pipelines by the technique's variants, created on first use.
    pipelines: Mutex<BTreeMap<u32, Arc<wgpu::ComputePipeline>>>,
}

impl EvaluatePass {
    pub(super) fn new(device: &wgpu::Device, technique: &dyn ShadowTechnique) -> Result<Self, Error> {
        let pass = Self {
            device: device.clone(),
            view_layout: layout(device, "view", &[UNIFORM, STORAGE]),
            shadow_layout: shadow_layout(device, technique),
            layout: layout(device, "evaluate", &[FLOAT_MAP, TARGET, UNIFORM]),
            pipelines: Mutex::default(),
        };
        // Reports composition errors now, not in some frame.
        pass.pipeline(technique, 0)?;
        Ok(pass)
    }

    /// Returns the pipeline that evaluates a variant of the technique.
    fn pipeline(
        &self,
        technique: &dyn ShadowTechnique,
        variant: u32,
    ) -> Result<Arc<wgpu::ComputePipeline>, Error> {
        let mut known = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = known.get(&variant) {
            return Ok(pipeline.clone());
        }
        let module = compose("evaluate.wgsl", &technique.modules(variant))?;
        let layouts = [&self.view_layout, &self.shadow_layout, &self.layout];
        let shader = shader(&self.device, "evaluate.wgsl", module);
        let pipeline = Arc::new(pipeline(&self.device, &shader, "cs_evaluate", &layouts));
        known.insert(variant, pipeline.clone());
        Ok(pipeline)
    }

    /// Adds the pass that evaluates the technique for all visible surfaces.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        technique: &'f dyn ShadowTechnique,
        buffers: &SurfaceBuffers,
        shadows: &ShadowOutputs<'f>,
        layers: Layers,
    ) -> Result<Texture, Error> {
        let pipeline = self.pipeline(technique, shadows.variant)?;
        let mut mask = mask_texture(frame, "shadow mask", buffers, layers);
        let mut pass = frame.compute_pass("evaluate");
        let shadows = shadows.read_in(&mut pass);
        let (view, lights) = (pass.uniform_buffer(&buffers.view), pass.storage_buffer(&buffers.lights));
        let surfaces = pass.sample(&buffers.surfaces);
        let target = pass.storage_texture_mut(&mut mask, Contents::Overwrite);
        let size_px = buffers.size_px;
        pass.body(move |ctx| {
            let bindings = [Bind::Texture(surfaces), Bind::TextureArray(target), Bind::Uniform(layers.block)];
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                shadows.bind_group(ctx, &self.shadow_layout)?,
                ctx.bind_group(&self.layout, &bindings)?,
            ];
            dispatch(&mut ctx.pass, &pipeline, &groups, workgroups(size_px, layers));
            Ok(())
        });
        Ok(mask)
    }
}
