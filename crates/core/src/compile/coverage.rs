//! The part of a resource that has a property, such as being defined.

use crate::subresource::{Region, RegionSet};

/// None of a resource, all of it, or some regions.
#[derive(Clone, Debug, Default)]
pub(super) enum Coverage {
    #[default]
    None,
    All,
    Partial(RegionSet),
}

impl Coverage {
    pub(super) fn all_if(all: bool) -> Self {
        if all { Self::All } else { Self::None }
    }

    pub(super) fn is_empty(&self) -> bool {
        match self {
            Self::None => true,
            Self::All => false,
            Self::Partial(regions) => regions.is_empty(),
        }
    }

    /// Adds a region, or all for `None`.
    pub(super) fn add(&mut self, region: Option<&Region>) {
        let Some(region) = region else {
            *self = Self::All;
            return;
        };
        match self {
            Self::All => {}
            Self::None => *self = Self::Partial(RegionSet::from_region(*region)),
            Self::Partial(regions) => regions.add(*region),
        }
    }

    /// Removes a region, or all for `None`.
    pub(super) fn subtract(&mut self, region: Option<&Region>) {
        let Some(region) = region else {
            *self = Self::None;
            return;
        };
        if let Self::All = self {
            *self = Self::Partial(RegionSet::from_region(Region::ALL));
        }
        if let Self::Partial(regions) = self {
            regions.subtract(region);
        }
    }

    pub(super) fn overlaps(&self, region: Option<&Region>) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::Partial(regions) => regions.overlaps(region.unwrap_or(&Region::ALL)),
        }
    }

    pub(super) fn contains(&self, region: Option<&Region>) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::Partial(regions) => regions.contains(region.unwrap_or(&Region::ALL)),
        }
    }

    /// Returns what is inside `region`.
    pub(super) fn intersection(&self, region: &Region) -> RegionSet {
        match self {
            Self::None => RegionSet::default(),
            Self::All => RegionSet::from_region(*region),
            Self::Partial(regions) => {
                let mut regions = regions.clone();
                regions.clip(region);
                regions
            }
        }
    }
}
