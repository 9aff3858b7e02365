//! The pool of physical pages as an image, for `--aov pool`.

use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_shaders::compose;

use crate::error::Error;
use crate::technique::binding::{DEPTH_MAP, STORAGE};
use crate::technique::layout;
use crate::techniques::compute::{dispatch, pipeline, shader};

/// The side of a workgroup, pixels.
const WORKGROUP_PX: u32 = 8;

const IMAGE: wgpu::BindingType = wgpu::BindingType::StorageTexture {
    access: wgpu::StorageTextureAccess::WriteOnly,
    format: Format::Rgba8Unorm,
    view_dimension: wgpu::TextureViewDimension::D2,
};

/// Draws the pool as an image.
pub(super) struct PoolView {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl PoolView {
    pub(super) fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let layout = layout(device, "pool", &[STORAGE, STORAGE, STORAGE, STORAGE, DEPTH_MAP, IMAGE]);
        let shader = shader(device, "pages_view.wgsl", compose("pages_view.wgsl", &[])?);
        let pipeline = pipeline(device, &shader, "cs_view", &[&layout]);
        Ok(Self { layout, pipeline })
    }

    /// Adds the pass, which is culled if nothing reads the image. `buffers` are the projections, levels, table and physical pages.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        buffers: [&Buffer; 4],
        pool: &Texture,
        [width, height]: [u32; 2],
    ) -> Texture {
        let mut image = frame.create_texture("pool", TextureDesc::d2(width, height, Format::Rgba8Unorm));
        let mut pass = frame.compute_pass("view of the pool");
        let [projections, levels, table, pages] =
            buffers.map(|buffer| Bind::Buffer(pass.storage_buffer(buffer)));
        let pool = Bind::Texture(pass.sample(pool));
        let target = Bind::Texture(pass.storage_texture_mut(&mut image, Contents::Overwrite));
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.layout, &[projections, levels, table, pages, pool, target])?;
            let [x, y] = [width, height].map(|side| side.div_ceil(WORKGROUP_PX));
            dispatch(&mut ctx.pass, &self.pipeline, &[group], [x, y, 1]);
            Ok(())
        });
        image
    }
}
