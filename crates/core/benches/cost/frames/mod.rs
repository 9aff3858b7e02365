//! The frames that are measured. Their declarations allocate nothing of their own: names and lists are made once.

pub(crate) mod chain;
pub(crate) mod real;

/// What differs from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Nothing: the plan of the frame before is found again.
    Never,
    /// One clear value, each time: no plan is ever found again.
    Always,
    /// One clear value, back and forth: one of the last two plans is found again.
    Alternating,
}

impl Change {
    pub(crate) const ALL: [Self; 3] = [Self::Never, Self::Always, Self::Alternating];

    /// The red of the clear value in frame `number`, 0 to 1.
    pub(crate) fn red(self, number: u32) -> f64 {
        match self {
            Self::Never => 0.5,
            Self::Always => f64::from(number) / f64::from(u32::MAX),
            Self::Alternating => f64::from(number % 2),
        }
    }

    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Never => "unchanged",
            Self::Always => "changed",
            Self::Alternating => "alternating",
        }
    }
}
