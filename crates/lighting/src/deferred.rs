//! Deferred lighting: each pixel of a G-buffer is lit once.

use shadowgraph_core::{Bind, Contents, Frame, Texture, TextureDesc};
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique};

use crate::screen_pass::{Key, ScreenPass, ScreenShader, texels};
use crate::{Error, GBuffer, LitTarget, ViewBuffers};

/// The pass that lights a G-buffer with the shadows of one technique.
pub struct Deferred {
    pass: ScreenPass,
    target: LitTarget,
}

impl Deferred {
    /// Makes what its pipelines share. The target has one sample a pixel.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose; [`Error::Samples`] for a target of several.
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
        // Depth, and the textures of the G-buffer in their order.
        let own = [Depth, float, float, Uint, float].map(texels);
        Ok(Self { pass: ScreenPass::new(device, technique, shader, &own)?, target })
    }

    /// Adds the pass that lights what is seen into a new texture, and returns it. Where nothing is drawn it holds
    /// `background`, in the texture's own terms.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose in the variant that the frame asks for.
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
        let key = Key { variant, constant: debug_light, extras: view.extras() };
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
            let own = ctx.bind_group(&self.pass.own_layout, &texels.map(Bind::Texture))?;
            ctx.pass.set_pipeline(&pipeline);
            for (index, group) in (0..).zip([&view, &shadows, &own]) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.draw(0..3, 0..1);
            ctx.report_draws(1);
            Ok(())
        });
        Ok(light)
    }
}
