//! The values of a drawing command's options.

use shadowgraph::core::ValueCheck;
use shadowgraph::options::{
    AdapterChoice, AnimationChoice, AnimationTime, Aov, CameraChoice, GroundChoice, ShadowDistance, Size,
    SunChoice,
};
use shadowgraph::scene::{Camera, Scene};
use shadowgraph::shadows::{SettingTracks, ShadowSettings, Technique};
use shadowgraph::{Background, Culling, Gpu, Pipeline, RenderConfig, Renderer, ShadowLines};

/// The options of a drawing command, without the files of the scene and the output.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Options {
    /// The pipeline.
    pub(crate) pipeline: Pipeline,
    /// The shadow technique; `None` for that of the pipeline.
    pub(crate) technique: Option<Technique>,
    /// Samples per pixel of colour images, 1 or 4.
    pub(crate) samples: u32,
    /// The shadow settings.
    pub(crate) settings: ShadowSettings,
    /// The settings that change with time and place.
    pub(crate) tracks: SettingTracks,
    /// The size of the image.
    pub(crate) size: Size,
    /// The camera.
    pub(crate) camera: CameraChoice,
    /// The directional lights.
    pub(crate) sun: SunChoice,
    /// The ground under the scene.
    pub(crate) ground: GroundChoice,
    /// What is drawn behind the scene.
    pub(crate) background: Background,
    /// What culls instances.
    pub(crate) culling: Culling,
    /// The animations that are played.
    pub(crate) animation: AnimationChoice,
    /// The moment of the animations.
    pub(crate) time: AnimationTime,
    /// The shadow distance, instead of `settings.distance_m`.
    pub(crate) shadow_distance: ShadowDistance,
    /// The AOV that the image shows.
    pub(crate) aov: Aov,
    /// The lines over the image.
    pub(crate) overlay: Option<ShadowLines>,
    /// The camera that shadows are fitted to; `None` for that of the image.
    pub(crate) shadow_camera: Option<CameraChoice>,
    /// The GPU.
    pub(crate) adapter: AdapterChoice,
    /// Whether times per pass are measured.
    pub(crate) timings: bool,
    /// The check of the values that passes write.
    pub(crate) check_values: Option<ValueCheck>,
}

impl Options {
    /// Returns the configuration of the renderer.
    pub(crate) fn render_config(&self) -> RenderConfig {
        RenderConfig {
            technique: self.technique,
            pipeline: self.pipeline.clone(),
            samples: self.samples,
            background: self.background,
            culling: self.culling,
        }
    }

    /// Creates the renderer of a scene, for a first view from `camera`.
    pub(crate) fn renderer(
        &self,
        gpu: &Gpu,
        scene: Scene,
        camera: &Camera,
    ) -> Result<Renderer, shadowgraph::Error> {
        Renderer::with_config(gpu, scene, camera, self.aov.clone(), self.render_config())
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            pipeline: Pipeline::default(),
            technique: None,
            samples: 1,
            settings: ShadowSettings::default(),
            tracks: SettingTracks::default(),
            size: Size::default(),
            camera: CameraChoice::default(),
            sun: SunChoice::default(),
            ground: GroundChoice::default(),
            background: Background::default(),
            culling: Culling::default(),
            animation: AnimationChoice::default(),
            time: AnimationTime::default(),
            shadow_distance: ShadowDistance::default(),
            aov: Aov::default(),
            overlay: None,
            shadow_camera: None,
            adapter: AdapterChoice::default(),
            timings: false,
            check_values: None,
        }
    }
}
