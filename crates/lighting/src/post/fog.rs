//! Volumetric fog with shadows.

use bytemuck::{NoUninit, bytes_of};
use glam::Vec3;
use shadowgraph_core::{Bind, Contents, Format, Frame, Texture};
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique};

use crate::error::Error;
use crate::screen_pass::{PipelineKey, ScreenPass, ScreenShader, texels};
use crate::uniforms::ViewBuffers;

/// Thin fog that scatters the light of every light towards the camera where it is not in shadow, which makes light shafts
/// visible. It calls the technique's point evaluation at steps along the view ray of each pixel.
pub struct Fog {
    pass: ScreenPass,
}

/// Settings of fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogSettings {
    /// The fraction of the light that is scattered rather than absorbed, linear RGB, 0 to 1.
    pub albedo: [f32; 3],
    /// Extinction per metre up to `height_m`, 0 or more.
    pub density: f32,
    /// The height in the world up to which the density is constant, metres.
    pub height_m: f64,
    /// Exponential falloff of the density above, per metre, 0 or more.
    pub falloff: f32,
    /// Scattering anisotropy: above -1 (backward) to below 1 (forward); 0 is isotropic.
    pub anisotropy: f32,
    /// The maximum distance of the fog from the camera, metres, above 0.
    pub distance_m: f32,
    /// Number of steps along a ray, at least 1.
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
struct FogUniforms {
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
    /// Creates the state that its pipelines share.
    ///
    /// # Errors
    /// [`Error::Shader`] if the technique's WGSL does not compose.
    pub fn new(device: &wgpu::Device, technique: &dyn ShadowTechnique) -> Result<Self, Error> {
        let shader = ScreenShader {
            file: "post/fog.wgsl",
            entries: ["vs_fog", "fs_fog"],
            format: Format::Rgba16Float,
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        };
        let uniforms = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let bindings = [texels(wgpu::TextureSampleType::Depth), uniforms];
        Ok(Self { pass: ScreenPass::new(device, technique, shader, &bindings)? })
    }

    /// Adds the pass that blends fog over `light`. `depth` is the scene's depth, `origin_y` the height of the frame's origin in
    /// the world, metres.
    ///
    /// # Errors
    /// [`Error::Shader`] if the technique's WGSL does not compose.
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
        // Points in the fog have no screen mask: variant 0 evaluates points anywhere.
        let key = PipelineKey { variant: 0, constant: 0, bindings: view.optional_bindings() };
        let pipeline = self.pass.pipeline(key, &[])?;
        let FogSettings { albedo, density, height_m, falloff, anisotropy, distance_m, steps } = *settings;
        let uniforms = FogUniforms {
            albedo: albedo.into(),
            density,
            height: (height_m - origin_y) as f32,
            falloff,
            anisotropy: anisotropy.clamp(-0.95, 0.95),
            distance: distance_m,
            steps: steps.max(1),
            padding: [0; 3],
        };
        let uniforms = frame.uniform(bytes_of(&uniforms));
        let mut light = light.clone();
        let mut pass = frame.render_pass("fog");
        let (shadows, view) = (shadows.read_in(&mut pass), view.read_in(&mut pass));
        let depth = pass.sample(depth);
        pass.color(&mut light, Contents::Preserve);
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.pass.view_layouts)?;
            let shadows = shadows.bind_group(ctx, &self.pass.shadow_layout)?;
            let group =
                ctx.bind_group(&self.pass.pass_layout, &[Bind::Texture(depth), Bind::Uniform(uniforms)])?;
            ctx.pass.set_pipeline(&pipeline);
            for (index, group) in (0..).zip([&view, &shadows, &group]) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.draw(0..3, 0..1);
            ctx.report_draws(1);
            Ok(())
        });
        Ok(light)
    }
}
