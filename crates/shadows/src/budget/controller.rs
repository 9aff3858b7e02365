//! When the level changes.

use super::lower::lowered;
use super::memory::{Step, has_changed};
use super::window::Window;
use super::{BudgetRules, Quality};
use crate::{Error, ShadowSettings};

/// The part of the budget that a better level is expected to need when it goes up. Two medians with noise of 10 % each
/// are off by a factor of 0.9 / 1.1 together: what was over the budget is not taken to fit.
const ROOM: f64 = 0.8;

/// Times are held within this factor of the budget: what is shorter is all the same, whatever the timer's noise.
const SPAN: f64 = 100.0;

/// Lowers what shadows cost while they take longer than a budget, and raises it again.
///
/// It begins at the best level, and its answers depend on the times it is given alone. While a level costs the same, times
/// noise of up to 10 %, it comes to the best level that fits and stays there.
///
/// ```
/// use shadowgraph_shadows::{BudgetRules, QualityController, ShadowSettings};
/// let chosen = ShadowSettings::default();
/// let mut controller = QualityController::new(BudgetRules { budget_ms: 1.5, ..BudgetRules::default() })?;
/// let mut settings = chosen.clone();
/// // Once a frame, with the time that the shadow passes of the newest frame took that the GPU has finished:
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
    rules: BudgetRules,
    level: usize,
    window: Window,
    /// Of each level but the last.
    steps: Vec<Step>,
    /// How many times it was given.
    frame: u64,
    /// When it last came down, frames.
    came_down: u64,
    /// The median when it came down, until the new level is measured.
    left_ms: Option<f64>,
    /// The first median since the level changed.
    first_ms: Option<f64>,
}

impl QualityController {
    /// Makes one, at the best level.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`], if a value of the rules is out of its range.
    pub fn new(rules: BudgetRules) -> Result<Self, Error> {
        rules.validate()?;
        Ok(Self {
            level: 0,
            window: Window::new(),
            steps: vec![Step::new(); rules.levels.len() - 1],
            frame: 0,
            came_down: 0,
            left_ms: None,
            first_ms: None,
            rules,
        })
    }

    /// Takes the time that the shadow passes of a finished frame took, milliseconds, 0 or more, and tells whether the level
    /// changed. To be called once a frame; anything else than such a number is ignored.
    pub fn update(&mut self, measured_ms: f64) -> bool {
        if !(measured_ms.is_finite() && measured_ms >= 0.0) {
            return false;
        }
        let budget_ms = self.rules.budget_ms;
        self.frame += 1;
        self.window.push(measured_ms.clamp(budget_ms / SPAN, budget_ms * SPAN));
        let Some(median_ms) = self.window.median_ms() else { return false };
        self.learn(median_ms);
        if median_ms > budget_ms { self.come_down(median_ms) } else { self.go_up(median_ms) }
    }

    /// Returns which of the rules' levels is in use, 0 the best.
    #[must_use]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Returns the level that is in use.
    #[must_use]
    pub fn quality(&self) -> &Quality {
        &self.rules.levels[self.level]
    }

    /// Returns what the level leaves of what a user chose: never more than that, and valid if that is. Settings that are not
    /// valid come back as they are.
    ///
    /// Of [`Ratios`](crate::SplitScheme::Ratios) and [`Metres`](crate::SplitScheme::Metres), the ends are left out whose
    /// cascades lose least by it, and their [`bias_scales`](crate::CascadeSettings::bias_scales) with them; and so are ends
    /// beyond a distance that got shorter.
    #[must_use]
    pub fn apply(&self, settings: &ShadowSettings) -> ShadowSettings {
        lowered(settings, self.quality())
    }

    /// Compares the level with the one before, and with itself.
    fn learn(&mut self, median_ms: f64) {
        if let Some(left_ms) = self.left_ms.take() {
            self.steps[self.level - 1].measured(left_ms, median_ms);
        }
        let first_ms = *self.first_ms.get_or_insert(median_ms);
        if has_changed(first_ms, median_ms) {
            self.steps.iter_mut().for_each(Step::doubt);
        }
    }

    /// Unless it is at the cheapest level.
    fn come_down(&mut self, median_ms: f64) -> bool {
        let Some(step) = self.steps.get_mut(self.level) else { return false };
        step.come_down(self.frame);
        self.came_down = self.frame;
        self.left_ms = Some(median_ms);
        self.change_to(self.level + 1)
    }

    /// If there is a better level that should fit.
    fn go_up(&mut self, median_ms: f64) -> bool {
        let Some(better) = self.level.checked_sub(1) else { return false };
        let step = &mut self.steps[better];
        let fits = step.expected_ms(median_ms) <= self.rules.budget_ms * ROOM;
        if !(fits && step.has_waited(self.frame - self.came_down)) {
            return false;
        }
        step.go_up(self.frame, median_ms);
        self.change_to(better)
    }

    fn change_to(&mut self, level: usize) -> bool {
        self.level = level;
        self.window = Window::new();
        self.first_ms = None;
        true
    }
}
