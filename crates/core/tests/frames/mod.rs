//! The measured frames. Their declarations do not allocate: names and lists are created once.

pub(crate) mod chain;
pub(crate) mod real;

/// Differences from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Nothing: the plan of the previous frame is reused.
    Never,
    /// One clear value, in every frame: no plan is reused.
    Always,
    /// One clear value, alternating: one of the last two plans is reused.
    Alternating,
}

impl Change {
    pub(crate) const ALL: [Self; 3] = [Self::Never, Self::Always, Self::Alternating];

    /// Returns the red of the clear value in frame `number`, 0 to 1.
    pub(crate) fn red(self, number: u32) -> f64 {
        match self {
            Self::Never => 0.5,
            Self::Always => f64::from(number) / f64::from(u32::MAX),
            Self::Alternating => f64::from(number % 2),
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Never => "unchanged",
            Self::Always => "changed",
            Self::Alternating => "alternating",
        }
    }
}
