//! Files of shadow settings in RON.

use super::error::OptionError;
use crate::ron_file::{self, ParseError};
use serde::Deserialize;
use shadowgraph_shadows::{SettingTracks, ShadowSettings, Techniques};
use std::path::Path;

const OPTION: &str = "settings";

/// The shadow settings of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SettingsFile {
    /// The settings; fields that the file leaves out have their defaults.
    pub settings: ShadowSettings,
    /// Whether the file sets the shadow distance.
    pub has_distance: bool,
}

impl SettingsFile {
    /// Reads a RON file and checks every value, also those of `techniques`.
    ///
    /// # Errors
    /// For a file that cannot be read or parsed, an unknown field, and a value out of range: one line with the file, the location
    /// and the field.
    pub fn load(file: &Path, techniques: &Techniques) -> Result<Self, OptionError> {
        let name = file.display().to_string();
        let text = std::fs::read_to_string(file)
            .map_err(|error| OptionError::new(OPTION, format!("{name}: cannot be read: {error}")))?;
        let error = |error: ParseError| OptionError::new(OPTION, error.to_string());
        let settings: ShadowSettings = ron_file::parse_file(&name, &text).map_err(error)?;
        let checked = techniques.check(&settings);
        checked.map_err(|setting| error(setting_error(&name, &text, "", &setting)))?;
        Ok(Self { settings, has_distance: has_distance(&text) })
    }

    /// Returns the error of settings that were read from this file.
    pub fn error(file: &Path, error: &shadowgraph_shadows::Error) -> OptionError {
        let text = std::fs::read_to_string(file).unwrap_or_default();
        OptionError::new(OPTION, setting_error(&file.display().to_string(), &text, "", error).to_string())
    }
}

/// Reads a RON file with settings over time and place, and checks them for settings that they do not change.
///
/// # Errors
/// For a file that cannot be read or parsed, an unknown setting, and a value out of range: one line with the file, the location and the
/// value.
pub fn read_tracks(file: &Path, base: &ShadowSettings) -> Result<SettingTracks, OptionError> {
    let name = file.display().to_string();
    let error = |reason: String| OptionError::new("tracks", reason);
    let text =
        std::fs::read_to_string(file).map_err(|reason| error(format!("{name}: cannot be read: {reason}")))?;
    let tracks: SettingTracks =
        ron_file::parse_file(&name, &text).map_err(|reason| error(reason.to_string()))?;
    tracks.check(base).map_err(|wrong| error(setting_error(&name, &text, "", &wrong).to_string()))?;
    Ok(tracks)
}

/// Adds the location of the field to an error of checked settings; `parents` is the path of the settings in the file, with a dot
/// after each part.
pub fn setting_error(
    file: &str,
    text: &str,
    parents: &str,
    error: &shadowgraph_shadows::Error,
) -> ParseError {
    use shadowgraph_shadows::Error as E;
    let field = match error {
        E::Setting { field, .. } => field.clone(),
        E::Technique { technique: name, .. } | E::UnknownTechnique { name, .. } => {
            format!("techniques.{name}")
        }
        E::UnknownLight { entry, .. } | E::DuplicateLight { entry, .. } => format!("lights.{entry}.light"),
        E::MalformedSettings { technique, reason } => {
            let owner = format!("technique `{technique}`");
            return ron_file::nested_error(
                file,
                text,
                &format!("{parents}techniques.{technique}"),
                &owner,
                reason,
            );
        }
        _ => String::new(),
    };
    ron_file::field_error(file, text, &format!("{parents}{field}"), error)
}

/// Returns whether a file sets the shadow distance.
fn has_distance(text: &str) -> bool {
    #[derive(Deserialize)]
    struct Distance {
        #[serde(default = "absent")]
        distance_m: f64,
    }
    fn absent() -> f64 {
        f64::NAN
    }
    ron_file::parse_text(text).is_ok_and(|distance: Distance| !distance.distance_m.is_nan())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;
    use shadowgraph_shadows::SettingType;
    use std::collections::BTreeMap;

    fn load(text: &str) -> Result<SettingsFile, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("settings.ron");
        std::fs::write(&file, text).unwrap();
        SettingsFile::load(&file, &Techniques::built_in()).map_err(|error| error.to_string())
    }

    #[test]
    fn an_empty_struct_is_the_default() {
        assert_eq!(load("()"), Ok(SettingsFile::default()));
    }

    #[test]
    fn a_file_that_sets_the_distance_is_known() {
        let cascades = "cascades: (count: 2, split: Practical(lambda: 0.5))";
        let without = load(&format!("({cascades})")).unwrap();
        assert!(!without.has_distance && without.settings.cascades.count == 2);
        let with = load(&format!("({cascades}, distance_m: 150.0)")).unwrap();
        assert!(with.has_distance);
        assert_eq!(with.settings, without.settings);
    }

    #[test]
    fn errors_name_the_file_line_and_column_and_what_is_expected() {
        let cases: &[(&str, &str)] = include!("settings/malformed.rs");
        assert!(cases.len() >= 59, "{}", cases.len());
        let mut wrong = Vec::new();
        for (text, expected) in cases {
            let error = load(text).err().unwrap_or_else(|| "it is accepted".into());
            let error = error.replace("settings.ron", "s.ron");
            if !error.contains(expected) || error.lines().count() != 1 {
                wrong.push(format!("{text}\n  {error}\n  expected: {expected}"));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    #[test]
    fn an_unknown_field_is_named_with_the_file_and_the_location() {
        let error = load("(no_such_field: 3)").unwrap_err();
        assert!(error.contains("settings.ron:1:") && error.contains("no_such_field"), "{error}");
        assert_eq!(error.lines().count(), 1);
    }

    #[test]
    fn a_value_out_of_range_is_named_with_the_range() {
        let error = load("(cascades: (count: 9))").unwrap_err();
        assert!(error.contains("cascades.count") && error.contains("0 to 8"), "{error}");
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = SettingsFile::load(Path::new("no/such/file.ron"), &Techniques::built_in())
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("settings: no/such/file.ron: cannot be read"), "{error}");
    }

    #[test]
    fn every_settings_file_in_the_documents_is_valid() {
        let page = include_str!("../../../../docs/shadows.md");
        let files: Vec<&str> =
            page.split("```ron\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
        assert!(files.len() >= 3, "{}", files.len());
        for file in &files {
            load(file).unwrap_or_else(|error| panic!("{error} in\n{file}"));
        }
        // One has all fields with their defaults.
        let all = files.iter().find(|file| file.contains("techniques: {},")).unwrap();
        assert_eq!(load(all).unwrap().settings, ShadowSettings::default());
        // And one has the settings of all techniques with theirs.
        let own = files.iter().find(|file| file.contains("techniques: {\n")).unwrap();
        let own: TechniquesOnly = ron::from_str(own).unwrap();
        let techniques = Techniques::built_in();
        let kinds = techniques.kinds().iter().filter_map(|kind| Some((kind.name, kind.default_settings()?)));
        let modifiers = Techniques::modifiers().map(|modifier| {
            let ty = SettingType::Struct(modifier.settings);
            (modifier.name, ty.ron(&ty.default_value()))
        });
        let defaults: BTreeMap<String, ron::Value> =
            kinds.chain(modifiers).map(|(name, text)| (name.into(), ron::from_str(&text).unwrap())).collect();
        assert_eq!(own.techniques, defaults);
    }

    #[derive(Deserialize)]
    struct TechniquesOnly {
        techniques: BTreeMap<String, ron::Value>,
    }
}
