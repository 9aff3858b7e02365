//! How much of a resource something is true of.

use crate::part::{Area, AreaSet};

/// None of a resource, all of it, or some parts.
#[derive(Clone, Debug, Default)]
pub(super) enum Coverage {
    #[default]
    None,
    All,
    Parts(AreaSet),
}

impl Coverage {
    pub(super) fn all_if(all: bool) -> Self {
        if all { Self::All } else { Self::None }
    }

    pub(super) fn is_empty(&self) -> bool {
        match self {
            Self::None => true,
            Self::All => false,
            Self::Parts(parts) => parts.is_empty(),
        }
    }

    /// Adds a box, or all where there is none.
    pub(super) fn add(&mut self, area: Option<&Area>) {
        let Some(area) = area else {
            *self = Self::All;
            return;
        };
        match self {
            Self::All => {}
            Self::None => *self = Self::Parts(AreaSet::from_area(*area)),
            Self::Parts(parts) => parts.add(*area),
        }
    }

    /// Takes out a box, or all where there is none.
    pub(super) fn subtract(&mut self, area: Option<&Area>) {
        let Some(area) = area else {
            *self = Self::None;
            return;
        };
        if let Self::All = self {
            *self = Self::Parts(AreaSet::from_area(Area::EVERYTHING));
        }
        if let Self::Parts(parts) = self {
            parts.subtract(area);
        }
    }

    pub(super) fn overlaps(&self, area: Option<&Area>) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::Parts(parts) => parts.overlaps(area.unwrap_or(&Area::EVERYTHING)),
        }
    }

    pub(super) fn contains(&self, area: Option<&Area>) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::Parts(parts) => parts.contains(area.unwrap_or(&Area::EVERYTHING)),
        }
    }

    /// What lies inside `area`.
    pub(super) fn within(&self, area: &Area) -> AreaSet {
        match self {
            Self::None => AreaSet::default(),
            Self::All => AreaSet::from_area(*area),
            Self::Parts(parts) => {
                let mut parts = parts.clone();
                parts.clip(area);
                parts
            }
        }
    }
}
