//! The pass that deforms meshes by skins and morph targets.

use std::sync::OnceLock;

use shadowgraph_core::{Bind, Contents, Frame};
use shadowgraph_scene::gpu::GpuScene;
use shadowgraph_shadows::VertexBuffers;

use crate::error::Error;
use crate::shader::module;

/// The pass that computes the vertices of a scene's deformed meshes, once a frame: linear blend skinning after morph targets, as
/// in glTF 2.0. Meshes that did not change since the pass was last recorded are left out.
pub struct PosePass {
    device: wgpu::Device,
    shader: wgpu::ShaderModule,
    /// Created on first use.
    pipeline: OnceLock<wgpu::ComputePipeline>,
}

impl PosePass {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let shader = module(device, "pose.wgsl", &[])?;
        Ok(Self { device: device.clone(), shader, pipeline: OnceLock::new() })
    }

    /// Adds the pass and publishes [`VertexBuffers`], which passes that draw the scene then read; no pass if no mesh has changed, or
    /// if the frame has the pass already.
    pub fn add_to<'f>(&self, frame: &mut Frame<'f>, scene: &'f GpuScene) {
        let Some(inputs) = scene.pose_inputs().filter(|_| frame.published::<VertexBuffers>().is_err()) else {
            return;
        };
        let pipeline = self.pipeline.get_or_init(|| self.create_pipeline()).clone();
        let posed = frame.node("pose", |frame| {
            let uploads = [
                ("deformed meshes", inputs.jobs),
                ("pose workgroups", inputs.workgroups),
                ("joints", inputs.joints),
                ("morph weights", inputs.weights),
            ]
            .map(|(name, bytes)| frame.upload_buffer(name, bytes));
            let mut posed = frame.import_buffer("posed vertices", inputs.vertices, true);
            let mut pass = frame.compute_pass("pose");
            let [jobs, workgroups, joints, weights] =
                uploads.each_ref().map(|upload| Bind::Buffer(pass.storage_buffer(upload)));
            let vertices = Bind::Buffer(pass.storage_buffer_mut(&mut posed, Contents::Preserve));
            let [rest, influences, deltas] =
                [inputs.rest, inputs.influences, inputs.deltas].map(Bind::ExternalBuffer);
            let bindings = [jobs, workgroups, joints, weights, rest, influences, deltas, vertices];
            // A body, since a pass of one shader cannot note that it is recorded.
            pass.body(move |ctx| {
                let group = ctx.bind_group(&pipeline.get_bind_group_layout(0), &bindings)?;
                ctx.pass.set_pipeline(&pipeline);
                ctx.pass.set_bind_group(0, &group, &[]);
                let [x, y, z] = inputs.dispatch;
                ctx.pass.dispatch_workgroups(x, y, z);
                inputs.done.note();
                Ok(())
            });
            posed
        });
        frame.publish(VertexBuffers(vec![posed]));
    }

    fn create_pipeline(&self) -> wgpu::ComputePipeline {
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("pose"),
            layout: None,
            module: &self.shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    }
}
