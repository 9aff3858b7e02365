//! One view of a frame.

use shadowgraph_core::{Format, Frame, Texture, TextureDesc};
use shadowgraph_lighting::{AmbientLight, Geometry, LitOutput, Tonemap, ViewUniforms};
use shadowgraph_scene::gpu::DrawList;
use shadowgraph_scene::{Camera, Light};
use shadowgraph_shadows::{ShadowInputs, ShadowOutputs, ShadowTechnique, SurfaceBuffers, add_shadows};

use crate::renderer::PICTURE_FORMAT;
use crate::{Error, SceneCasters, ViewOptions};

/// One view of a frame: who looks, what is seen, and where the picture goes.
pub struct View<'v> {
    /// Which of the frame's views it is, from 0.
    pub number: u32,
    /// Who looks, and how.
    pub options: &'v ViewOptions,
    /// What of the scene is seen.
    pub draws: DrawList,
    /// The light from all around, and the exposure.
    pub ambient_light: AmbientLight,
    /// The scene's lights.
    pub lights: &'v [Light],
    /// The scene on the GPU.
    pub casters: &'v SceneCasters,
    /// How shadows are made.
    pub technique: &'v dyn ShadowTechnique,
    /// Whose view shadows are made for.
    pub shadow_camera: &'v Camera,
    /// What lit passes write.
    pub output: LitOutput,
    /// Where a colour picture goes: a texture of the caller's, as large as the view; `None`: one of the frame.
    pub target: Option<&'v wgpu::Texture>,
}

impl<'v> View<'v> {
    /// Returns the records of the camera and of the lights, for every shader.
    pub fn uniforms(&self) -> ViewUniforms {
        let ViewOptions { camera, size_px, .. } = self.options;
        let origin_world = self.casters.scene.origin_world();
        ViewUniforms::new(camera, *size_px, self.lights, origin_world, &self.ambient_light)
    }

    /// Returns what is drawn.
    pub fn geometry(&self) -> Geometry<'_> {
        Geometry { scene: &self.casters.scene, draws: &self.draws, size_px: self.options.size_px }
    }

    /// Adds the shadows of all lights by the view's technique. `screen` has to be there for techniques that read surfaces.
    ///
    /// # Errors
    /// For settings out of range, and a technique that does not keep to its contract.
    pub fn shadows(
        &'v self,
        frame: &mut Frame<'v>,
        screen: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'v>, Error> {
        Ok(add_shadows(self.technique, frame, &self.shadow_inputs(), screen)?)
    }

    /// Returns what shadows are made for.
    pub fn shadow_inputs(&self) -> ShadowInputs<'_> {
        ShadowInputs {
            view: self.number,
            camera: self.shadow_camera,
            aspect: self.options.aspect(),
            lights: self.lights,
            casters: self.casters,
            origin_world: self.casters.scene.origin_world(),
            settings: &self.options.shadows,
        }
    }

    /// Returns what is where nothing is drawn, in the terms of lit passes: only pictures of light have a sky.
    pub fn background(&self) -> [f64; 4] {
        if self.output == LitOutput::Light { self.ambient_light.background() } else { [0.0; 4] }
    }

    /// Returns the shape of a texture as large as the view.
    pub fn texture_desc(&self, format: Format) -> TextureDesc {
        let [width, height] = self.options.size_px;
        TextureDesc::d2(width, height, format)
    }

    /// Adds the node that makes the picture of light, for pipelines that end with it.
    pub fn tonemapped(&self, frame: &mut Frame<'_>, tonemap: &Tonemap, light: &Texture) -> Texture {
        frame.node("picture", |frame| {
            let mut picture = self.picture(frame);
            tonemap.add_to(frame, light, &mut picture);
            picture
        })
    }

    /// Imports the texture that the picture goes to, or creates one of the frame.
    pub fn picture(&self, frame: &mut Frame<'_>) -> Texture {
        match self.target {
            Some(texture) => frame.import_texture("target", texture, false),
            None => frame.create_texture("picture", self.texture_desc(PICTURE_FORMAT)),
        }
    }
}
