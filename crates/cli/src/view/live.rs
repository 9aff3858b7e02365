//! The page about the window's frames: `--serve`.

use shadowgraph::core::{Executed, Graph, PassTime};
use shadowgraph::inspect::{Controls, FrameReport, Offered, OfferedValue, PageRequest, PixelHistory, Server};
use shadowgraph::shadows::Technique;
use shadowgraph::{Gpu, Registry};

/// The names of the settings on the page.
const TECHNIQUE: &str = "technique";
const DISTANCE: &str = "shadow distance, m";

/// Seconds that a step advances.
const STEP_S: f64 = 1.0 / 60.0;

/// What the page can change.
pub(super) struct Adjustable<'s> {
    pub(super) technique: &'s mut Technique,
    pub(super) distance_m: &'s mut f32,
    /// Whether frames are recorded, which the page can have saved.
    pub(super) is_recording: bool,
}

/// The server of the page, and the requests of pages that wait.
pub(super) struct Live {
    server: Server,
    is_frozen: bool,
    /// Steps to take while it is frozen.
    steps: u32,
    /// The pixel whose history is wanted.
    pixel: Option<[u32; 2]>,
    /// Whether the recording is to be saved.
    saves_recording: bool,
}

impl Live {
    pub(super) fn new(server: Server) -> Self {
        Self { server, is_frozen: false, steps: 0, pixel: None, saves_recording: false }
    }

    /// Returns the seconds by which the scene advances in a frame that took some.
    pub(super) fn advance(&mut self, seconds: f64) -> f64 {
        match (self.is_frozen, self.steps) {
            (false, _) => seconds,
            (true, 0) => 0.0,
            (true, _) => {
                self.steps -= 1;
                STEP_S
            }
        }
    }

    /// Follows the requests of pages, and offers what they can change.
    pub(super) fn update(&mut self, adjustable: &mut Adjustable<'_>, registry: &Registry) {
        for request in self.server.take_requests() {
            match request {
                PageRequest::Freeze(freeze) => (self.is_frozen, self.steps) = (freeze, 0),
                PageRequest::Step => (self.is_frozen, self.steps) = (true, self.steps + 1),
                PageRequest::SaveRecording => self.saves_recording = true,
                PageRequest::Pixel(pixel) => self.pixel = Some(pixel),
                PageRequest::Choose { value, .. } => {
                    if let Ok(technique) = registry.techniques.find(&value) {
                        *adjustable.technique = technique;
                    }
                }
                PageRequest::Set { value, .. } => *adjustable.distance_m = value as f32,
            }
        }
        let chosen = adjustable.technique.name();
        let mut all: Vec<String> =
            registry.techniques.kinds().iter().map(|kind| kind.name.to_string()).collect();
        if !all.contains(&chosen) {
            all.push(chosen.clone());
        }
        let technique = OfferedValue::Choice { chosen, all };
        let value = f64::from(*adjustable.distance_m);
        let distance = OfferedValue::Number { value, min: 1.0, max: 10_000.0 };
        self.server.offer(Controls {
            freeze: Some(self.is_frozen),
            save_recording: adjustable.is_recording,
            pixel: true,
            settings: vec![
                Offered { name: TECHNIQUE.into(), value: technique },
                Offered { name: DISTANCE.into(), value: distance },
            ],
        });
    }

    /// Returns the pixel whose history is wanted, once.
    pub(super) fn take_pixel(&mut self) -> Option<[u32; 2]> {
        self.pixel.take()
    }

    /// Returns whether the recording is to be saved, once.
    pub(super) fn takes_recording(&mut self) -> bool {
        std::mem::take(&mut self.saves_recording)
    }

    pub(super) fn answer_pixel(&mut self, history: &PixelHistory, shadows: &str) {
        self.server.answer_pixel(history, shadows);
    }

    pub(super) fn begin_frame(&mut self, graph: &mut Graph) {
        self.server.begin_frame(graph);
    }

    pub(super) fn end_frame(&mut self, gpu: &Gpu, executed: &mut Executed, times: &[PassTime], bytes: u64) {
        self.server.end_frame(&gpu.device, executed, &FrameReport { times, bytes });
    }
}
