//! What a controller is made with.

use serde::{Deserialize, Serialize};

use crate::settings::setting;
use crate::{Error, MAX_CASCADES};

/// How long shadows may take, and what is given up for it.
///
/// ```
/// use shadowgraph_shadows::BudgetRules;
/// let rules: BudgetRules = ron::from_str("(budget_ms: 1.5, levels: [(), (map_scale: 2), (map_scale: 2, cascades: 2)])")?;
/// rules.validate()?;
/// assert_eq!(rules.levels[1].cascades, 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BudgetRules {
    /// The time that the shadow passes of a frame may take, milliseconds, 0.001 to 1000.
    pub budget_ms: f64,
    /// The levels, from best to cheapest, 1 to 32. Each is cheaper in something than the one before.
    pub levels: Vec<Quality>,
}

/// What one level leaves of the [`ShadowSettings`](crate::ShadowSettings) that a user chose. Left out: all of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Quality {
    /// What the width of the maps is divided by: 1, 2, 4 or 8. Maps stay at least 256 pixels wide.
    pub map_scale: u32,
    /// The most cascades that a light has, 1 to 8.
    pub cascades: u32,
    /// What the shadow distance is multiplied by, 0.05 to 1. It counts only where the distance is not beyond the camera's
    /// far plane anyway.
    pub distance_scale: f32,
}

/// The most levels that there can be.
const MAX_LEVELS: usize = 32;

impl Default for Quality {
    fn default() -> Self {
        Self { map_scale: 1, cascades: MAX_CASCADES, distance_scale: 1.0 }
    }
}

impl Default for BudgetRules {
    /// 2 milliseconds, and eight levels: first the distance, which is missed least, then in turn cascades and maps.
    fn default() -> Self {
        let level = |(map_scale, cascades, distance_scale)| Quality { map_scale, cascades, distance_scale };
        // A single cascade has all of the map, as wide as two: so maps are halved with it.
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

impl BudgetRules {
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
        self.levels.iter().try_for_each(Quality::validate)?;
        // A list from cheapest to best would steer the wrong way.
        let mistaken = (1..).zip(self.levels.windows(2)).find(|(_, pair)| !pair[1].is_cheaper_than(&pair[0]));
        mistaken.map_or(Ok(()), |(i, _)| {
            let value = format!("nowhere cheaper in level {i} than in the one before");
            Err(setting("levels", value, "from best to cheapest"))
        })
    }
}

impl Quality {
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

    /// In one thing at least.
    fn is_cheaper_than(&self, other: &Self) -> bool {
        self.map_scale > other.map_scale
            || self.cascades < other.cascades
            || self.distance_scale < other.distance_scale
    }
}
