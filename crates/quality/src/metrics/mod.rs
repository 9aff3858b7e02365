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
mod edge_error;
mod peter_panning;
mod samples;
mod stability;
mod visibility;

#[cfg(test)]
mod tests;

pub use band::{BAND_PX, BAND_TEXELS, Band, band};
pub use edge_error::{EdgeError, PENUMBRA, edge_error};
pub use peter_panning::{CONTACT_M, PeterPanning, peter_panning};
pub use samples::{CREASE_COS, Images, MetricsError, RECEIVER_N_DOT_L, STEP_PX, Samples, TowardsLight};
pub use stability::{CHANGE, Stability, Truths, stability};
pub use visibility::{
    AcneBin, MeanError, Misclassified, MisclassifiedCounts, MissingContacts, N_DOT_L_BINS, NEAR_BLOCKER_M,
    Summary, flicker, mean_error, misclassified, missing_contacts, percentile, seam,
};
