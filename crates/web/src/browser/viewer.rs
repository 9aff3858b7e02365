//! The viewer of a page, for JavaScript.

use std::cell::{Ref, RefCell, RefMut};
use std::rc::Rc;
use std::sync::Arc;

use js_sys::{Promise, Uint8ClampedArray};
use serde_json::json;
use shadowgraph::core::{self, PassTime, Plan, Timer};
use shadowgraph::inspect::HtmlPage;
use shadowgraph::shadows::Techniques;
use shadowgraph::{FrameCounts, PendingCounts, Pipeline, pipelines, wgpu};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen_futures::future_to_promise;
use web_sys::HtmlCanvasElement;

use super::canvas::Canvas;
use super::{pixels, thrown};
use crate::error::Error;
use crate::model::Model;
use crate::stage::Stage;

/// Shows a model on a canvas.
#[wasm_bindgen]
pub struct Viewer {
    state: Rc<RefCell<State>>,
}

struct State {
    canvas: Canvas,
    stage: Stage,
    /// The image of each technique.
    images: Vec<wgpu::Texture>,
    /// The part of the canvas that shows the first technique, from the left, 0 to 1.
    split: f64,
    measures: bool,
    /// The frame that is measured, until its times have arrived.
    pending: Option<(Timer, PendingCounts)>,
    measured: Measured,
}

/// The last frame, with the times of the last one that was measured.
#[derive(Default)]
struct Measured {
    plan: Option<Arc<Plan>>,
    times: Vec<PassTime>,
    counts: FrameCounts,
}

#[wasm_bindgen]
impl Viewer {
    /// Opens a device for a canvas, and shows the built-in demo scene.
    ///
    /// # Errors
    /// For a browser or a machine without WebGPU.
    pub async fn create(canvas: HtmlCanvasElement) -> Result<Viewer, JsValue> {
        let canvas = Canvas::open(canvas).await.map_err(thrown)?;
        let state = State {
            stage: Stage::new(Model::demo_scene(), canvas.aspect()),
            canvas,
            images: Vec::new(),
            split: 0.5,
            measures: false,
            pending: None,
            measured: Measured::default(),
        };
        Ok(Self { state: Rc::new(RefCell::new(state)) })
    }

    /// Shows a model from its first camera; without one, from where all of it is visible. The model can be shown again.
    pub fn show(&self, model: &Model) {
        let mut state = self.borrow_mut();
        let aspect = state.canvas.aspect();
        state.stage.show(model.clone(), aspect);
    }

    /// Draws a frame at a moment of the model's animations, seconds.
    ///
    /// # Errors
    /// One line, such as about a technique and a pipeline that do not fit; the canvas keeps its image. For a lost device, which
    /// `recover` replaces.
    pub fn draw(&self, time_s: f64) -> Result<(), JsValue> {
        self.borrow_mut().draw(time_s).map_err(thrown)
    }

    /// Returns a promise that is kept when all frames so far are drawn. Wait for it where frames may take long, so that they do not queue up.
    pub fn finished(&self) -> Promise {
        let queue = self.borrow().canvas.gpu().queue.clone();
        Promise::new(&mut |resolve, _| {
            queue.on_submitted_work_done(move || {
                let _result = resolve.call0(&JsValue::NULL);
            });
        })
    }

    /// Returns a promise of the pixels of the canvas as it was drawn last: `Uint8ClampedArray`, RGBA, from the top left.
    pub fn pixels(&self) -> Promise {
        let state = self.borrow();
        let reads = state.images.iter().map(|image| pixels::read(state.canvas.gpu(), image));
        let reads: Result<Vec<_>, _> = reads.collect();
        let width = state.images.first().map_or(0, wgpu::Texture::width);
        let split = state.split_px(width);
        future_to_promise(async move {
            let mut images = Vec::new();
            for read in reads.map_err(thrown)? {
                images.push(read.await.map_err(thrown)?);
            }
            let mut images = images.into_iter();
            let first = images.next().ok_or_else(|| thrown(Error::Pixels("nothing is drawn".into())))?;
            let joined = match images.next() {
                Some(second) => pixels::join(first, &second, width, split),
                None => first,
            };
            Ok(Uint8ClampedArray::from(&joined[..]).into())
        })
    }

    /// Changes width and height of the canvas, pixels, within the limits of the device.
    pub fn resize(&self, width: u32, height: u32) {
        self.borrow_mut().canvas.resize([width, height]);
    }

    /// Returns the technique.
    #[wasm_bindgen(getter)]
    pub fn technique(&self) -> String {
        self.borrow().stage.technique()
    }

    /// Chooses the technique by name, such as `pcss+contact`.
    ///
    /// # Errors
    /// For an unknown name: the known ones.
    #[wasm_bindgen(setter)]
    pub fn set_technique(&self, name: &str) -> Result<(), JsValue> {
        self.borrow_mut().stage.set_technique(name).map_err(thrown)
    }

    /// Returns the technique on the right side of a comparison.
    #[wasm_bindgen(getter)]
    pub fn compared(&self) -> Option<String> {
        self.borrow().stage.compared()
    }

    /// Chooses a technique that is drawn on the right side, in comparison to the first; `undefined` ends the comparison.
    ///
    /// # Errors
    /// For an unknown name: the known ones.
    #[wasm_bindgen(setter)]
    pub fn set_compared(&self, name: Option<String>) -> Result<(), JsValue> {
        self.borrow_mut().stage.compare_with(name.as_deref()).map_err(thrown)
    }

    /// Sets where the comparison splits the canvas: a part of its width, 0 to 1. The canvas shows it at once, without another frame.
    pub fn split(&self, part: f64) {
        let mut state = self.borrow_mut();
        state.split = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 };
        if state.images.len() > 1 && state.canvas.lost().is_none() {
            let encoder = state.canvas.gpu().device.create_command_encoder(&Default::default());
            state.show_images(encoder);
        }
    }

    /// Returns the name of the pipeline.
    #[wasm_bindgen(getter)]
    pub fn pipeline(&self) -> String {
        self.borrow().stage.pipeline().name().into()
    }

    /// Chooses a built-in pipeline by name.
    ///
    /// # Errors
    /// For an unknown name: the known ones.
    #[wasm_bindgen(setter)]
    pub fn set_pipeline(&self, name: &str) -> Result<(), JsValue> {
        self.borrow_mut().stage.set_pipeline(name).map_err(thrown)
    }

    /// Chooses a pipeline by the text of its file, which errors call `name`. Returns the warnings about it.
    ///
    /// # Errors
    /// For an invalid file: line and column, and what is expected. The pipeline stays as it was.
    #[wasm_bindgen(js_name = setPipelineText)]
    pub fn set_pipeline_text(&self, name: &str, text: &str) -> Result<Vec<String>, JsValue> {
        self.borrow_mut().stage.set_pipeline_text(name, text).map_err(thrown)
    }

    /// Chooses the shadow settings: JSON of those that differ from their defaults. Without `distance_m` the shadow distance is as far as the
    /// visible part of the scene reaches.
    ///
    /// # Errors
    /// For an unknown setting or a value out of range, with the range. The settings stay as they were.
    #[wasm_bindgen(js_name = setSettings)]
    pub fn set_settings(&self, json: &str) -> Result<(), JsValue> {
        self.borrow_mut().stage.set_settings(json).map_err(thrown)
    }

    /// Turns the camera around the point that it looks at: to the left and upwards, radians.
    pub fn turn(&self, left: f64, up: f64) {
        self.borrow_mut().stage.orbit.turn(left, up);
    }

    /// Moves the camera and the point that it looks at: to the right, upwards and ahead, as fractions of the distance between them.
    pub fn shift(&self, right: f64, up: f64, ahead: f64) {
        self.borrow_mut().stage.orbit.shift(right, up, ahead);
    }

    /// Multiplies the distance between the camera and the point that it looks at.
    pub fn zoom(&self, factor: f64) {
        self.borrow_mut().stage.orbit.zoom(factor);
    }

    /// Returns how long the animations of the model are, seconds; 0 without any.
    #[wasm_bindgen(getter)]
    pub fn duration(&self) -> f64 {
        self.borrow().stage.duration_s()
    }

    /// Chooses whether the passes of frames are measured, for `times`.
    pub fn measure(&self, on: bool) {
        self.borrow_mut().measures = on;
    }

    /// Returns JSON of the passes of the last measured frame, in order: an array of `pass`, `node`, `draws`, `cpu_ms`, and `gpu_ms`,
    /// which is `null` where the browser measures no times.
    #[must_use]
    pub fn times(&self) -> String {
        let state = self.borrow();
        let times = state.measured.times.iter().map(|time| {
            json!({
                "pass": time.pass, "node": time.node, "cpu_ms": time.cpu_ms, "gpu_ms": time.gpu_share_ms(), "draws": time.draws,
            })
        });
        serde_json::Value::Array(times.collect()).to_string()
    }

    /// Returns the HTML page about the last frame: its graph, its passes with their times, and the reason for each decision.
    #[wasm_bindgen(js_name = graphPage)]
    #[must_use]
    pub fn graph_page(&self) -> String {
        let state = self.borrow();
        let Measured { plan: Some(plan), times, counts } = &state.measured else { return String::new() };
        let mut page = HtmlPage::new(plan).with_times(times).with_title(state.stage.pipeline().name());
        page.notes.extend(counts.shadow_warning.clone());
        page.to_html()
    }

    /// Returns what this browser lacks, and what that changes, a line each.
    #[must_use]
    pub fn lacks(&self) -> Vec<String> {
        super::lacks::missing_in(self.borrow().canvas.adapter())
    }

    /// Returns why the device is lost, such as after a crash of the driver; `undefined` while it is not.
    #[must_use]
    pub fn lost(&self) -> Option<String> {
        self.borrow().canvas.lost()
    }

    /// Returns the first error of the GPU that the browser has reported since the last call.
    #[wasm_bindgen(js_name = takeError)]
    pub fn take_error(&self) -> Option<String> {
        self.borrow().canvas.take_error()
    }

    /// Opens another device after a loss. Model, camera and choices stay.
    pub fn recover(&self) -> Promise {
        let (state, opening) = (self.state.clone(), self.borrow().canvas.reopen());
        future_to_promise(async move {
            let canvas = opening.await.map_err(thrown)?;
            let mut state = state.borrow_mut();
            (state.canvas, state.images, state.pending) = (canvas, Vec::new(), None);
            state.stage.forget_renderers();
            Ok(JsValue::UNDEFINED)
        })
    }

    /// Gives the memory of the GPU back; `recover` opens a device again.
    pub fn release(&self) {
        self.borrow().canvas.gpu().device.destroy();
    }
}

/// What a page can choose from.
#[wasm_bindgen]
impl Viewer {
    /// Returns JSON of the techniques, and of the modifiers that can be added to their names: `{"techniques": [{"name", "summary"}], "modifiers": [..]}`.
    #[must_use]
    pub fn techniques() -> String {
        let techniques = Techniques::built_in();
        let kinds =
            techniques.kinds().iter().map(|kind| json!({ "name": kind.name, "summary": kind.summary }));
        let modifiers = Techniques::modifiers();
        let modifiers = modifiers.map(|kind| json!({ "name": kind.name, "summary": kind.summary }));
        json!({ "techniques": kinds.collect::<Vec<_>>(), "modifiers": modifiers.collect::<Vec<_>>() })
            .to_string()
    }

    /// Returns the names of the built-in pipelines.
    #[must_use]
    pub fn pipelines() -> Vec<String> {
        pipelines::BUILT_IN.iter().map(|&name| name.to_owned()).collect()
    }

    /// Returns the text of a built-in pipeline's file.
    #[wasm_bindgen(js_name = pipelineText)]
    #[must_use]
    pub fn pipeline_text(name: &str) -> Option<String> {
        Pipeline::built_in_text(name).map(str::to_owned)
    }

    /// Returns the JSON Schema of the shadow settings, with descriptions, ranges and defaults.
    #[wasm_bindgen(js_name = settingsSchema)]
    #[must_use]
    pub fn settings_schema() -> String {
        Techniques::built_in().settings_schema().to_string()
    }
}

impl Viewer {
    fn borrow(&self) -> Ref<'_, State> {
        self.state.borrow()
    }

    fn borrow_mut(&self) -> RefMut<'_, State> {
        self.state.borrow_mut()
    }
}

impl State {
    fn draw(&mut self, time_s: f64) -> Result<(), Error> {
        if self.canvas.lost().is_some() {
            return Err(shadowgraph::Error::from(core::Error::DeviceLost).into());
        }
        self.read_times()?;
        self.stage.set_time(time_s)?;
        let size_px = self.canvas.size_px();
        self.images.truncate(self.stage.image_count());
        self.images.retain(|image| [image.width(), image.height()] == size_px);
        while self.images.len() < self.stage.image_count() {
            self.images.push(self.canvas.image());
        }
        let gpu = self.canvas.gpu();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut timer = (self.measures && self.pending.is_none()).then(Timer::new);
        let mut counts = None;
        for (index, image) in self.images.iter().enumerate() {
            // Of a comparison, the first technique is measured.
            let timer = timer.as_mut().filter(|_| index == 0);
            let recorded = self.stage.record(gpu, &mut encoder, index, image, timer)?;
            if index == 0 {
                self.measured.plan = Some(recorded.plan);
                counts = recorded.counts;
            }
        }
        self.pending = timer.zip(counts).or(self.pending.take());
        self.show_images(encoder);
        Ok(())
    }

    /// Submits an encoder, and shows the images.
    fn show_images(&self, encoder: wgpu::CommandEncoder) {
        let width = self.images.first().map_or(0, wgpu::Texture::width);
        let split = if self.images.len() > 1 { self.split_px(width) } else { width };
        let columns = [0..split, split..width];
        let parts: Vec<_> = self.images.iter().zip(columns).collect();
        self.canvas.show(encoder, &parts);
    }

    /// Takes the times of the measured frame, if they have arrived.
    fn read_times(&mut self) -> Result<(), Error> {
        let is_ready = |(timer, counts): &mut (Timer, PendingCounts)| timer.is_ready() && counts.is_ready();
        if let Some((mut timer, counts)) = self.pending.take_if(is_ready) {
            let gpu = self.canvas.gpu();
            self.measured.times = timer.read(&gpu.device, &gpu.queue).map_err(shadowgraph::Error::from)?;
            self.measured.counts = counts.wait(&gpu.device)?;
        }
        Ok(())
    }

    /// Returns the first column of an image of this width that shows the second technique.
    fn split_px(&self, width: u32) -> u32 {
        (self.split * f64::from(width)).round() as u32
    }
}
