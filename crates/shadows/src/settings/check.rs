//! Ranges.

use crate::Error;

pub(crate) fn setting(field: &'static str, value: impl ToString, allowed: &'static str) -> Error {
    Error::Setting { field, value: value.to_string(), allowed }
}

/// Refuses NaN too.
pub(crate) fn in_range(
    field: &'static str,
    value: f32,
    min: f32,
    max: f32,
    allowed: &'static str,
) -> Result<(), Error> {
    if (min..=max).contains(&value) { Ok(()) } else { Err(setting(field, value, allowed)) }
}

pub(super) fn map_size(field: &'static str, size_px: u32) -> Result<(), Error> {
    if size_px.is_power_of_two() && (256..=8192).contains(&size_px) {
        Ok(())
    } else {
        Err(setting(field, size_px, "256, 512, 1024, 2048, 4096 or 8192 (pixels)"))
    }
}

/// A value that may be left out.
pub(super) fn in_range_if_some(
    field: &'static str,
    value: Option<f32>,
    min: f32,
    max: f32,
    allowed: &'static str,
) -> Result<(), Error> {
    value.map_or(Ok(()), |value| in_range(field, value, min, max, allowed))
}
