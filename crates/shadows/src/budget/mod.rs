//! A time budget for shadows: their quality is lowered while they take longer, and raised again once they fit.
//!
//! After Engel, "Cascaded Shadow Maps" (ShaderX5, 2006), *scalability*: fewer slices of the view where the hardware requires
//! it, and their near and far planes moved at run time. [`QualityController`] decides when:
//!
//! 1. *Smoothing.* It uses the median of the last 9 frames. After a change of level it skips 3 frames, which were
//!    already in flight, and waits for 9 new ones.
//! 2. *Down.* It lowers the quality by one level as soon as the median is over the budget. Once the first 9 frames of the
//!    cheaper level are measured, it stores the ratio of the two levels' costs.
//! 3. *Up.* It raises the quality by one level when the median times that ratio is at most 0.8 of the budget, and no sooner
//!    than 8 times 9 frames after the last step down. Each time a step up has to be reverted, that wait doubles, up to
//!    256 times 9 frames. It is short again once the better level held for as long as the longest wait.
//!
//! The stored ratio is too large if the scene got easier during the step down, as when a program has finished loading; the
//! controller would stay down forever. So a ratio above 2 counts as 2 until the better level has been tried once more, and
//! again once the median of a level has doubled or halved. With constant costs, and noise of up to 10 %, that is at most one
//! needless try of each level. The price: if something else makes the frames of that try slow, it stays down until the
//! median has doubled or halved.

mod config;
mod controller;
mod lowering;
#[cfg(test)]
mod tests;

pub use config::{BudgetConfig, QualityLevel};
pub use controller::QualityController;
