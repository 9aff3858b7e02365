//! The controller: when the level changes.

use super::config::{BudgetConfig, QualityLevel};
use super::lowering::lowered;
use crate::error::Error;
use crate::settings::ShadowSettings;

/// The part of the budget that a better level is expected to need when the quality is raised. Two medians with noise of
/// 10 % each are off by a factor of 0.9 / 1.1 together: what was over the budget is not expected to fit.
const HEADROOM: f64 = 0.8;

/// Times are clamped to within this factor of the budget: below that, timer noise would dominate.
const TIME_RANGE: f64 = 100.0;

/// Number of frames in a median. Up to 4 slow ones among them change nothing.
const WINDOW: usize = 9;

/// Number of frames that are skipped after a change of level: they were in flight already, or drew its maps for the first time.
const LATENCY: usize = 3;

/// The cost ratio that is assumed for a level until more is known.
const DEFAULT_RATIO: f64 = 2.0;

/// The first wait before the quality is raised, frames.
const FIRST_WAIT: u64 = 8 * WINDOW as u64;

/// The longest wait before the quality is raised, frames. A step up that held for as long counts as a success.
const LONGEST_WAIT: u64 = 256 * WINDOW as u64;

/// The scene has changed if the median of one level grows or shrinks by more than this factor.
const CHANGE: f64 = 2.0;

/// Lowers the quality of shadows while they take longer than a budget, and raises it again.
///
/// It begins at the best level, and its decisions depend only on the times that it is given. While each level has a constant
/// cost with noise of up to 10 %, it settles at the best level that fits.
///
/// ```
/// use shadowgraph_shadows::{BudgetConfig, QualityController, ShadowSettings};
/// let chosen = ShadowSettings::default();
/// let mut controller = QualityController::new(BudgetConfig { budget_ms: 1.5, ..BudgetConfig::default() })?;
/// let mut settings = chosen.clone();
/// // Once a frame, with the time of the shadow passes of the newest frame that the GPU has finished:
/// for measured_ms in [1.8; 12] {
///     if controller.update(measured_ms) {
///         settings = controller.apply(&chosen);
///     }
/// }
/// assert_eq!(controller.level(), 1);
/// assert!(settings.distance_m < chosen.distance_m);
/// # Ok::<(), shadowgraph_shadows::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct QualityController {
    config: BudgetConfig,
    level: usize,
    window: Window,
    /// One for each level but the last.
    steps: Vec<Step>,
    /// Number of times that it was given.
    frame: u64,
    /// The frame of the last step down.
    lowered_at: u64,
    /// The median before the last step down, until the new level is measured.
    median_before_ms: Option<f64>,
    /// The first median since the level changed.
    first_ms: Option<f64>,
}

impl QualityController {
    /// Creates a controller at the best level.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] if a value of the configuration is out of its range.
    pub fn new(config: BudgetConfig) -> Result<Self, Error> {
        config.validate()?;
        Ok(Self {
            level: 0,
            window: Window::new(),
            steps: vec![Step::new(); config.levels.len() - 1],
            frame: 0,
            lowered_at: 0,
            median_before_ms: None,
            first_ms: None,
            config,
        })
    }

    /// Adds the time that the shadow passes of a finished frame took, milliseconds, 0 or more, and returns whether the level
    /// changed. Call it once a frame; negative values and values that are not finite are ignored.
    pub fn update(&mut self, measured_ms: f64) -> bool {
        if !(measured_ms.is_finite() && measured_ms >= 0.0) {
            return false;
        }
        let budget_ms = self.config.budget_ms;
        self.frame += 1;
        self.window.push(measured_ms.clamp(budget_ms / TIME_RANGE, budget_ms * TIME_RANGE));
        let Some(median_ms) = self.window.median_ms() else { return false };
        self.observe(median_ms);
        if median_ms > budget_ms { self.lower(median_ms) } else { self.raise(median_ms) }
    }

    /// Returns the index of the current level, 0 the best.
    #[must_use]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Returns the current level.
    #[must_use]
    pub fn quality(&self) -> &QualityLevel {
        &self.config.levels[self.level]
    }

    /// Returns a user's settings limited by the current level: never better than `settings`, and valid if they are. Invalid
    /// settings are returned unchanged.
    ///
    /// Of [`Ratios`](crate::SplitScheme::Ratios) and [`Metres`](crate::SplitScheme::Metres), the ends are removed whose
    /// cascades lose least by it, with their [`bias_scales`](crate::CascadeSettings::bias_scales); and so are ends
    /// beyond a distance that was shortened.
    #[must_use]
    pub fn apply(&self, settings: &ShadowSettings) -> ShadowSettings {
        lowered(settings, self.quality())
    }

    /// Compares the level with the one before, and with itself.
    fn observe(&mut self, median_ms: f64) {
        if let Some(before_ms) = self.median_before_ms.take() {
            self.steps[self.level - 1].observe(before_ms, median_ms);
        }
        let first_ms = *self.first_ms.get_or_insert(median_ms);
        if has_changed(first_ms, median_ms) {
            self.steps.iter_mut().for_each(Step::invalidate);
        }
    }

    /// Steps down, unless this is the cheapest level.
    fn lower(&mut self, median_ms: f64) -> bool {
        let Some(step) = self.steps.get_mut(self.level) else { return false };
        step.lower(self.frame);
        self.lowered_at = self.frame;
        self.median_before_ms = Some(median_ms);
        self.change_to(self.level + 1)
    }

    /// Steps up if there is a better level that should fit.
    fn raise(&mut self, median_ms: f64) -> bool {
        let Some(better) = self.level.checked_sub(1) else { return false };
        let step = &mut self.steps[better];
        let fits = step.expected_ms(median_ms) <= self.config.budget_ms * HEADROOM;
        if !(fits && step.has_waited(self.frame - self.lowered_at)) {
            return false;
        }
        step.raise(self.frame, median_ms);
        self.change_to(better)
    }

    fn change_to(&mut self, level: usize) -> bool {
        self.level = level;
        self.window = Window::new();
        self.first_ms = None;
        true
    }
}

/// The times of the last frames since a change, milliseconds.
#[derive(Clone, Debug, PartialEq)]
struct Window {
    times_ms: [f64; WINDOW],
    /// Number of frames since the change, the skipped ones included.
    count: usize,
}

impl Window {
    fn new() -> Self {
        Self { times_ms: [0.0; WINDOW], count: 0 }
    }

    fn push(&mut self, time_ms: f64) {
        self.times_ms[self.count % WINDOW] = time_ms;
        self.count += 1;
    }

    /// Returns the median; `None` until there are enough frames.
    fn median_ms(&self) -> Option<f64> {
        if self.count < LATENCY + WINDOW {
            return None;
        }
        let mut sorted = self.times_ms;
        sorted.sort_unstable_by(f64::total_cmp);
        Some(sorted[WINDOW / 2])
    }
}

/// Returns whether two medians of one level belong to a scene that changed in between.
fn has_changed(before_ms: f64, now_ms: f64) -> bool {
    now_ms > before_ms * CHANGE || now_ms < before_ms / CHANGE
}

/// The known costs of a level relative to the next cheaper one.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    /// The cost of the better level over that of the cheaper one, at least 1.
    ratio: f64,
    /// The cost of the cheaper level at the last step up from there; `None` if the scene has changed since. Only with it the
    /// whole ratio is trusted.
    tried_ms: Option<f64>,
    /// The frame of the last step up.
    raised_at: Option<u64>,
    /// The wait before the next step up, frames.
    wait: u64,
}

impl Step {
    fn new() -> Self {
        Self { ratio: DEFAULT_RATIO, tried_ms: None, raised_at: None, wait: FIRST_WAIT }
    }

    /// Stores the costs of the two levels, measured one right after the other.
    fn observe(&mut self, better_ms: f64, cheaper_ms: f64) {
        // The load can have grown in between; that does not make the better level cheaper.
        self.ratio = (better_ms / cheaper_ms).max(1.0);
        self.tried_ms = self.tried_ms.filter(|tried_ms| !has_changed(*tried_ms, cheaper_ms));
    }

    /// Returns the expected cost of the better level if the cheaper one takes `cheaper_ms`.
    fn expected_ms(&self, cheaper_ms: f64) -> f64 {
        cheaper_ms * if self.tried_ms.is_some() { self.ratio } else { self.ratio.min(DEFAULT_RATIO) }
    }

    /// Returns whether the wait is over after this many frames.
    fn has_waited(&self, frames: u64) -> bool {
        frames >= self.wait
    }

    /// Stores a step up.
    fn raise(&mut self, frame: u64, cheaper_ms: f64) {
        self.tried_ms = Some(cheaper_ms);
        self.raised_at = Some(frame);
    }

    /// Stores a step down.
    fn lower(&mut self, frame: u64) {
        let is_reverted = self.raised_at.is_some_and(|raised_at| frame - raised_at < LONGEST_WAIT);
        self.wait = if is_reverted { (2 * self.wait).min(LONGEST_WAIT) } else { FIRST_WAIT };
    }

    /// Marks the ratio as outdated.
    fn invalidate(&mut self) {
        self.tried_ms = None;
    }
}
