//! Drawing recorded frames again.

use shadowgraph_scene::{GroundPlane, Scene, origin_near};
use shadowgraph_shadows::ShadowSettings;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::options::aov::Aov;
use crate::options::error::OptionError;
use crate::pipelines::Pipeline;
use crate::pipelines::file::parameters::Parameters;
use crate::recording::entry::{FrameEntry, PipelineEntry, RendererEntry, ViewEntry};
use crate::recording::scene::SceneKeys;
use crate::recording::{Recording, RecordingError};
use crate::registry::Registry;
use crate::render_config::RenderConfig;
use crate::renderer::Renderer;
use crate::view_options::ViewOptions;

/// Draws the frames of a recording again. On the adapter and driver that drew them, and with the same shaders, images are equal to the bit.
///
/// ```
/// use serde_json::json;
/// use shadowgraph::options::Aov;
/// use shadowgraph::recording::{Recorder, Recording};
/// use shadowgraph::{Gpu, Registry, Renderer, Replay, ViewOptions};
/// use shadowgraph_samples::demo::demo_scene;
/// # let gpu = Gpu::noop()?;
/// let scene = demo_scene();
/// let recorder = Recorder::new(&scene, json!("the demo scene"), 64);
/// let mut options = ViewOptions { camera: scene.cameras[0].clone(), size_px: [64, 36], shadows: Default::default() };
/// let mut renderer = Renderer::new(&gpu, scene, &options.camera, Aov::Color)?;
/// renderer.set_recorder(Some(recorder));
/// for _ in 0..3 {
///     options.camera.world_from_view.translation.x += 0.1;
///     renderer.draw(&gpu, &options)?;
/// }
/// let text = renderer.recorder().unwrap().text().to_owned();
///
/// // Later, or in another process:
/// let recording = Recording::parse("frames.txt", &text)?;
/// let mut replay = Replay::new(&recording, demo_scene(), &Registry::built_in())?;
/// let (renderer, views) = replay.seek(&gpu, 2)?;
/// let image = renderer.draw(&gpu, &views[0])?.image;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Replay<'r> {
    recording: &'r Recording,
    registry: Registry,
    keys: SceneKeys,
    /// The scene as the program loads it.
    scene: Scene,
    /// The renderer, and the views of the frame that is prepared.
    stage: Option<Stage>,
}

struct Stage {
    renderer: Renderer,
    views: Vec<ViewOptions>,
    frame: usize,
    /// The frames that the renderer had drawn when this one was prepared.
    drawn: u32,
}

impl<'r> Replay<'r> {
    /// Prepares a recording of this scene, as the program loads it.
    ///
    /// # Errors
    /// [`RecordingError::OtherScene`].
    pub fn new(recording: &'r Recording, scene: Scene, registry: &Registry) -> Result<Self, RecordingError> {
        recording.header.scene.check(&scene)?;
        Ok(Self { recording, registry: registry.clone(), keys: SceneKeys::new(&scene), scene, stage: None })
    }

    /// Draws all frames before a frame, from 0, and returns the renderer and the views of that frame, for the caller to draw or to inspect: once,
    /// if a later frame is to be equal to the bit. A frame that lies behind the last one begins again with frame 0.
    ///
    /// # Errors
    /// [`RecordingError::NoFrame`]; [`RecordingError::Frame`] for a frame that cannot be drawn.
    pub fn seek(
        &mut self,
        gpu: &Gpu,
        frame: usize,
    ) -> Result<(&mut Renderer, &[ViewOptions]), RecordingError> {
        self.seek_observed(gpu, frame, &mut |_| ())
    }

    /// Seeks a frame like [`seek`](Self::seek), and calls `observe` with the number of each frame before it is drawn.
    ///
    /// # Errors
    /// As `seek`.
    pub fn seek_observed(
        &mut self,
        gpu: &Gpu,
        frame: usize,
        observe: &mut dyn FnMut(usize),
    ) -> Result<(&mut Renderer, &[ViewOptions]), RecordingError> {
        let last = self.recording.frame_count() - 1;
        if frame > last {
            return Err(RecordingError::NoFrame { frame, last });
        }
        let mut stage = self.stage.take().filter(|stage| stage.frame <= frame);
        loop {
            let next = stage.as_ref().map_or(0, |stage| stage.frame + 1);
            if next > frame {
                break;
            }
            observe(next);
            stage = Some(
                self.advance(gpu, stage, next)
                    .map_err(|source| RecordingError::Frame { frame: next, source: Box::new(source) })?,
            );
        }
        // The loop has prepared it, or it was before.
        let Stage { renderer, views, .. } =
            self.stage.insert(stage.ok_or(RecordingError::NoFrame { frame, last })?);
        Ok((renderer, views))
    }

    /// Draws the frame that is prepared, unless the caller has, and prepares the next one.
    fn advance(&self, gpu: &Gpu, stage: Option<Stage>, next: usize) -> Result<Stage, Error> {
        let entry = &self.recording.frames[next];
        let mut previous = None;
        if let Some(mut stage) = stage {
            if stage.renderer.frame_number() == stage.drawn {
                draw(&mut stage.renderer, gpu, &stage.views)?;
            }
            previous = Some(stage);
        }
        let known = previous.as_ref().map_or(&[][..], |stage| &stage.views);
        let views = self.views(&entry.views, known)?;
        let mut renderer = match (&entry.renderer, previous) {
            (None, Some(stage)) => stage.renderer,
            (new, previous) => {
                let scene =
                    previous.map_or_else(|| self.scene.clone(), |stage| stage.renderer.scene().clone());
                let new =
                    new.as_ref().ok_or_else(|| Error::Recorded("the first frame has no renderer".into()))?;
                self.renderer(gpu, new, scene, &views)?
            }
        };
        self.prepare(gpu, entry, &mut renderer)?;
        let drawn = renderer.frame_number();
        Ok(Stage { renderer, views, frame: next, drawn })
    }

    /// Gives a renderer what a frame has besides its views.
    fn prepare(&self, gpu: &Gpu, entry: &FrameEntry, renderer: &mut Renderer) -> Result<(), Error> {
        if let Some(camera) = &entry.shadow_camera {
            camera.check(1.0)?;
        }
        if entry.ground.is_some_and(|height_world| !height_world.is_finite()) {
            return Err(Error::Recorded("the height of the ground is not finite".into()));
        }
        renderer.set_shadow_camera(entry.shadow_camera.clone());
        renderer.set_overlay(gpu, entry.overlay)?;
        let scene = renderer.scene_mut();
        scene.ground = entry.ground.map(|height_world| GroundPlane { height_world });
        Ok(self.keys.apply(&entry.edits, scene)?)
    }

    /// Creates a renderer for a first frame with these views.
    fn renderer(
        &self,
        gpu: &Gpu,
        entry: &RendererEntry,
        mut scene: Scene,
        views: &[ViewOptions],
    ) -> Result<Renderer, Error> {
        self.keys.apply(&entry.edits, &mut scene)?;
        let settings = views.first().filter(|_| entry.has_modes).map(|view| &view.shadows);
        settings.into_iter().for_each(|settings| scene.set_shadow_modes(settings.shadow_modes()));
        let technique = self.registry.techniques.find(&entry.technique)?;
        let config = RenderConfig {
            technique: Some(technique),
            pipeline: self.pipeline(&entry.pipeline)?,
            samples: entry.samples,
            background: entry.background,
            culling: entry.culling,
        };
        let aov: Aov = entry.aov.parse().map_err(|error: OptionError| Error::Recorded(error.to_string()))?;
        Renderer::at_origin(gpu, scene, origin_near(entry.origin_world), aov, config)
    }

    fn pipeline(&self, entry: &PipelineEntry) -> Result<Pipeline, Error> {
        let PipelineEntry { name, text, parameters } = entry;
        let Registry { techniques, nodes } = &self.registry;
        let parameters = Parameters(parameters.clone());
        Ok(match text {
            None => Pipeline::built_in(name, &parameters)?,
            Some(text) => Pipeline::from_text(name, text, nodes, techniques, &parameters)?,
        })
    }

    /// Returns the views of a frame. What entries leave out is as in the frame before.
    fn views(&self, entries: &[ViewEntry], known: &[ViewOptions]) -> Result<Vec<ViewOptions>, Error> {
        let view = |(index, entry): (usize, &ViewEntry)| {
            let known = known.get(index);
            let missing = || Error::Recorded("a new view without camera, size_px or settings".into());
            let shadows = match &entry.settings {
                Some(text) => self.settings(text)?,
                None => known.ok_or_else(missing)?.shadows.clone(),
            };
            let camera =
                entry.camera.as_ref().or(known.map(|view| &view.camera)).ok_or_else(missing)?.clone();
            let size_px = entry.size_px.or(known.map(|view| view.size_px)).ok_or_else(missing)?;
            Ok(ViewOptions { camera, size_px, shadows })
        };
        entries.iter().enumerate().map(view).collect()
    }

    fn settings(&self, text: &str) -> Result<ShadowSettings, Error> {
        let settings: ShadowSettings =
            ron::from_str(text).map_err(|error| Error::Recorded(format!("settings: {error}")))?;
        settings.validate()?;
        self.registry.techniques.check(&settings)?;
        Ok(settings)
    }
}

/// Draws a frame without looking at it.
fn draw(renderer: &mut Renderer, gpu: &Gpu, views: &[ViewOptions]) -> Result<(), Error> {
    match views {
        [view] => renderer.draw(gpu, view).map(drop),
        views => renderer.draw_views(gpu, views).map(drop),
    }
}
