//! The depth prepass.

use shadowgraph_core::{Bind, Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_scene::gpu::{DepthPipelines, DepthTarget, Draw, MaterialLayouts};
use shadowgraph_shadows::VertexBuffers;

use crate::error::Error;
use crate::geometry::Geometry;
use crate::uniforms::{GpuView, ViewBuffers};

/// The format of camera depth.
pub(crate) const DEPTH_FORMAT: Format = Format::Depth32Float;

/// The pass that draws only depth.
pub struct Prepass {
    pipelines: DepthPipelines,
    samples: u32,
}

impl Prepass {
    /// Creates the pipelines for materials of these layouts, with 1 or 4 samples per pixel.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device, layouts: &MaterialLayouts, samples: u32) -> Result<Self, Error> {
        let target = DepthTarget { samples, ..DepthTarget::default() };
        Ok(Self { pipelines: DepthPipelines::new(device, layouts, &target)?, samples })
    }

    /// Returns the pipelines, for a pass that is recorded without the graph.
    pub fn pipelines(&self) -> &DepthPipelines {
        &self.pipelines
    }

    /// Adds the pass that draws the depth of all solid geometry, and returns the depth.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        geometry: &Geometry<'f>,
    ) -> Texture {
        let [width, height] = geometry.size_px;
        let desc = TextureDesc::d2(width, height, DEPTH_FORMAT).samples(self.samples);
        let mut depth = frame.create_texture("depth", desc);
        self.add_pass(frame, "depth prepass", view, geometry, (&mut depth, Contents::clear_depth(0.0)));
        depth
    }

    /// Adds the pass that draws the depth of more geometry into that of other geometry.
    pub(crate) fn add_more<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        geometry: &Geometry<'f>,
        depth: &mut Texture,
    ) {
        self.add_pass(frame, "depth prepass of the rest", view, geometry, (depth, Contents::Preserve));
    }

    fn add_pass<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &str,
        view: &ViewBuffers,
        geometry: &Geometry<'f>,
        (depth, contents): (&mut Texture, Contents),
    ) {
        let buffers = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass(name);
        buffers.read_in(&mut pass);
        let view = pass.storage_buffer(&view.view);
        let solid = geometry.solid_in(&mut pass);
        pass.depth(depth, contents);
        pass.body(move |ctx| {
            let view = Bind::BufferRange(view, 0..size_of::<GpuView>() as u64);
            let group = ctx.bind_group(self.pipelines.view_layout(), &[view])?;
            ctx.pass.set_bind_group(0, &group, &[0]);
            solid.record(ctx, &|draw: &Draw| Some(self.pipelines.get(draw.key)))
        });
    }
}
