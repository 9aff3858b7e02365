//! Which lights reach which part of the view.

use shadowgraph_core::{ComputeShader, Contents, Format, Frame, TextureDesc};

use crate::shader::module;
use crate::{Error, ViewBuffers};

/// Boxes of a view in a slice, and slices: `CLUSTERS` of `cluster_grid.wgsl`.
const CLUSTERS: [u32; 2] = [16 * 9, 24];
/// Threads of a workgroup of `clusters.wgsl`.
const WORKGROUP: u32 = 64;

/// The pass that cuts the view into boxes and finds the lights that reach each (Olsson, Billeter and Assarsson, "Clustered
/// Deferred and Forward Shading", 2012). A bit for each light and box: 14 KiB for 32 lights, 432 KiB for 1,000.
pub struct Clusters {
    shader: ComputeShader,
}

impl Clusters {
    /// Composes the shader.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let file = "clusters.wgsl";
        let module = module(device, file, &[])?;
        Ok(Self { shader: ComputeShader::module(file, &module) })
    }

    /// Adds the pass, and returns the buffers with what it finds: passes that light with them ask only the lights that reach a
    /// pixel's box. The picture is the same, as a light gives nothing beyond its range; lights without a range and directional
    /// ones reach everywhere.
    pub fn add_to(&self, frame: &mut Frame<'_>, view: &ViewBuffers, light_count: usize) -> ViewBuffers {
        let [boxes, slices] = CLUSTERS;
        let height = slices * (light_count as u32).div_ceil(32).max(1);
        let mut clusters =
            frame.create_texture("cluster lights", TextureDesc::d2(boxes, height, Format::R32Uint));
        frame
            .compute("light clusters", &self.shader)
            .storage(&view.view)
            .storage(&view.lights)
            .storage_texture_mut(&mut clusters, Contents::Overwrite)
            .dispatch([(boxes * height).div_ceil(WORKGROUP), 1, 1]);
        ViewBuffers { clusters: Some(clusters), ..view.clone() }
    }
}
