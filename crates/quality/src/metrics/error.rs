//! Errors of the images and lists to compare.

/// Error of invalid input to a metric.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricsError {
    /// A list has the wrong length.
    #[error("`{list}` has {has} entries; expected {needs}")]
    Length {
        /// Name of the list.
        list: &'static str,
        /// Its length.
        has: usize,
        /// The expected length.
        needs: usize,
    },
    /// A number is out of range or not finite.
    #[error("invalid value at index {index} of `{list}`; allowed: {allowed}")]
    Value {
        /// Name of the list.
        list: &'static str,
        /// Index in the list; for lists of frames, in the frame.
        index: usize,
        /// Allowed values.
        allowed: &'static str,
    },
}

/// Checks that a list has `needs` entries.
pub(super) fn check_length(list: &'static str, has: usize, needs: usize) -> Result<(), MetricsError> {
    if has == needs { Ok(()) } else { Err(MetricsError::Length { list, has, needs }) }
}

/// Checks that every value is from 0 to 1.
pub(super) fn check_fractions(list: &'static str, values: &[f32]) -> Result<(), MetricsError> {
    match values.iter().position(|value| !(0.0..=1.0).contains(value)) {
        Some(index) => Err(MetricsError::Value { list, index, allowed: "0 to 1" }),
        None => Ok(()),
    }
}
