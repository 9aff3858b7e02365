//! Which casters are left out.

use serde::{Deserialize, Serialize};

/// Which casters are left out of maps. None of it changes what is seen.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CullSettings {
    /// Leaves out casters that cannot darken anything that the camera sees within the shadow distance. Switch it off where
    /// shadows are asked for at points beside the view.
    pub unseen: bool,
    /// Leaves casters out of a cascade if finer ones serve all that is seen of what they darken.
    pub covered: bool,
}

impl Default for CullSettings {
    fn default() -> Self {
        Self { unseen: true, covered: true }
    }
}

impl CullSettings {
    /// Leaves out only what is beside a map.
    pub const NONE: Self = Self { unseen: false, covered: false };
}
