//! The encoding of colours in 8 bits.

/// Decodes a channel of an sRGB colour (IEC 61966-2-1) as light, 0 to 1. Alpha is not encoded so.
///
/// ```
/// use shadowgraph_scene::linear_from_srgb;
/// assert_eq!((linear_from_srgb(0), linear_from_srgb(255)), (0.0, 1.0));
/// assert!((linear_from_srgb(188) - 0.5).abs() < 0.01);
/// ```
pub fn linear_from_srgb(channel: u8) -> f64 {
    let value = f64::from(channel) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}
