//! A budget of time for shadows: their quality is lowered while they take longer, and raised again once they fit.
//!
//! After Engel, "Cascaded Shadow Maps" (ShaderX5, 2006), *scalability*: fewer slices of the view where the hardware needs
//! it, and their near and far planes moved while the program runs. [`QualityController`] decides when:
//!
//! 1. *Smoothing.* It judges the median of the last 9 frames. After a change of level it leaves out 3 frames, which had
//!    been begun before, and waits for 9 new ones.
//! 2. *Down.* One level as soon as the median is over the budget. Once the first 9 frames of the cheaper level are
//!    measured, it remembers how many times as long the better one took.
//! 3. *Up.* One level when the median, times what it remembers, is at most 0.8 of the budget, and not sooner than 8 times
//!    9 frames after it last went down. Each time going up has to be taken back, that wait doubles, up to 256 times
//!    9 frames. It is short again once the better level held for as long as the longest wait.
//!
//! What it remembers is wrong if the scene got easier just as it went down, as when a program has loaded; it would stay
//! down for ever. So a factor above 2 counts as 2 until the better level has been tried once more, and again once the median
//! of a level has doubled or halved. With costs that stay as they are, and noise of up to 10 %, that is at most one needless
//! try of each level. The price: if something else makes the frames of that try slow, it stays down until the median has
//! doubled or halved.

mod controller;
mod lower;
mod memory;
mod rules;
mod splits;
#[cfg(test)]
mod tests;
mod window;

pub use controller::QualityController;
pub use rules::{BudgetRules, Quality};
