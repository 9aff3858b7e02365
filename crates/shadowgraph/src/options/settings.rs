//! `--settings FILE`: shadow settings in RON.

use super::OptionError;
use crate::ron_file;
use serde::Deserialize;
use shadowgraph_shadows::{ShadowSettings, Techniques};
use std::path::Path;

const OPTION: &str = "--settings";

/// Shadow settings as a file has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SettingsFile {
    /// The settings; what the file leaves out is the default.
    pub settings: ShadowSettings,
    /// Whether the file itself says how far shadows reach.
    pub has_distance: bool,
}

impl SettingsFile {
    /// Reads a RON file and checks every value, those of `techniques` too.
    ///
    /// # Errors
    /// When the file cannot be read, does not parse, has an unknown field, or a value is out of range: one
    /// line with the file, the place, and the field.
    pub fn load(file: &Path, techniques: &Techniques) -> Result<Self, OptionError> {
        let refused = |reason: String| OptionError::new(OPTION, format!("{}: {reason}", file.display()));
        let text =
            std::fs::read_to_string(file).map_err(|error| refused(format!("cannot be read: {error}")))?;
        let name = file.display().to_string();
        let refused = |wrong: ron_file::Wrong| OptionError::new(OPTION, wrong.to_string());
        let settings: ShadowSettings = ron_file::read(&name, &text).map_err(refused)?;
        techniques.check(&settings).map_err(|error| refused(wrong_setting(&name, &text, "", &error)))?;
        Ok(Self { settings, has_distance: has_distance(&text) })
    }

    /// What is wrong with settings that this file gave.
    pub(crate) fn wrong(file: &Path, error: &shadowgraph_shadows::Error) -> OptionError {
        let text = std::fs::read_to_string(file).unwrap_or_default();
        OptionError::new(OPTION, wrong_setting(&file.display().to_string(), &text, "", error).to_string())
    }
}

/// An error of checked settings, with the place of the field that it is about; `parents` is the path of the settings in the
/// file, with a point behind each.
pub(crate) fn wrong_setting(
    file: &str,
    text: &str,
    parents: &str,
    error: &shadowgraph_shadows::Error,
) -> ron_file::Wrong {
    use shadowgraph_shadows::Error as E;
    let field = match error {
        E::Setting { field, .. } => (*field).to_owned(),
        E::TechniqueSetting { technique, field, .. } => format!("techniques.{technique}.{field}"),
        E::Technique { technique: name, .. } | E::UnknownTechnique { name, .. } => {
            format!("techniques.{name}")
        }
        E::UnknownLight { entry, .. } | E::DuplicateLight { entry, .. } => format!("lights.{entry}.light"),
        E::MalformedSettings { technique, reason } => {
            let whose = format!("technique `{technique}`");
            return ron_file::wrong_inside(
                file,
                text,
                &format!("{parents}techniques.{technique}"),
                &whose,
                reason,
            );
        }
        _ => String::new(),
    };
    ron_file::wrong_field(file, text, &format!("{parents}{field}"), error)
}

/// The one field for which it matters whether it was left out.
fn has_distance(text: &str) -> bool {
    #[derive(Deserialize)]
    struct Distance {
        #[serde(default = "absent")]
        distance_m: f64,
    }
    fn absent() -> f64 {
        f64::NAN
    }
    ron_file::read_at(text).is_ok_and(|distance: Distance| !distance.distance_m.is_nan())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;
    use std::collections::BTreeMap;

    fn load(text: &str) -> Result<SettingsFile, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("settings.ron");
        std::fs::write(&file, text).unwrap();
        SettingsFile::load(&file, &Techniques::built_in()).map_err(|error| error.to_string())
    }

    #[test]
    fn an_empty_record_is_the_default() {
        assert_eq!(load("()"), Ok(SettingsFile::default()));
    }

    #[test]
    fn a_file_that_says_the_distance_is_told_from_one_that_does_not() {
        let cascades = "cascades: (count: 2, split: Practical(lambda: 0.5))";
        let without = load(&format!("({cascades})")).unwrap();
        assert!(!without.has_distance && without.settings.cascades.count == 2);
        let with = load(&format!("({cascades}, distance_m: 150.0)")).unwrap();
        assert!(with.has_distance);
        assert_eq!(with.settings, without.settings);
    }

    #[test]
    fn what_is_wrong_is_told_with_file_line_column_and_the_way_out() {
        let cases: &[(&str, &str)] = include!("settings/malformed.rs");
        assert!(cases.len() >= 59, "{}", cases.len());
        let mut wrong = Vec::new();
        for (text, expected) in cases {
            let error = load(text).err().unwrap_or_else(|| "it is taken".into());
            let error = error.replace("settings.ron", "s.ron");
            if !error.contains(expected) || error.lines().count() != 1 {
                wrong.push(format!("{text}\n  {error}\n  expected: {expected}"));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    #[test]
    fn an_unknown_field_is_named_with_the_file_and_the_place() {
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
    fn a_file_that_is_not_there_is_named() {
        let error = SettingsFile::load(Path::new("no/such/file.ron"), &Techniques::built_in())
            .unwrap_err()
            .to_string();
        assert!(error.starts_with("--settings: no/such/file.ron: cannot be read"), "{error}");
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
        // One has all fields, at their defaults.
        let all = files.iter().find(|file| file.contains("techniques: {},")).unwrap();
        assert_eq!(load(all).unwrap().settings, ShadowSettings::default());
        let written = ron::to_string(&ShadowSettings::default()).unwrap();
        let fields =
            written.split([',', '(', ' ']).filter_map(|part| part.split_once(':').map(|(name, _)| name));
        for field in fields.filter(|name| !name.is_empty()) {
            assert!(all.contains(&format!("{field}:")), "{field} is missing");
        }
        // And one has the settings of all techniques, at theirs.
        let own = files.iter().find(|file| file.contains("techniques: {\n")).unwrap();
        let own: TechniquesOnly = ron::from_str(own).unwrap();
        let techniques = Techniques::built_in();
        let kinds = techniques.kinds().iter().filter_map(|kind| Some((kind.name, kind.default_settings()?)));
        let tops = Techniques::modifiers().map(|(name, _, defaults)| (name, defaults));
        let defaults: BTreeMap<String, ron::Value> =
            kinds.chain(tops).map(|(name, text)| (name.into(), ron::from_str(&text).unwrap())).collect();
        assert_eq!(own.techniques, defaults);
    }

    #[derive(Deserialize)]
    struct TechniquesOnly {
        techniques: BTreeMap<String, ron::Value>,
    }
}
