//! How much is measured.

use crate::arguments::Arguments;
use crate::measure::ROUNDS;

/// How much is measured.
pub(crate) struct Work {
    /// Instances of the city.
    pub(crate) city: u32,
    /// The most lights of the city, the first ones.
    pub(crate) city_lights: usize,
    pub(crate) size_px: [u32; 2],
    /// Measured frames of each scene and technique.
    pub(crate) frames: u32,
    /// Scenes with more triangles are not traced.
    pub(crate) traced_triangles: usize,
    /// Rounds in which the sides of the graph's frames take turns.
    pub(crate) rounds: usize,
}

impl Work {
    /// Work for a GPU. The processor would build the tree of more triangles for minutes.
    const GPU: Self = Self {
        city: 100_000,
        city_lights: usize::MAX,
        size_px: [1280, 720],
        frames: 20,
        traced_triangles: 500_000,
        rounds: ROUNDS,
    };

    /// Work that a software driver does in minutes: at the size above, or with a thousand lights for each pixel, it would take hours.
    const SOFTWARE: Self = Self {
        city: 10_000,
        city_lights: 4,
        size_px: [320, 180],
        frames: 2,
        traced_triangles: 100_000,
        rounds: 3,
    };

    /// Returns what the options ask for, and the default for what they leave open.
    pub(crate) fn new(arguments: &Arguments, software: bool) -> Self {
        let default = if software { Self::SOFTWARE } else { Self::GPU };
        Self {
            city: arguments.city.unwrap_or(default.city),
            size_px: arguments.size_px.unwrap_or(default.size_px),
            frames: arguments.frames.unwrap_or(default.frames),
            ..default
        }
    }
}
