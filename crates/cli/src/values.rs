//! `--check-values`: what is checked, and what is reported.

use shadowgraph::RenderedFrame;
use shadowgraph::core::{ResourceDesc, ValueCheck, closest_name, did_you_mean};
use shadowgraph::options::OptionError;

use super::console;
use super::failure::Failure;

/// Parses ranges such as `light=0..1e4,ao=0..1`; without any, NaN and infinities are reported.
///
/// # Errors
/// A range that is not one, with what is expected.
pub(crate) fn parse(text: &str) -> Result<ValueCheck, OptionError> {
    let mut parts = text.split(',').filter(|part| !part.is_empty());
    parts.try_fold(ValueCheck::default(), |check, part| {
        let range = part.rsplit_once('=').and_then(|(texture, range)| {
            let (low, high) = range.split_once("..")?;
            let (low, high): (f32, f32) = (low.trim().parse().ok()?, high.trim().parse().ok()?);
            (low <= high && !texture.is_empty()).then_some((texture, low..=high))
        });
        let (texture, range) = range.ok_or_else(|| {
            let reason = format!("invalid range `{part}`; expected TEXTURE=LOW..HIGH, such as lit=0..1e4");
            OptionError::new("check_values", reason)
        })?;
        Ok(check.range(texture, range))
    })
}

/// Checks that ranges are of textures of the frame.
///
/// # Errors
/// A name that no texture has.
pub(crate) fn check_names(text: &str, frame: &RenderedFrame) -> Result<(), OptionError> {
    let names = || {
        let textures =
            frame.plan.resources().filter(|(_, found)| matches!(found.desc, ResourceDesc::Texture(_)));
        textures.map(|(id, texture)| (texture.name, frame.plan.resource_path(id)))
    };
    for part in text.split(',') {
        let Some((texture, _)) = part.rsplit_once('=') else { continue };
        if !names().any(|(name, path)| name == texture || path == texture) {
            let paths: Vec<String> = names().map(|(_, path)| path).collect();
            // Several textures can have a name; a list has their paths.
            let hint = match closest_name(texture, names().map(|(name, _)| name)) {
                Some(name) => format!("; did you mean `{name}`?"),
                None => did_you_mean(texture, paths.iter().map(String::as_str)),
            };
            return Err(OptionError::new(
                "check_values",
                format!("no texture has the name `{texture}`{hint}"),
            ));
        }
    }
    Ok(())
}

/// The checks of the frames of a command.
#[derive(Default)]
pub(crate) struct Findings {
    bad_frames: u32,
    /// The number of the first frame with bad values, and its report.
    first: Option<(u32, String)>,
}

impl Findings {
    /// Adds the report of a frame.
    pub(crate) fn add(&mut self, number: u32, frame: &RenderedFrame) {
        let Some(report) = &frame.values else { return };
        if !report.bad.is_empty() {
            self.bad_frames += 1;
            self.first.get_or_insert_with(|| (number, report.to_text(&frame.plan)));
        }
    }

    /// Prints the report of the first frame with bad values.
    ///
    /// # Errors
    /// If there is such a frame.
    pub(crate) fn finish(self, frame_count: u32) -> Result<(), Failure> {
        let Some((number, text)) = self.first else {
            return console::print("all values are finite and within their ranges\n");
        };
        console::print(&text)?;
        let message = match (frame_count, self.bad_frames) {
            (1, _) => "the frame has values that it should not have".into(),
            (_, bad) => format!(
                "{bad} of {frame_count} frames have values that they should not have, from frame {number} on"
            ),
        };
        Err(Failure { code: Failure::INPUT, message })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn ranges_are_parsed() {
        assert_eq!(parse("").unwrap(), ValueCheck::default());
        let expected = ValueCheck::default().range("lit", 0.0..=1e4).range("a=b", -1.0..=1.0);
        assert_eq!(parse("lit=0..1e4,a=b=-1..1").unwrap(), expected);
        for wrong in ["lit", "lit=", "lit=0", "lit=1..0", "lit=0..x", "=0..1", "lit=0..NaN"] {
            let error = parse(wrong).unwrap_err().to_string();
            assert!(error.contains(&format!("`{wrong}`; expected TEXTURE=LOW..HIGH")), "{error}");
        }
    }
}
