//! Measures Shadowgraph: its shadows against ray-traced ground truth, and its cost against hand-written passes.

pub mod bench;
mod cases;
mod comparator;
mod counting;
mod error;
mod flicker;
mod ground_truth;
mod images;
mod measured_scene;
pub mod metrics;
mod motion;
mod noise;
mod parallel;
mod pixel_shadows;
mod probe;
pub mod report;
mod run;
mod scene_truth;
mod seam;
mod stability;
mod subpixel;
mod surfaces;
mod texels;
mod text_table;
mod variants;
mod views;

pub use cases::{Case, CaseSet, CaseView, SceneSource, built_in_cases};
pub use comparator::{
    Comparator, PUNCTUAL_LIGHT_RADIUS_M, Reference, SUN_ANGULAR_RADIUS, ViewComparison, ViewErrors,
};
pub use error::Error;
pub use flicker::{FLICKER_SIZE_PX, measure_flicker};
pub use ground_truth::{GroundTruth, PROBE_RAYS, RayLight};
pub use images::ViewImages;
pub use measured_scene::{DEFAULT_VIEWS, MAX_LIGHTS, MeasuredLight, MeasuredScene};
pub use motion::{FAR_OFFSET_M, STEP_PX, SUN_STEP, camera_for_frame, camera_walk, turned_sun};
pub use noise::{NoiseErrors, NoiseTask, Noisy, RootMeanSquare, measure_noise, noisy_techniques};
pub use pixel_shadows::{
    PixelBlocker, PixelLight, PixelRemedy, PixelShadows, PixelSurface, Reachability, ShadowInspector,
};
pub use probe::{Points, Probe, Query, Results};
pub use run::{CaseImages, Measured, Task, measure};
pub use seam::measure_seam;
pub use stability::{MOTION_FRAMES, MOTION_RAYS, MOTION_SIZE_PX, MotionMeasured, MotionTask, measure_motion};
pub use subpixel::{SUBPIXEL_GRID, SUBPIXEL_RADIUS_PX};
pub use surfaces::{SurfaceReader, Surfaces};
pub use texels::{NO_VIEW, Texels};
pub use text_table::TextTable;
pub use variants::{Variant, VariantSet};
pub use views::automatic_views;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
