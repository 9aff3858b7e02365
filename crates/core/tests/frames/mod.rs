//! The measured frames. Their declarations do not allocate: names and lists are created once.

pub(crate) mod chain;
pub(crate) mod real;

use shadowgraph_core::{Contents, Frame};

/// Differences from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Nothing: the plan of the previous frame is reused.
    Never,
    /// One clear value, in every frame: the plan of the previous frame is reused but for load operations.
    Clear,
    /// The name of a pass that is culled, in every frame: each frame is compiled from scratch.
    Pass,
    /// One clear value, alternating: one of the last two plans is reused.
    Alternating,
}

impl Change {
    pub(crate) const ALL: [Self; 4] = [Self::Never, Self::Clear, Self::Pass, Self::Alternating];

    /// Returns the red of the clear value in frame `number`, 0 to 1.
    pub(crate) fn red(self, number: u32) -> f64 {
        match self {
            Self::Never | Self::Pass => 0.5,
            Self::Clear => f64::from(number) / f64::from(u32::MAX),
            Self::Alternating => f64::from(number % 2),
        }
    }

    /// Adds what only frame `number` declares.
    pub(crate) fn declare(self, frame: &mut Frame<'_>, number: u32) {
        if self == Self::Pass {
            let mut texture = frame.create_texture("another", chain::desc());
            let mut pass = frame.render_pass(format_args!("another {number}"));
            pass.color(&mut texture, Contents::clear_color([0.0; 4]));
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Never => "unchanged",
            Self::Clear => "another clear value",
            Self::Pass => "another pass",
            Self::Alternating => "alternating",
        }
    }
}
