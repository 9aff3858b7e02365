//! Measures what Shadowgraph draws: its shadows against ray-traced ground truth, and its cost against passes encoded by hand.

pub mod bench;
mod cases;
mod counting;
mod error;
mod fine;
mod flicker;
mod instrument;
pub mod metrics;
mod motion;
mod parallel;
mod pictures;
mod probe;
pub mod report;
mod run;
mod seam;
mod subject;
mod surfaces;
mod texels;
mod truth;
mod variants;
mod views;

pub use cases::{Case, CaseSet, CaseView, SceneSource, built_in_cases};
pub use error::Error;
pub use fine::{FINE_POINTS, FINE_REACH_PX};
pub use flicker::{FLICKER_SIZE_PX, measure_flicker};
pub use instrument::{Compared, Ground, Instrument, LAMP_RADIUS_M, SUN_ANGULAR_RADIUS, ViewErrors};
pub use motion::{FAR_OUT_M, STEP_PX, camera_at};
pub use pictures::ViewPictures;
pub use probe::{Answers, Points, Probe, Question};
pub use run::{CasePictures, Measured, Task, measure};
pub use seam::measure_seam;
pub use subject::{DEFAULT_VIEWS, MAX_LIGHTS, Subject, SubjectLight};
pub use surfaces::{SurfaceReader, Surfaces};
pub use texels::{NO_VIEW, Texels};
pub use truth::{RayLight, SCOUTS, Truth};
pub use variants::{Variant, VariantSet};
pub use views::automatic_views;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
