//! Recording.

use glam::DVec3;
use serde_json::Value;
use shadowgraph_scene::{Camera, Changes, Scene};
use shadowgraph_shadows::ShadowSettings;

use super::entry::{
    FORMAT, FrameEntry, Header, PipelineEntry, RendererEntry, SceneEdits, SceneSummary, VERSION, ViewEntry,
};
use super::scene::KnownScene;
use crate::options::aov::Aov;
use crate::pipelines::pipeline::PipelineSource;
use crate::render_config::RenderConfig;
use crate::shadow_lines::ShadowLines;
use crate::view_options::ViewOptions;

/// Records what renderers are given for their frames: see [`Renderer::set_recorder`](crate::Renderer::set_recorder).
///
/// It ends by itself, with a [reason](Self::ended_because), where it reaches its limit of memory, and where something changes that recordings
/// do not have: inserted and removed meshes, materials, images and instances, edited meshes and images, a replaced scene, and frames of
/// pipelines that are scripts. The frames before stay.
#[derive(Clone)]
pub struct Recorder {
    /// The lines of the file.
    lines: String,
    frame_count: usize,
    limit_bytes: usize,
    known: KnownScene,
    /// The next frame, as far as it is known.
    pending: Pending,
    /// The views of the last frame.
    views: Vec<KnownView>,
    ended: Option<&'static str>,
}

/// What a recorder reads of a renderer.
pub(crate) struct RendererState<'r> {
    pub(crate) scene: &'r Scene,
    pub(crate) config: &'r RenderConfig,
    pub(crate) aov: &'r Aov,
    pub(crate) origin_world: DVec3,
    pub(crate) shadow_camera: Option<&'r Camera>,
    pub(crate) overlay: Option<ShadowLines>,
}

#[derive(Clone, Default)]
struct Pending {
    renderer: Option<RendererEntry>,
    edits: SceneEdits,
}

#[derive(Clone)]
struct KnownView {
    camera: Camera,
    size_px: [u32; 2],
    settings: ShadowSettings,
}

impl Recorder {
    /// Creates a recorder for a scene as the program can load it again; edits since then are recorded. `source` says how, in the program's own
    /// terms: it is returned by [`Recording::source`](super::Recording::source). The recording takes at most `limit_mib` MiB.
    pub fn new(scene: &Scene, source: Value, limit_mib: u32) -> Self {
        let scene_summary = SceneSummary::new(scene);
        let header = Header { format: FORMAT.into(), version: VERSION, source, scene: scene_summary };
        let mut recorder = Self {
            lines: String::new(),
            frame_count: 0,
            limit_bytes: (limit_mib as usize) << 20,
            known: KnownScene::new(scene),
            pending: Pending::default(),
            views: Vec::new(),
            ended: None,
        };
        recorder.write(&header);
        recorder
    }

    /// Returns the number of recorded frames.
    pub fn frame_count(&self) -> usize {
        self.frame_count
    }

    /// Returns why the recording has ended before the last frame, if it has.
    pub fn ended_because(&self) -> Option<&'static str> {
        self.ended
    }

    /// Returns the contents of the file, to be written with [`write_text`](crate::output::write_text) and read by
    /// [`Recording::load`](super::Recording::load).
    pub fn text(&self) -> &str {
        &self.lines
    }

    pub(crate) fn end(&mut self, reason: &'static str) {
        self.ended.get_or_insert(reason);
    }

    /// Begins to record a renderer that has drawn nothing yet.
    pub(crate) fn begin_renderer(&mut self, renderer: &RendererState<'_>) {
        let RendererState { scene, config, .. } = *renderer;
        let pipeline = match config.pipeline.source() {
            PipelineSource::BuiltIn { name, parameters } => {
                PipelineEntry { name: name.into(), text: None, parameters: parameters.0.clone() }
            }
            PipelineSource::File { name, text, parameters } => {
                PipelineEntry { name: name.into(), text: Some(text.into()), parameters: parameters.0.clone() }
            }
            PipelineSource::Script => return self.end("the pipeline is a script"),
        };
        match self.known.follow_all(scene) {
            Ok(edits) => {
                let (materials, objects) = scene.shadow_modes();
                self.pending = Pending::default();
                self.pending.renderer = Some(RendererEntry {
                    edits,
                    has_modes: !materials.0.is_empty() || !objects.0.is_empty(),
                    origin_world: renderer.origin_world,
                    aov: renderer.aov.to_string(),
                    technique: config.technique().name(),
                    pipeline,
                    samples: config.samples,
                    background: config.background,
                    culling: config.culling,
                });
            }
            Err(reason) => self.end(reason),
        }
    }

    /// Records edits that the next frame follows.
    pub(crate) fn follow(&mut self, scene: &Scene, changes: &Changes) {
        if self.ended.is_some() {
            return;
        }
        if !changes.meshes.is_empty() || !changes.images.is_empty() {
            return self.end("meshes or images were edited");
        }
        match self.known.follow(scene, &changes.instances, &changes.materials) {
            Ok(edits) => {
                let pending = &mut self.pending.edits;
                pending.instances.extend(edits.instances);
                pending.materials.extend(edits.materials);
                if edits.all_lights.is_some() {
                    (pending.lights, pending.all_lights) = (Vec::new(), edits.all_lights);
                }
                pending.lights.extend(edits.lights);
            }
            Err(reason) => self.end(reason),
        }
    }

    /// Records a frame.
    pub(crate) fn add_frame(&mut self, renderer: &RendererState<'_>, views: &[&ViewOptions]) {
        if self.ended.is_some() {
            return;
        }
        let Some(views) = self.view_entries(views) else {
            return self.end("settings cannot be written as RON");
        };
        let Pending { renderer: new_renderer, edits } = std::mem::take(&mut self.pending);
        let entry = FrameEntry {
            renderer: new_renderer,
            edits,
            ground: renderer.scene.ground.map(|ground| ground.height_world),
            shadow_camera: renderer.shadow_camera.cloned(),
            overlay: renderer.overlay,
            views,
        };
        self.write(&entry);
        self.frame_count += usize::from(self.ended.is_none());
    }

    /// Returns what differs in views from those of the last frame, which they become.
    fn view_entries(&mut self, views: &[&ViewOptions]) -> Option<Vec<ViewEntry>> {
        let mut entries = Vec::new();
        for (index, view) in views.iter().enumerate() {
            let ViewOptions { camera, size_px, shadows } = view;
            let last = self.views.get(index);
            let differs =
                |differs: fn(&KnownView, &ViewOptions) -> bool| last.is_none_or(|last| differs(last, view));
            let settings =
                differs(|last, view| last.settings != view.shadows).then(|| ron::to_string(shadows));
            entries.push(ViewEntry {
                camera: differs(|last, view| last.camera != view.camera).then(|| camera.clone()),
                size_px: differs(|last, view| last.size_px != view.size_px).then_some(*size_px),
                settings: settings.transpose().ok()?,
            });
        }
        let known = |view: &&ViewOptions| KnownView {
            camera: view.camera.clone(),
            size_px: view.size_px,
            settings: view.shadows.clone(),
        };
        self.views = views.iter().map(known).collect();
        Some(entries)
    }

    /// Adds a line, or ends where that is not possible.
    fn write(&mut self, value: &impl serde::Serialize) {
        match ron::to_string(value) {
            Ok(line) if self.lines.len() + line.len() < self.limit_bytes => {
                self.lines.push_str(&line);
                self.lines.push('\n');
            }
            Ok(_) => self.end("the limit of its memory is reached"),
            Err(_) => self.end("a value cannot be written as RON"),
        }
    }
}
