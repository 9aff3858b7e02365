//! The pass that deforms meshes by skins and morph targets.

use shadowgraph_core::{ComputeShader, Contents, Frame};
use shadowgraph_scene::gpu::GpuScene;
use shadowgraph_shadows::VertexBuffers;

use crate::error::Error;
use crate::shader::module;

/// The pass that computes the vertices of all deformed meshes of a scene, once a frame: linear blend skinning after morph targets, as
/// in glTF 2.0.
pub struct PosePass {
    shader: ComputeShader,
}

impl PosePass {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let file = "pose.wgsl";
        Ok(Self { shader: ComputeShader::module(file, &module(device, file, &[])?) })
    }

    /// Adds the pass and publishes [`VertexBuffers`], which passes that draw the scene then read; no pass if no mesh is deformed, or
    /// if the frame has the pass already.
    pub fn add_to<'f>(&self, frame: &mut Frame<'f>, scene: &'f GpuScene) {
        let Some(inputs) = scene.pose_inputs().filter(|_| frame.published::<VertexBuffers>().is_err()) else {
            return;
        };
        let posed = frame.node("pose", |frame| {
            let jobs = frame.upload_buffer("deformed meshes", inputs.jobs);
            let workgroups = frame.upload_buffer("pose workgroups", inputs.workgroups);
            let joints = frame.upload_buffer("joints", inputs.joints);
            let weights = frame.upload_buffer("morph weights", inputs.weights);
            let mut posed = frame.import_buffer("posed vertices", inputs.vertices, true);
            frame
                .compute("pose", &self.shader)
                .storage(&jobs)
                .storage(&workgroups)
                .storage(&joints)
                .storage(&weights)
                .external_buffer(inputs.rest)
                .external_buffer(inputs.influences)
                .external_buffer(inputs.deltas)
                .storage_mut(&mut posed, Contents::Preserve)
                .dispatch(inputs.dispatch);
            posed
        });
        frame.publish(VertexBuffers(vec![posed]));
    }
}
