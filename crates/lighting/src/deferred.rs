//! Deferred lighting: each pixel of a G-buffer is lit once.

use shadowgraph_core::{Bind, Contents, Frame, Texture, TextureDesc};
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique};

use crate::error::Error;
use crate::gbuffer::GBuffer;
use crate::lit_target::LitTarget;
use crate::screen_pass::{PipelineKey, ScreenPass, ScreenShader, texels};
use crate::uniforms::ViewBuffers;

/// The pass that lights a G-buffer with the shadows of one technique.
pub struct Deferred {
    pass: ScreenPass,
    target: LitTarget,
}

impl Deferred {
    /// Creates the state that its pipelines share. The target must have one sample per pixel.
    ///
    /// # Errors
    /// [`Error::Shader`] if the technique's WGSL does not compose; [`Error::Samples`] for a multisampled target.
    pub fn new(
        device: &wgpu::Device,
        technique: &dyn ShadowTechnique,
        target: LitTarget,
    ) -> Result<Self, Error> {
        use wgpu::TextureSampleType::{Depth, Float, Uint};
        if target.samples != 1 {
            return Err(Error::Samples { samples: target.samples });
        }
        let shader = ScreenShader {
            file: "deferred.wgsl",
            entries: ["vs_deferred", "fs_deferred"],
            format: target.format,
            blend: None,
        };
        let float = Float { filterable: false };
        // Depth, and the textures of the G-buffer in order.
        let textures = [Depth, float, float, Uint, float].map(texels);
        Ok(Self { pass: ScreenPass::new(device, technique, shader, &textures)?, target })
    }

    /// Adds the pass that lights the G-buffer into a new texture, and returns it. Where nothing is drawn the texture contains
    /// `background`, in its own encoding, or the sky if `view` has one.
    ///
    /// # Errors
    /// [`Error::Shader`] if the technique's WGSL does not compose in the variant that the frame needs.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        depth: &Texture,
        gbuffer: &GBuffer,
        background: [f64; 4],
    ) -> Result<Texture, Error> {
        let (variant, debug_light) = self.target.variant(shadows);
        let key = PipelineKey { variant, constant: debug_light, bindings: view.background_bindings() };
        let pipeline = self.pass.pipeline(key, &self.target.constants(debug_light))?;
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let desc = TextureDesc::d2(size.width, size.height, self.target.format);
        let mut light = frame.create_texture("lit", desc);
        let mut pass = frame.render_pass("deferred");
        let (shadows, view) = (shadows.read_in(&mut pass), view.read_in(&mut pass));
        let GBuffer { base_color, material, normals, emissive } = gbuffer;
        let texels = [depth, base_color, material, normals, emissive].map(|texture| pass.sample(texture));
        pass.color(&mut light, Contents::clear_color(background));
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.pass.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.pass.shadow_layout)?;
            let textures = ctx.bind_group(&self.pass.pass_layout, &texels.map(Bind::Texture))?;
            ctx.pass.set_pipeline(&pipeline);
            for (index, group) in (0..).zip([&view, &shadows, &textures]) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.draw(0..3, 0..1);
            ctx.report_draws(1);
            Ok(())
        });
        Ok(light)
    }
}
