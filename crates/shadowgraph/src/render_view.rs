//! One view of a frame.

use glam::Vec4;
use shadowgraph_core::{Format, Frame, Texture, TextureDesc};
use shadowgraph_lighting::{
    AmbientLight, Backdrop, CullView, CulledGeometry, Geometry, KeyLight, LitOutput, OcclusionCulling,
    PosePass, Prepass, PreviousCameras, SkyLight, Tonemap, TonemapSettings, ViewBuffers, ViewUniforms,
};
use shadowgraph_scene::gpu::{CullFlags, DrawList};
use shadowgraph_scene::{Camera, GroundPlane, Light};
use shadowgraph_shadows::{ShadowInputs, ShadowOutputs, ShadowTechnique, SurfaceBuffers, add_shadows};

use crate::background::Background;
use crate::casters::SceneCasters;
use crate::error::Error;
use crate::view_options::ViewOptions;

/// The format of finished images.
pub(crate) const IMAGE_FORMAT: Format = Format::Rgba8UnormSrgb;

/// One view of a frame: its camera, the visible geometry, and the target of its image.
pub struct RenderView<'v> {
    /// The index of the view in the frame.
    pub index: u32,
    /// Camera, size and shadow settings.
    pub options: &'v ViewOptions,
    /// The visible geometry; only the blended one if the GPU culls the other.
    pub draws: DrawList,
    /// The illuminance of the scene by its lights.
    pub key_light: KeyLight,
    /// The ambient light without a sky, and the exposure.
    pub ambient_light: AmbientLight,
    /// The scene's lights.
    pub lights: &'v [Light],
    /// The ground of the scene, if the image is one in colour.
    pub ground: Option<GroundPlane>,
    /// What is drawn behind the scene.
    pub background: Background,
    /// The scene on the GPU.
    pub casters: &'v SceneCasters,
    /// The pass that deforms meshes.
    pub pose: &'v PosePass,
    /// The shadow technique.
    pub technique: &'v dyn ShadowTechnique,
    /// The camera that shadows are fitted to.
    pub shadow_camera: &'v Camera,
    /// The cameras of the renderer's views in their previous frames.
    pub previous_cameras: &'v PreviousCameras,
    /// Value that lit passes write.
    pub lit_output: LitOutput,
    /// The number of the frame if the pipeline is [temporal](crate::pipelines::PipelineInstance::is_temporal): noise changes with it.
    pub noise_frame: Option<u32>,
    /// The target of the colour image: a texture of the caller, as large as the view; `None` for a texture of the frame.
    pub target: Option<&'v wgpu::Texture>,
}

/// The culled geometry of a view, published in its frame.
struct ViewGeometry {
    view: u32,
    culled: CulledGeometry,
}

impl<'v> RenderView<'v> {
    /// Returns the GPU data of the camera and the lights.
    pub fn uniforms(&self) -> ViewUniforms {
        let ViewOptions { camera, size_px, .. } = self.options;
        let origin_world = self.casters.scene.origin_world();
        let motion = self.previous_cameras.motion(self.index, camera, self.options.aspect());
        ViewUniforms::new(camera, *size_px, self.lights, origin_world, &self.ambient_light)
            .moving(motion)
            .with_noise(self.noise_frame)
    }

    /// Returns the buffers of the view with the light of a sky above the ground of the scene, for ambient occlusion and lit passes.
    pub fn with_sky(&self, frame: &mut Frame<'_>, buffers: &ViewBuffers, sky: &SkyLight) -> ViewBuffers {
        let origin_world = self.casters.scene.origin_world();
        let light = sky.upload(frame, self.ground.as_ref(), self.backdrop(), origin_world);
        ViewBuffers { sky: Some(light), ground_height: self.ground_height(), ..buffers.clone() }
    }

    /// Returns the height of the ground relative to the frame's origin, metres, if the image shows one.
    pub fn ground_height(&self) -> Option<f32> {
        let origin_world = self.casters.scene.origin_world();
        self.ground.map(|ground| (ground.height_world - origin_world.y) as f32)
    }

    /// Returns the visible geometry, for passes of `frame`. If the GPU culls, adds the pass that does, unless the frame has it.
    pub fn geometry(&self, frame: &mut Frame<'v>) -> Geometry<'_> {
        let culled = self.casters.culls_on_gpu().then(|| self.culled(frame));
        self.geometry_with(culled)
    }

    fn geometry_with(&self, culled: Option<CulledGeometry>) -> Geometry<'_> {
        Geometry { scene: &self.casters.scene, draws: &self.draws, culled, size_px: self.options.size_px }
    }

    /// Returns the draws of all visible geometry, also where the GPU culls it.
    pub fn list_draws(&self) -> DrawList {
        let ViewOptions { camera, .. } = self.options;
        let mut visible = Vec::new();
        self.casters.scene.cull(&camera.frustum(self.options.aspect()).into(), &mut visible);
        self.casters.scene.draw_list(&visible, camera.position_world())
    }

    /// Adds the pass that deforms meshes, before anything draws them, unless the frame has it.
    pub fn add_pose(&self, frame: &mut Frame<'v>) {
        self.pose.add_to(frame, &self.casters.scene);
    }

    /// Returns the culled geometry of the view; adds the pass that culls it unless the frame has it.
    fn culled(&self, frame: &mut Frame<'v>) -> CulledGeometry {
        if let Some(published) = frame.published::<ViewGeometry>().ok().filter(|of| of.view == self.index) {
            return published.culled.clone();
        }
        let casters = self.casters;
        let solid = self.solid_view();
        let moving = casters.scene.any_moving().then_some(1);
        let required = solid.required.union(CullFlags::MOVING);
        let mut views = vec![solid];
        views.extend(moving.map(|_| CullView { required, name: "moving".into(), ..views[0].clone() }));
        let instances = frame.node("cull geometry", |frame| casters.cull(frame, &views));
        let culled = CulledGeometry { instances, solid: 0, moving };
        frame.publish(ViewGeometry { view: self.index, culled: culled.clone() });
        culled
    }

    /// Returns the view of all geometry that is not blended.
    fn solid_view(&self) -> CullView {
        let name = if self.index == 0 { "camera".into() } else { format!("camera {}", self.index) };
        CullView {
            name,
            volume: self.options.camera.frustum(self.options.aspect()),
            required: CullFlags::SOLID.union(CullFlags::SEEN),
            excluded: CullFlags::default(),
        }
    }

    /// Adds the depth prepass of what is not hidden, and returns the depth. From then on, [`geometry`](Self::geometry) returns what is
    /// not hidden.
    pub(crate) fn add_occluded_prepass<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (occlusion, prepass): (&'f OcclusionCulling, &'f Prepass),
        buffers: &ViewBuffers,
    ) -> Texture {
        let (geometry, view) = (self.geometry_with(None), self.solid_view());
        let passes = (prepass, self.casters.cull_pass());
        let note = self.casters.culling();
        let (depth, culled) = occlusion.add_prepass(frame, passes, buffers, (&geometry, &view), &note);
        frame.publish(ViewGeometry { view: self.index, culled });
        depth
    }

    /// Adds the shadows of all lights. A technique that reads surface buffers needs `surfaces`.
    ///
    /// # Errors
    /// For settings out of range, and for a technique that breaks its contract.
    pub fn add_shadows(
        &'v self,
        frame: &mut Frame<'v>,
        surfaces: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'v>, Error> {
        Ok(add_shadows(self.technique, frame, &self.shadow_inputs(), surfaces)?)
    }

    /// Returns the inputs of the shadow technique.
    pub fn shadow_inputs(&self) -> ShadowInputs<'_> {
        ShadowInputs {
            view: self.index,
            camera: self.shadow_camera,
            aspect: self.options.aspect(),
            lights: self.lights,
            casters: self.casters,
            origin_world: self.casters.scene.origin_world(),
            settings: &self.options.shadows,
        }
    }

    /// Returns the clear colour of lit passes: the colour of the sky, or nothing if they write data or the background comes later.
    pub fn clear_color(&self) -> [f64; 4] {
        match self.background {
            Background::Sky if self.lit_output == LitOutput::Light => self.ambient_light.background(),
            _ => [0.0; 4],
        }
    }

    /// Returns what pipelines with a sky draw where there is no geometry.
    fn backdrop(&self) -> Backdrop {
        match self.background {
            Background::Sky => Backdrop::Sky,
            Background::Color(_) | Background::Transparent => Backdrop::Shadows,
        }
    }

    /// Returns the descriptor of a texture as large as the view.
    pub fn texture_desc(&self, format: Format) -> TextureDesc {
        let [width, height] = self.options.size_px;
        TextureDesc::d2(width, height, format)
    }

    /// Adds the node that tonemaps light into the view's image, for pipelines that end with it.
    pub fn add_tonemap(&self, frame: &mut Frame<'_>, tonemap: &Tonemap, light: &Texture) -> Texture {
        frame.node("tonemap", |frame| {
            let mut image = self.target_texture(frame);
            tonemap.add_to(frame, light, &mut image, &self.tonemap_settings(None));
            image
        })
    }

    /// Returns the settings of the tonemap, with the background behind the scene. `exposure` is one texel, a factor of all light.
    pub fn tonemap_settings(&self, exposure: Option<Texture>) -> TonemapSettings {
        let background = match self.background {
            Background::Sky => None,
            Background::Color(color) => Some(color.extend(1.0)),
            Background::Transparent => Some(Vec4::ZERO),
        };
        TonemapSettings { exposure, background }
    }

    /// Imports the target of the view's image, or creates a texture of the frame.
    pub fn target_texture(&self, frame: &mut Frame<'_>) -> Texture {
        match self.target {
            Some(texture) => frame.import_texture("target", texture, false),
            None => frame.create_texture("image", self.texture_desc(IMAGE_FORMAT)),
        }
    }
}
