//! Checks against the limits of a device, made before they are exceeded.

use crate::error::Error;
use crate::material::Image;

/// Checks a value against a limit of the device.
fn check(value: u64, limit: &'static str, max: u64, what: impl FnOnce() -> String) -> Result<(), Error> {
    if value <= max { Ok(()) } else { Err(Error::Limit { what: what(), value, limit, max }) }
}

/// Checks the size of a buffer, bytes.
pub(super) fn buffer(limits: &wgpu::Limits, what: &str, bytes: u64) -> Result<(), Error> {
    check(bytes, "max_buffer_size", limits.max_buffer_size, || format!("{what} (bytes)"))
}

/// Checks the size of a buffer that is bound as storage as a whole, bytes.
pub(super) fn storage(limits: &wgpu::Limits, what: &str, bytes: u64) -> Result<(), Error> {
    buffer(limits, what, bytes)?;
    let max = limits.max_storage_buffer_binding_size;
    check(bytes, "max_storage_buffer_binding_size", max, || format!("{what} (bytes)"))
}

/// Checks that draws can address every element.
pub(super) fn addressable(what: &str, elements: u64, max: u64) -> Result<(), Error> {
    check(elements, "largest index", max, || format!("the scene's number of {what}"))
}

/// Checks the size of an image.
pub(super) fn image(limits: &wgpu::Limits, image: &Image) -> Result<(), Error> {
    let max = u64::from(limits.max_texture_dimension_2d);
    for (side, pixels) in [("width", image.width), ("height", image.height)] {
        let what = || format!("image \"{}\" {side}", image.name);
        check(u64::from(pixels), "max_texture_dimension_2d", max, what)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;

    fn bark(width: u32, height: u32) -> Image {
        let rgba8 = vec![0; (width * height * 4) as usize];
        Image::new("bark", width, height, rgba8)
    }

    #[test]
    fn buffer_over_a_limit_names_the_limit_and_both_values() {
        let limits = wgpu::Limits {
            max_buffer_size: 100,
            max_storage_buffer_binding_size: 50,
            ..wgpu::Limits::default()
        };
        assert_eq!(
            buffer(&limits, "vertices", 101).unwrap_err().to_string(),
            "vertices (bytes): 101 exceeds the adapter's max_buffer_size of 100"
        );
        assert_eq!(
            storage(&limits, "instances", 51).unwrap_err().to_string(),
            "instances (bytes): 51 exceeds the adapter's max_storage_buffer_binding_size of 50"
        );
        storage(&limits, "instances", 50).unwrap();
    }

    #[test]
    fn image_over_the_limit_names_the_side() {
        let limits = wgpu::Limits { max_texture_dimension_2d: 4, ..wgpu::Limits::default() };
        image(&limits, &bark(4, 4)).unwrap();
        assert_eq!(
            image(&limits, &bark(4, 5)).unwrap_err().to_string(),
            "image \"bark\" height: 5 exceeds the adapter's max_texture_dimension_2d of 4"
        );
    }
}
