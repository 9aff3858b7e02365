//! Light clusters: the lights that reach each part of the view.

use shadowgraph_core::{ComputeShader, Contents, Format, Frame, TextureDesc};

use crate::error::Error;
use crate::shader::module;
use crate::uniforms::ViewBuffers;

/// Clusters across, down, and away from the camera: `CLUSTERS` of `cluster_grid.wgsl`.
const CLUSTERS: [u32; 3] = [16, 9, 24];
/// Workgroup size of `clusters.wgsl`.
const WORKGROUP: u32 = 64;

/// The pass that divides the view into clusters and finds the lights that reach each (Olsson, Billeter and Assarsson,
/// "Clustered Deferred and Forward Shading", 2012). It stores one bit per light and cluster: 14 KiB for 32 lights, 432 KiB
/// for 1,000.
pub struct Clusters {
    shader: ComputeShader,
}

impl Clusters {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let file = "clusters.wgsl";
        let module = module(device, file, &[])?;
        Ok(Self { shader: ComputeShader::module(file, &module) })
    }

    /// Adds the pass, and returns the buffers with its result: lit passes that read them evaluate only the lights that reach
    /// a pixel's cluster. The image is the same, as a light has no effect beyond its range; lights without a range and
    /// directional ones reach every cluster.
    pub fn add_to(&self, frame: &mut Frame<'_>, view: &ViewBuffers, light_count: usize) -> ViewBuffers {
        let [across, down, slices] = CLUSTERS;
        let clusters_per_slice = across * down;
        let height = slices * (light_count as u32).div_ceil(32).max(1);
        let mut clusters = frame
            .create_texture("cluster lights", TextureDesc::d2(clusters_per_slice, height, Format::R32Uint));
        frame
            .compute("light clusters", &self.shader)
            .uniform_buffer(&view.view)
            .storage(&view.lights)
            .storage_texture_mut(&mut clusters, Contents::Overwrite)
            .dispatch([(clusters_per_slice * height).div_ceil(WORKGROUP), 1, 1]);
        ViewBuffers { clusters: Some(clusters), ..view.clone() }
    }
}
