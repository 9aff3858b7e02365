//! Variants of shadow settings, to compare.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};
use shadowgraph_shadows::{ShadowSettings, Techniques};

use shadowgraph::options::setting_error;
use shadowgraph::ron_file;

use crate::Error;

/// Shadow settings with a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Name in tables, after that of the technique.
    pub name: String,
    /// The settings. Fields that a file leaves out have their default values.
    pub settings: ShadowSettings,
}

/// A file of settings to compare.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VariantSet {
    /// The variants: at least one, with unique names.
    pub variants: Vec<Variant>,
}

impl VariantSet {
    /// Reads variants from RON; errors name `file`.
    ///
    /// # Errors
    /// [`Error::File`] with line and column, or the variant and its error.
    pub fn parse(text: &str, file: &Path, techniques: &Techniques) -> Result<Self, Error> {
        let file = file.display().to_string();
        let error = |path: &str, problem: &str| ron_file::field_error(&file, text, path, problem);
        let set: Self = ron_file::parse_file(&file, text)?;
        if set.variants.is_empty() {
            return Err(error("variants", "expected at least one variant").into());
        }
        let mut names = BTreeSet::new();
        for (index, Variant { name, settings }) in set.variants.iter().enumerate() {
            let at = format!("variants.{index}.name");
            if name.trim().is_empty() {
                return Err(error(&at, "the name of a variant must not be empty").into());
            }
            if !names.insert(name) {
                return Err(error(&at, &format!("duplicate variant name `{name}`")).into());
            }
            let parents = format!("variants.{index}.settings.");
            let checked = techniques.check(settings);
            checked.map_err(|error| setting_error(&file, text, &parents, &error))?;
        }
        Ok(set)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn error_of(text: &str) -> String {
        VariantSet::parse(text, Path::new("mine.ron"), &Techniques::built_in()).unwrap_err().to_string()
    }

    #[test]
    fn fields_that_a_variant_leaves_out_have_default_values() {
        let text = r#"(variants: [(name: "one cascade", settings: (cascades: (count: 1)))])"#;
        let set = VariantSet::parse(text, Path::new("mine.ron"), &Techniques::built_in()).unwrap();
        let mut one = ShadowSettings::default();
        one.cascades.count = 1;
        assert_eq!(set.variants, [Variant { name: "one cascade".into(), settings: one }]);
    }

    #[test]
    fn the_file_in_the_documents_is_valid() {
        let text = include_str!("../../../docs/variants.ron");
        assert!(
            VariantSet::parse(text, Path::new("docs/variants.ron"), &Techniques::built_in())
                .unwrap()
                .variants
                .len()
                > 20
        );
    }

    #[test]
    fn errors_are_one_line_with_file_and_variant() {
        for (text, part) in [
            ("(variants: [])", "mine.ron:1:12: expected at least one variant"),
            (
                r#"(variants: [(name: " ", settings: ())])"#,
                "mine.ron:1:20: the name of a variant must not be empty",
            ),
            (
                r#"(variants: [(name: "a", settings: ()), (name: "a", settings: ())])"#,
                "mine.ron:1:47: duplicate variant name `a`",
            ),
            (r#"(variants: [(name: "a", settings: (distance_m: 0.0))])"#, ":48: invalid value: `distance_m`"),
            (r#"(variants: [(name: "a", settings: (distance: 1.0))])"#, "distance"),
        ] {
            let error = error_of(text);
            assert!(
                error.starts_with("mine.ron:1:") && error.contains(part) && error.lines().count() == 1,
                "{error}"
            );
        }
    }
}
