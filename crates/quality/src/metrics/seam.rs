//! How well two cascades agree where one ends.

use super::error::{check_length, check_shares};
use super::{MetricsError, Summary};

/// Sums up the |difference of visibility| (0 to 1) of two cascades evaluated at the same points.
///
/// # Errors
/// - [`MetricsError::Length`]: the lists are not of the same length.
/// - [`MetricsError::Value`]: a number is not from 0 to 1.
pub fn seam(nearer: &[f32], farther: &[f32]) -> Result<Summary, MetricsError> {
    check_length("farther", farther.len(), nearer.len())?;
    check_shares("nearer", nearer)?;
    check_shares("farther", farther)?;
    let differences: Vec<f32> = nearer.iter().zip(farther).map(|(a, b)| (a - b).abs()).collect();
    Ok(Summary::of(&differences))
}
