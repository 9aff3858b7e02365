//! Difference of two cascades at their border.

use super::error::{check_fractions, check_length};
use super::{MetricsError, Summary};

/// Summarises the |difference of visibility| (0 to 1) of two cascades evaluated at the same points.
///
/// # Errors
/// - [`MetricsError::Length`]: the lists have different lengths.
/// - [`MetricsError::Value`]: a number is not from 0 to 1.
pub fn seam(nearer: &[f32], farther: &[f32]) -> Result<Summary, MetricsError> {
    check_length("farther", farther.len(), nearer.len())?;
    check_fractions("nearer", nearer)?;
    check_fractions("farther", farther)?;
    let differences: Vec<f32> = nearer.iter().zip(farther).map(|(a, b)| (a - b).abs()).collect();
    Ok(Summary::new(&differences))
}
