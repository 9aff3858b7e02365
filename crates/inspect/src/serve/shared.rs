//! What the program's thread and those of pages share. Locks are held for copies of pointers only.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use shadowgraph_core::{PassTime, PendingTexture, Plan, WatchedTexture, wgpu};

use super::controls::Controls;
use super::request::PageRequest;
use crate::html::{HtmlPage, LivePage, snapshot_json};
use crate::pixel::PixelHistory;

/// Plans that can be looked at after others have followed.
const PLANS: usize = 32;
/// Frames in the strip of times.
const FRAMES: usize = 600;
/// Requests that the program has not taken yet; more are refused.
const REQUESTS: usize = 64;

/// The number of a plan among those of the program, from 1.
pub(super) type PlanNumber = u32;

/// The watched texture of a frame, and the plan of the frame.
pub(super) struct WatchedFrame {
    pub(super) texture: PendingTexture,
    pub(super) plan: Arc<Plan>,
    pub(super) device: wgpu::Device,
}

/// A frame in the strip of times.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Tick {
    pub(super) number: u64,
    /// Milliseconds since the frame before.
    pub(super) interval_ms: f64,
    pub(super) bytes: u64,
    pub(super) plan: PlanNumber,
}

pub(super) struct Shared {
    token: String,
    title: String,
    is_stopped: AtomicBool,
    viewers: AtomicUsize,
    has_requests: AtomicBool,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// The plan of the last frame.
    last: Option<Arc<Plan>>,
    /// The plans that pages have seen.
    plans: VecDeque<(PlanNumber, Arc<Plan>)>,
    plan_count: PlanNumber,
    ticks: VecDeque<Tick>,
    times: Arc<Vec<PassTime>>,
    watch: Option<WatchedTexture>,
    controls: Controls,
    requests: VecDeque<PageRequest>,
    /// Messages that replace earlier ones of their kind, with the number of changes: controls, texture, pixel.
    controls_message: Message,
    texture: Message,
    pixel: Message,
}

impl State {
    /// Returns the number of the plan of the last frame, a new one unless an earlier plan is equal; 0 before there is one.
    fn number_last_plan(&mut self) -> PlanNumber {
        let Some(last) = &self.last else { return 0 };
        // Programs alternate between few plans, such as those with and without a map that is kept.
        if let Some((number, _)) = self.plans.iter().find(|(_, known)| known.has_structure_of(last)) {
            return *number;
        }
        self.plan_count += 1;
        self.plans.push_back((self.plan_count, last.clone()));
        if self.plans.len() > PLANS {
            self.plans.pop_front();
        }
        self.plan_count
    }
}

/// A message to pages that only the newest one of matters.
#[derive(Clone, Default)]
pub(super) struct Message {
    pub(super) change: u64,
    pub(super) json: Arc<str>,
}

impl Message {
    fn replace(&mut self, json: String) {
        *self = Self { change: self.change + 1, json: json.into() };
    }
}

/// What a page has not seen yet.
pub(super) struct News {
    pub(super) ticks: Vec<Tick>,
    /// Of the last frame.
    pub(super) times: Arc<Vec<PassTime>>,
    /// Controls, texture and pixel.
    pub(super) messages: [Message; 3],
}

impl Shared {
    pub(super) fn new(token: String, title: &str) -> Self {
        let shared = Self {
            token,
            title: title.into(),
            is_stopped: AtomicBool::new(false),
            viewers: AtomicUsize::new(0),
            has_requests: AtomicBool::new(false),
            state: Mutex::default(),
        };
        shared.offer(Controls::default());
        shared
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn token(&self) -> &str {
        &self.token
    }

    pub(super) fn stop(&self) {
        self.is_stopped.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    pub(super) fn viewers(&self) -> usize {
        self.viewers.load(Ordering::Relaxed)
    }

    pub(super) fn count_viewer(&self, is_new: bool) {
        if is_new {
            self.viewers.fetch_add(1, Ordering::Relaxed);
        } else if self.viewers.fetch_sub(1, Ordering::Relaxed) == 1 {
            let mut state = self.state();
            (state.watch, state.ticks) = (None, VecDeque::new());
        }
    }

    pub(super) fn offer(&self, controls: Controls) {
        let mut state = self.state();
        if state.controls != controls || state.controls_message.change == 0 {
            state.controls_message.replace(serde_json::json!({ "controls": controls }).to_string());
            state.controls = controls;
        }
    }

    pub(super) fn take_requests(&self) -> Vec<PageRequest> {
        match self.has_requests.swap(false, Ordering::Relaxed) {
            true => self.state().requests.drain(..).collect(),
            false => Vec::new(),
        }
    }

    /// Takes what a page asks for.
    ///
    /// # Errors
    /// For what is not offered, with the reason in words for the page.
    pub(super) fn request(&self, request: PageRequest) -> Result<(), String> {
        let mut state = self.state();
        request.check(&state.controls)?;
        if state.requests.len() >= REQUESTS {
            return Err("the program does not answer".into());
        }
        state.requests.push_back(request);
        self.has_requests.store(true, Ordering::Relaxed);
        Ok(())
    }

    pub(super) fn watch(&self) -> Option<WatchedTexture> {
        self.state().watch.clone()
    }

    pub(super) fn set_watch(&self, watch: Option<WatchedTexture>) {
        self.state().watch = watch;
    }

    /// Sets the plan of the last frame.
    pub(super) fn set_last_plan(&self, plan: Arc<Plan>) {
        self.state().last = Some(plan);
    }

    /// Returns the number of the plan of the last frame; 0 before there is one.
    pub(super) fn number_last_plan(&self) -> PlanNumber {
        self.state().number_last_plan()
    }

    pub(super) fn add_frame(&self, tick: Tick, times: &[PassTime]) {
        let times = Arc::new(times.to_vec());
        let mut state = self.state();
        state.ticks.push_back(tick);
        if state.ticks.len() > FRAMES {
            state.ticks.pop_front();
        }
        state.times = times;
    }

    pub(super) fn set_pixel(&self, history: &PixelHistory, shadows: &str) {
        let text = history.to_text();
        let message = serde_json::json!({ "pixel": history, "text": text, "shadows": shadows }).to_string();
        self.state().pixel.replace(message);
    }

    pub(super) fn set_texture(&self, arrived: WatchedFrame) {
        let WatchedFrame { texture, plan, device } = arrived;
        let Ok(snapshot) = texture.wait(&device) else { return };
        let message = format!("{{\"texture\":{}}}", snapshot_json(&plan, &snapshot));
        self.state().texture.replace(message);
    }

    /// Returns the messages, and the frames after one, if they are wanted.
    pub(super) fn news(&self, after: Option<u64>) -> News {
        let state = self.state();
        let is_new = |tick: &&Tick| after.is_some_and(|frame| tick.number > frame);
        let ticks = state.ticks.iter().filter(is_new).copied().collect();
        let messages = [&state.controls_message, &state.texture, &state.pixel].map(Clone::clone);
        News { ticks, times: state.times.clone(), messages }
    }

    /// Returns the page of a plan, or of the last one; `None` for a plan that is not known any more.
    pub(super) fn page(&self, number: Option<PlanNumber>) -> Option<String> {
        let (plan, times, live) = {
            let mut state = self.state();
            let wanted = number.unwrap_or_else(|| state.number_last_plan());
            let (_, plan) = state.plans.iter().find(|(known, _)| *known == wanted)?;
            (plan.clone(), state.times.clone(), LivePage { plan: wanted })
        };
        let times: &[PassTime] = if times.len() == plan.order().len() { &times } else { &[] };
        Some(HtmlPage::new(&plan).with_title(&self.title).with_times(times).with_live(live).to_html())
    }
}
