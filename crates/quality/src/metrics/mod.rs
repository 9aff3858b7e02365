//! Compares measured shadows with ray-traced ground truth.
//!
//! [`Samples`] are one view of one light: the visible surfaces, the visibility of a technique, and the reference. Each
//! metric is a pure function of them; [`flicker`] and [`seam`] are functions of visibilities at world points.
//!
//! A *receiver* is a pixel with geometry and N·L above [`RECEIVER_N_DOT_L`]. It is *misclassified* if visibility and
//! hard reference differ by more than 1/2.
//!
//! ```
//! use shadowgraph_quality::metrics::percentile;
//! assert_eq!(percentile(&[0.25, 0.75, 0.5], 50.0), Some(0.5));
//! ```

mod band;
mod distance;
mod edge_error;
mod error;
mod flicker;
mod mean_error;
mod misclassified;
mod missing_contacts;
mod peter_panning;
mod samples;
mod seam;
mod statistics;
mod surface;
#[cfg(test)]
mod tests;

pub use band::{BAND_PX, BAND_TEXELS, Band, band};
pub use edge_error::{EdgeError, PENUMBRA, edge_error};
pub use error::MetricsError;
pub use flicker::flicker;
pub use mean_error::{MeanError, mean_error};
pub use misclassified::{AcneBin, Misclassified, MisclassifiedCounts, N_DOT_L_BINS, misclassified};
pub use missing_contacts::{MissingContacts, NEAR_BLOCKER_M, missing_contacts};
pub use peter_panning::{CONTACT_M, PeterPanning, peter_panning};
pub use samples::{Images, RECEIVER_N_DOT_L, Samples, TowardsLight};
pub use seam::seam;
pub use statistics::{Summary, percentile};
pub use surface::{CREASE_COS, STEP_PX};
