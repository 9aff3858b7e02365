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

/// Checks that a draw can address every element: indices have 32 bits, and the base vertex is signed.
pub(super) fn addressable(vertices: u64, indices: u64) -> Result<(), Error> {
    let text = |what: &str| format!("the scene's number of {what}");
    check(vertices, "largest base vertex", i32::MAX as u64, || text("vertices"))?;
    check(indices, "largest first index", u64::from(u32::MAX), || text("indices"))
}

/// Checks the size of an image, and that it has the number of bytes of that size.
pub(super) fn image(limits: &wgpu::Limits, index: usize, image: &Image) -> Result<(), Error> {
    let max = u64::from(limits.max_texture_dimension_2d);
    for (side, pixels) in [("width", image.width), ("height", image.height)] {
        let what = || format!("image {index} \"{}\" {side}", image.name);
        check(u64::from(pixels), "max_texture_dimension_2d", max, what)?;
    }
    let bytes = u64::from(image.width) * u64::from(image.height) * 4;
    if bytes == 0 || image.rgba8.len() as u64 != bytes {
        return Err(Error::Inconsistent {
            what: format!("image {index} \"{}\"", image.name),
            reason: format!(
                "{} x {} pixels of 4 bytes need {bytes} bytes (at least 4), but it has {}",
                image.width,
                image.height,
                image.rgba8.len()
            ),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;

    fn bark(width: u32, height: u32, bytes: usize) -> Image {
        Image { name: "bark".to_owned(), width, height, rgba8: vec![0; bytes] }
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
        image(&limits, 3, &bark(4, 4, 64)).unwrap();
        assert_eq!(
            image(&limits, 3, &bark(4, 5, 80)).unwrap_err().to_string(),
            "image 3 \"bark\" height: 5 exceeds the adapter's max_texture_dimension_2d of 4"
        );
    }

    #[test]
    fn image_whose_bytes_do_not_match_its_size_is_an_error() {
        let limits = wgpu::Limits::default();
        assert!(matches!(image(&limits, 0, &bark(2, 2, 15)), Err(Error::Inconsistent { .. })));
        assert!(matches!(image(&limits, 0, &bark(0, 2, 0)), Err(Error::Inconsistent { .. })));
    }
}
