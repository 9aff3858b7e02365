//! Measuring shadows against ray-traced truth.

mod cases;
pub mod metrics;
mod occluders;
mod parallel;
pub mod report;
mod surfaces;
mod texels;
mod truth;
mod view;

pub use cases::{Case, CaseSet, CaseView, SceneSource, built_in_cases};
pub use occluders::ray_scene;
pub use surfaces::{SurfaceReader, Surfaces};
pub use texels::Texels;
pub use truth::{RayLight, Truth};
pub use view::{Instrument, ViewErrors, ViewPictures};
