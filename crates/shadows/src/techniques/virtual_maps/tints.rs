//! The passes that draw translucent casters into pages.

use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, TextureDesc};
use shadowgraph_shaders::compose;

use super::projections::PAGE_PX;
use crate::error::Error;
use crate::layered_casters::{LayerTokens, LayeredCasters, LayeredInstances, TintTokens};
use crate::technique::binding::STORAGE;
use crate::technique::layout;
use crate::techniques::compute::{WRITTEN, dispatch, pipeline, shader};
use crate::vertex_buffers::VertexBuffers;

/// Workgroups of the pass that clears pages.
const WORKGROUPS: u32 = 32;

/// The buffers of tints of a pool: a depth and a density for each texel of each physical page.
pub(super) struct Tints {
    pub(super) depths: Buffer,
    pub(super) densities: Buffer,
}

/// Draws translucent casters.
pub(super) struct TintPasses {
    layout: wgpu::BindGroupLayout,
    clear: wgpu::ComputePipeline,
}

impl TintPasses {
    pub(super) fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let layout = layout(device, "clear tints", &[STORAGE, WRITTEN, WRITTEN]);
        let shader = shader(device, "pages_clear_tints.wgsl", compose("pages_clear_tints.wgsl", &[])?);
        let clear = pipeline(device, &shader, "cs_clear", &[&layout]);
        Ok(Self { layout, clear })
    }

    /// Adds the passes. `depths` are those of the other casters in the layers of `views`, the pages that the frame draws.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (casters, drawn): (&'f dyn LayeredCasters, &LayeredInstances),
        (views, depths): (&Buffer, &mut Buffer),
        tints: &mut Tints,
    ) {
        self.clear(frame, views, tints);
        let mut target = frame.create_texture("page", TextureDesc::d2(PAGE_PX, PAGE_PX, Format::R8Unorm));
        let vertices = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass("draw tints");
        vertices.read_in(&mut pass);
        let tokens = LayerTokens::in_pass(&mut pass, drawn, views, depths);
        let tints = TintTokens {
            depths: pass.storage_buffer_mut(&mut tints.depths, Contents::Preserve),
            densities: pass.storage_buffer_mut(&mut tints.densities, Contents::Preserve),
        };
        pass.color(&mut target, Contents::clear_color([0.0; 4]));
        pass.body(move |ctx| casters.draw_layer_tints(ctx, tokens, tints).map(|_| ()));
    }

    fn clear<'f>(&'f self, frame: &mut Frame<'f>, views: &Buffer, tints: &mut Tints) {
        let mut pass = frame.compute_pass("clear tints");
        let views = Bind::Buffer(pass.storage_buffer(views));
        let [depths, densities] = [&mut tints.depths, &mut tints.densities]
            .map(|buffer| Bind::Buffer(pass.storage_buffer_mut(buffer, Contents::Preserve)));
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.layout, &[views, depths, densities])?;
            dispatch(&mut ctx.pass, &self.clear, &[group], [WORKGROUPS, 1, 1]);
            Ok(())
        });
    }
}
