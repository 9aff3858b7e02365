//! Measuring shadows against ray-traced truth.

mod cases;
mod surfaces;

pub use cases::{Case, CaseSet, CaseView, SceneSource, built_in_cases};
pub use surfaces::{SurfaceDrawer, Surfaces};
