//! Configuration of the controller.

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::settings::MAX_CASCADES;

/// A time budget for shadows, and the quality levels to choose from.
///
/// ```
/// use shadowgraph_shadows::BudgetConfig;
/// let config: BudgetConfig = ron::from_str("(budget_ms: 1.5, levels: [(), (map_scale: 2), (map_scale: 2, cascades: 2)])")?;
/// config.validate()?;
/// assert_eq!(config.levels[1].cascades, 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetConfig {
    /// The time that the shadow passes of a frame may take, milliseconds, 0.001 to 1000.
    pub budget_ms: f64,
    /// The levels, from best to cheapest, 1 to 32. Each is cheaper in at least one value than the one before.
    pub levels: Vec<QualityLevel>,
}

/// The limits that one level puts on the user's [`ShadowSettings`](crate::ShadowSettings). Values that are left out limit nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct QualityLevel {
    /// Divisor of the maps' width: 1, 2, 4 or 8. Maps stay at least 256 pixels wide.
    pub map_scale: u32,
    /// Largest number of cascades of a light, 1 to 8.
    pub cascades: u32,
    /// Factor of the shadow distance, 0.05 to 1. It has an effect only where the result is nearer than the camera's
    /// far plane.
    pub distance_scale: f32,
}

/// Largest number of levels.
const MAX_LEVELS: usize = 32;

impl Default for QualityLevel {
    fn default() -> Self {
        Self { map_scale: 1, cascades: MAX_CASCADES, distance_scale: 1.0 }
    }
}

impl Default for BudgetConfig {
    /// Returns 2 milliseconds and eight levels: they shorten the distance first, which is missed least, then reduce
    /// cascades and maps in turn.
    fn default() -> Self {
        let level =
            |(map_scale, cascades, distance_scale)| QualityLevel { map_scale, cascades, distance_scale };
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
        Self { budget_ms: 2.0, levels: levels.map(level).to_vec() }
    }
}

impl BudgetConfig {
    /// Checks every value.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    pub fn validate(&self) -> Result<(), Error> {
        if !(0.001..=1000.0).contains(&self.budget_ms) {
            return Err(setting("budget_ms", self.budget_ms, "0.001 to 1000 (milliseconds)"));
        }
        if !(1..=MAX_LEVELS).contains(&self.levels.len()) {
            return Err(setting("levels", format!("a list of {}", self.levels.len()), "1 to 32 levels"));
        }
        self.levels.iter().try_for_each(QualityLevel::validate)?;
        // With a list from cheapest to best, the controller would step the wrong way.
        let unordered =
            (1..).zip(self.levels.windows(2)).find(|(_, pair)| !pair[1].is_cheaper_than(&pair[0]));
        unordered.map_or(Ok(()), |(i, _)| {
            let value = format!("in the wrong order: level {i} is not cheaper than the one before");
            Err(setting("levels", value, "from best to cheapest"))
        })
    }
}

impl QualityLevel {
    fn validate(&self) -> Result<(), Error> {
        if !matches!(self.map_scale, 1 | 2 | 4 | 8) {
            return Err(setting("levels.map_scale", self.map_scale, "1, 2, 4 or 8"));
        }
        if !(1..=MAX_CASCADES).contains(&self.cascades) {
            return Err(setting("levels.cascades", self.cascades, "1 to 8"));
        }
        if !(0.05..=1.0).contains(&self.distance_scale) {
            return Err(setting("levels.distance_scale", self.distance_scale, "0.05 to 1"));
        }
        Ok(())
    }

    /// Returns whether at least one value is cheaper.
    fn is_cheaper_than(&self, other: &Self) -> bool {
        self.map_scale > other.map_scale
            || self.cascades < other.cascades
            || self.distance_scale < other.distance_scale
    }
}

fn setting(field: &str, value: impl ToString, allowed: &str) -> Error {
    Error::Setting { field: field.into(), value: value.to_string(), allowed: allowed.into() }
}
