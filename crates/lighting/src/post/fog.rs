//! Fog that scatters light, shadows included.

use bytemuck::{NoUninit, bytes_of};
use glam::Vec3;
use shadowgraph_core::{Bind, Contents, Format, Frame, Texture};
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique};

use crate::screen_pass::{Key, ScreenPass, ScreenShader, texels};
use crate::{Error, ViewBuffers};

/// Thin fog: light of every light is scattered on its way to the camera, where no shadow keeps it, so that shafts of light are seen.
/// It asks the technique's point function at steps along each pixel's way.
pub struct Fog {
    pass: ScreenPass,
}

/// What fog is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogSettings {
    /// The part of the light that is scattered and not swallowed, linear RGB, 0 to 1.
    pub albedo: [f32; 3],
    /// How much is lost per metre up to `height_m`, from 0.
    pub density: f32,
    /// The height in the world up to which it is dense, metres.
    pub height_m: f64,
    /// How fast it gets thinner above, per metre, from 0.
    pub falloff: f32,
    /// Over -1, back to the light, to under 1, onwards; 0 is evenly.
    pub anisotropy: f32,
    /// How far it is looked for, metres: over 0.
    pub distance_m: f32,
    /// In how many steps, at least 1.
    pub steps: u32,
}

impl Default for FogSettings {
    fn default() -> Self {
        Self {
            albedo: [1.0; 3],
            density: 0.01,
            height_m: 4.0,
            falloff: 0.1,
            anisotropy: 0.4,
            distance_m: 80.0,
            steps: 24,
        }
    }
}

/// `Fog` of `post/fog.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Block {
    albedo: Vec3,
    density: f32,
    height: f32,
    falloff: f32,
    anisotropy: f32,
    distance: f32,
    steps: u32,
    padding: [u32; 3],
}

impl Fog {
    /// Makes what its pipelines share.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose.
    pub fn new(device: &wgpu::Device, technique: &dyn ShadowTechnique) -> Result<Self, Error> {
        let shader = ScreenShader {
            file: "post/fog.wgsl",
            entries: ["vs_fog", "fs_fog"],
            format: Format::Rgba16Float,
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        };
        let block = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let own = [texels(wgpu::TextureSampleType::Depth), block];
        Ok(Self { pass: ScreenPass::new(device, technique, shader, &own)? })
    }

    /// Adds the pass that lays fog over `light`. `depth` is that of what is drawn, `origin_y` the height of the frame's origin in the
    /// world, metres.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        shadows: &ShadowOutputs<'f>,
        [depth, light]: [&Texture; 2],
        origin_y: f64,
        settings: &FogSettings,
    ) -> Result<Texture, Error> {
        let view = ViewBuffers { occlusion: None, ..view.clone() };
        // Points in the air are not on the screen: variant 0 answers for all.
        let key = Key { variant: 0, constant: 0, extras: view.extras() };
        let pipeline = self.pass.pipeline(key, &[])?;
        let FogSettings { albedo, density, height_m, falloff, anisotropy, distance_m, steps } = *settings;
        let block = Block {
            albedo: albedo.into(),
            density,
            height: (height_m - origin_y) as f32,
            falloff,
            anisotropy: anisotropy.clamp(-0.95, 0.95),
            distance: distance_m,
            steps: steps.max(1),
            padding: [0; 3],
        };
        let block = frame.uniform(bytes_of(&block));
        let mut light = light.clone();
        let mut pass = frame.render_pass("fog");
        let (shadows, view) = (shadows.read_in(&mut pass), view.read_in(&mut pass));
        let depth = pass.sample(depth);
        pass.color(&mut light, Contents::Preserve);
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.pass.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.pass.shadow_layout)?;
            let own = ctx.bind_group(&self.pass.own_layout, &[Bind::Texture(depth), Bind::Uniform(block)])?;
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
