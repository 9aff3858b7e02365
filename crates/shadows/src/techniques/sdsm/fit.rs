//! The passes that fit cascades.

use shadowgraph_core::{Bind, Buffer, Contents, Frame, Uniform};
use shadowgraph_shaders::compose;

use super::SdsmSettings;
use crate::error::Error;
use crate::gpu_struct;
use crate::plan::{ShadowInputs, ShadowPlan};
use crate::technique::binding::{FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{GpuData, SurfaceBuffers, layout};
use crate::techniques::compute::{WRITTEN, dispatch, pipeline, shader};

/// The side of a workgroup of the passes over the image, pixels.
const WORKGROUP_PX: u32 = 8;

/// Number of views that a workgroup of the last pass writes.
const WORKGROUP_VIEWS: u32 = 64;

gpu_struct! {
    /// `Fit` of `sdsm.wgsl`.
    struct Fit {
        settings: SdsmSettings,
        views: u32,
        cascades: u32,
        lights: u32,
        map_width_px: f32,
        map_height_px: f32,
        nearest: f32,
        farthest: f32,
    }
}

/// The passes and their bindings.
pub(super) struct GpuFit {
    view_layout: wgpu::BindGroupLayout,
    layout: wgpu::BindGroupLayout,
    views_layout: wgpu::BindGroupLayout,
    depths: wgpu::ComputePipeline,
    bounds: wgpu::ComputePipeline,
    fit: wgpu::ComputePipeline,
}

impl GpuFit {
    pub(super) fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let view_layout = layout(device, "view", &[UNIFORM, STORAGE]);
        let types = [FLOAT_MAP, STORAGE, STORAGE, UNIFORM, WRITTEN, WRITTEN];
        let own_layout = layout(device, "fit cascades", &types);
        let views_layout = layout(device, "fitted views", &[WRITTEN]);
        let layouts = [&view_layout, &own_layout, &views_layout];
        let shader = shader(device, "sdsm.wgsl", compose("sdsm.wgsl", &[])?);
        let make = |entry, groups| pipeline(device, &shader, entry, &layouts[..groups]);
        Ok(Self {
            depths: make("cs_depths", 2),
            bounds: make("cs_bounds", 2),
            fit: make("cs_fit", 3),
            layout: own_layout,
            view_layout,
            views_layout,
        })
    }

    /// Adds the passes, and returns the buffer of fitted views, or that of the plan if there is nothing to fit.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'_>,
        (buffers, own): (&SurfaceBuffers, &SdsmSettings),
        plan: &ShadowPlan,
        [views, lights]: [&Buffer; 2],
    ) -> Buffer {
        let count = inputs.settings.cascades.count;
        let map = plan.cascades.as_ref().filter(|_| count > 1);
        let Some((map, views_desc)) = map.zip(frame.buffer_desc(views)) else { return views.clone() };
        let [map_width_px, map_height_px] = map.size_px.map(|side| side as f32);
        let fit = Fit {
            settings: own.clone(),
            views: plan.views.len() as u32,
            cascades: count,
            lights: map.tiles.len() as u32 / count,
            map_width_px,
            map_height_px,
            nearest: (inputs.camera.near() as f32).max(inputs.settings.cascades.begin_m),
            farthest: plan.lights.iter().map(|light| light.fade_end_m).fold(0.0, f32::max),
        };
        // Minimum and maximum, initialized for atomic min and max.
        let no_depths = vec![[u32::MAX, 0]];
        let no_bounds = vec![[u32::MAX, u32::MAX, u32::MAX, 0, 0, 0]; map.tiles.len()];
        frame.node("fit cascades", |frame| {
            let depths = frame.upload_buffer("view depths", bytemuck::cast_slice(&no_depths).to_vec());
            let bounds = frame.upload_buffer("cascade bounds", bytemuck::cast_slice(&no_bounds).to_vec());
            let block = frame.uniform(&fit.bytes());
            let mut steps = Steps { buffers, views, lights, block, depths, bounds };
            let [width, height] = buffers.size_px.map(|side| side.div_ceil(WORKGROUP_PX));
            self.step(frame, &mut steps, ("depths", &self.depths), [width, height], None);
            self.step(frame, &mut steps, ("bounds", &self.bounds), [width, height], None);
            let mut fitted = frame.create_buffer("fitted shadow views", views_desc);
            let groups = [fit.views.div_ceil(WORKGROUP_VIEWS), 1];
            self.step(frame, &mut steps, ("fit", &self.fit), groups, Some(&mut fitted));
            fitted
        })
    }

    fn step<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        steps: &mut Steps<'_>,
        (name, pipeline): (&'static str, &'f wgpu::ComputePipeline),
        [x, y]: [u32; 2],
        fitted: Option<&mut Buffer>,
    ) {
        let mut pass = frame.compute_pass(name);
        let (view, lights) =
            (pass.uniform_buffer(&steps.buffers.view), pass.storage_buffer(&steps.buffers.lights));
        let surfaces = pass.sample(&steps.buffers.surfaces);
        let planned = [steps.views, steps.lights].map(|buffer| pass.storage_buffer(buffer));
        let found = [&mut steps.depths, &mut steps.bounds]
            .map(|buffer| pass.storage_buffer_mut(buffer, Contents::Preserve));
        let fitted = fitted.map(|fitted| pass.storage_buffer_mut(fitted, Contents::Overwrite));
        let block = steps.block;
        pass.body(move |ctx| {
            let mut own = vec![Bind::Texture(surfaces)];
            own.extend(planned.map(Bind::Buffer));
            own.push(Bind::Uniform(block));
            own.extend(found.map(Bind::Buffer));
            let mut groups = vec![
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                ctx.bind_group(&self.layout, &own)?,
            ];
            if let Some(fitted) = fitted {
                groups.push(ctx.bind_group(&self.views_layout, &[Bind::Buffer(fitted)])?);
            }
            dispatch(&mut ctx.pass, pipeline, &groups, [x, y, 1]);
            Ok(())
        });
    }
}

/// The resources that all steps of a frame share.
struct Steps<'s> {
    buffers: &'s SurfaceBuffers,
    views: &'s Buffer,
    lights: &'s Buffer,
    block: Uniform,
    depths: Buffer,
    bounds: Buffer,
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::technique::GpuStruct;

    #[test]
    fn the_uniform_block_has_the_same_layout_in_wgsl_and_rust() {
        let module = compose("sdsm.wgsl", &[]).unwrap();
        GpuStruct::new::<Fit>("Fit").check(&module).unwrap();
    }
}
