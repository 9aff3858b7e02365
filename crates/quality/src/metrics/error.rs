//! What can be wrong with the pictures and lists to compare.

/// Why something cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricsError {
    /// A list is not as long as those it belongs to.
    #[error("`{list}` has {has} entries; it needs {needs}")]
    Length {
        /// Its name.
        list: &'static str,
        /// How long it is.
        has: usize,
        /// How long it has to be.
        needs: usize,
    },
    /// A number that would count as right or be left out without being samples.
    #[error("`{list}` has a number at {index} that is not allowed; allowed: {allowed}")]
    Value {
        /// The name of the list.
        list: &'static str,
        /// Its place in the list; for lists of frames, in its frame.
        index: usize,
        /// The numbers it can be.
        allowed: &'static str,
    },
}

/// Checks that a list has `needs` entries.
pub(super) fn check_length(list: &'static str, has: usize, needs: usize) -> Result<(), MetricsError> {
    if has == needs { Ok(()) } else { Err(MetricsError::Length { list, has, needs }) }
}

/// Checks that every value is from 0 to 1.
pub(super) fn check_shares(list: &'static str, values: &[f32]) -> Result<(), MetricsError> {
    match values.iter().position(|value| !(0.0..=1.0).contains(value)) {
        Some(index) => Err(MetricsError::Value { list, index, allowed: "0 to 1" }),
        None => Ok(()),
    }
}
