//! Colours.

use super::error::OptionError;
use glam::Vec3;
use shadowgraph_scene::linear_from_srgb;

/// The forms of a colour.
pub(super) const FORMS: &str = "#RRGGBB, or R,G,B (linear, each 0 to 1)";

/// Parses a colour into linear RGB.
pub(super) fn parse(option: &'static str, text: &str, others: &str) -> Result<Vec3, OptionError> {
    let color = match text.strip_prefix('#') {
        Some(digits) => from_hexadecimal(digits),
        None => from_numbers(text),
    };
    color.ok_or_else(|| {
        OptionError::new(option, format!("invalid value `{text}`; expected {others}, {FORMS}"))
    })
}

fn from_numbers(text: &str) -> Option<Vec3> {
    let channel = |text: &str| text.parse().ok().filter(|channel| (0.0..=1.0).contains(channel));
    let channels: Vec<f32> = text.split(',').map(channel).collect::<Option<_>>()?;
    <[f32; 3]>::try_from(channels).ok().map(Vec3::from)
}

fn from_hexadecimal(digits: &str) -> Option<Vec3> {
    let all = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let number = all.then(|| u32::from_str_radix(digits, 16).ok()).flatten()?;
    let [_, red, green, blue] = number.to_be_bytes().map(|channel| linear_from_srgb(channel) as f32);
    Some(Vec3::new(red, green, blue))
}
