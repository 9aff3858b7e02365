//! Configuration of the controller.

use crate::declare_settings;
use crate::error::Error;
use crate::settings::{DescribeSettings, refused};

declare_settings! {
    /// A time budget for shadows, and the quality levels to choose from.
    ///
    /// ```
    /// use shadowgraph_shadows::BudgetConfig;
    /// let config: BudgetConfig = ron::from_str("(budget_ms: 1.5, levels: [(), (map_scale: 2), (map_scale: 2, cascades: 2)])")?;
    /// config.validate()?;
    /// assert_eq!(config.levels[1].cascades, 8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[check(BudgetConfig::check_levels)]
    pub struct BudgetConfig {
        /// Time that the shadow passes of a frame may take.
        budget_ms: f64 = 2.0, 0.001..=1000, in "milliseconds";
        /// Levels, each cheaper in at least one value than the one before.
        levels: Vec<QualityLevel> = default_levels(), and "1 to 32 of them, from best to cheapest";
    }
}

declare_settings! {
    /// The limits that one level puts on the user's [`ShadowSettings`](crate::ShadowSettings). Values that are left out limit nothing.
    #[derive(Copy)]
    pub struct QualityLevel {
        /// Divisor of the maps' width. Maps stay at least 256 pixels wide.
        map_scale: u32 = 1, power_of_two 1..=8;
        /// Largest number of cascades of a light.
        cascades: u32 = 8, 1..=8;
        /// Factor of the shadow distance. It has an effect only where the result is nearer than the camera's far plane.
        distance_scale: f32 = 1.0, 0.05..=1;
    }
}

/// Largest number of levels.
const MAX_LEVELS: usize = 32;

/// Returns eight levels: they shorten the distance first, which is missed least, then reduce cascades and maps in turn.
fn default_levels() -> Vec<QualityLevel> {
    // A single cascade has the whole map, twice as wide as a tile of two: so maps are halved with it.
    let levels = [
        (1, 8, 1.0),
        (1, 6, 0.8),
        (1, 3, 0.65),
        (2, 3, 0.55),
        (2, 2, 0.45),
        (4, 2, 0.35),
        (8, 1, 0.25),
        (8, 1, 0.1),
    ];
    let level = |(map_scale, cascades, distance_scale)| QualityLevel { map_scale, cascades, distance_scale };
    levels.map(level).to_vec()
}

impl BudgetConfig {
    /// Checks every value.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    pub fn validate(&self) -> Result<(), Error> {
        DescribeSettings::validate(self)
    }

    /// Checks the number of levels and their order.
    fn check_levels(&self) -> Result<(), Error> {
        let wrong = |value: String| refused(Self::SETTINGS, "levels", value);
        if !(1..=MAX_LEVELS).contains(&self.levels.len()) {
            return Err(wrong(format!("a list of {}", self.levels.len())));
        }
        // With a list from cheapest to best, the controller would step the wrong way.
        let unordered =
            (1..).zip(self.levels.windows(2)).find(|(_, pair)| !pair[1].is_cheaper_than(&pair[0]));
        unordered.map_or(Ok(()), |(i, _)| {
            Err(wrong(format!("in the wrong order: level {i} is not cheaper than the one before")))
        })
    }
}

impl QualityLevel {
    /// Returns whether at least one value is cheaper.
    fn is_cheaper_than(&self, other: &Self) -> bool {
        self.map_scale > other.map_scale
            || self.cascades < other.cascades
            || self.distance_scale < other.distance_scale
    }
}
