//! Shadow settings as JSON, the form in which pages hold them.

use serde_json::Value;
use shadowgraph::shadows::{ShadowSettings, Techniques};

use crate::error::Error;

/// Reads shadow settings from JSON as the schema [`Techniques::settings_schema`] describes them. Fields that it leaves out have their defaults.
/// The second result is whether it sets the shadow distance.
///
/// ```
/// use shadowgraph::shadows::Techniques;
/// let text = r#"{"cascades": {"count": 2}, "techniques": {"pcss": {"filter_taps": 16}}}"#;
/// let (settings, has_distance) = shadowgraph_web::settings_from_json(text, &Techniques::built_in())?;
/// assert_eq!((settings.cascades.count, has_distance), (2, false));
/// # Ok::<(), shadowgraph_web::Error>(())
/// ```
///
/// # Errors
/// For text that is not JSON, an unknown field, and a value out of range: the field and the range.
pub fn settings_from_json(text: &str, techniques: &Techniques) -> Result<(ShadowSettings, bool), Error> {
    let mut value: Value = serde_json::from_str(text).map_err(|error| Error::Settings(error.to_string()))?;
    let of_techniques = value.as_object_mut().and_then(|fields| fields.remove("techniques"));
    let has_distance = value.get("distance_m").is_some();
    let mut settings: ShadowSettings =
        serde_path_to_error::deserialize(value).map_err(|error| Error::Settings(error.to_string()))?;
    match of_techniques {
        Some(Value::Object(all)) => {
            for (name, value) in all {
                techniques.set_technique_settings(&name, &mut settings, value)?;
            }
        }
        Some(other) => return Err(Error::Settings(format!("techniques: expected an object, found {other}"))),
        None => {}
    }
    techniques.check(&settings)?;
    Ok((settings, has_distance))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn an_empty_object_is_the_default() {
        let read = settings_from_json("{}", &Techniques::built_in()).unwrap();
        assert_eq!(read, (ShadowSettings::default(), false));
    }

    #[test]
    fn errors_name_the_field_and_what_is_allowed() {
        for (text, expected) in [
            ("{", "settings: "),
            (r#"{"no_such_field": 1}"#, "no_such_field"),
            (r#"{"cascades": {"count": 9}}"#, "0 to 8"),
            (r#"{"cascades": {"count": 2.5}}"#, "settings: cascades.count: invalid type: floating point"),
            (r#"{"cascades": {"blend": "Foo"}}"#, "settings: cascades.blend: unknown variant `Foo`"),
            (r#"{"techniques": 3}"#, "techniques: expected an object"),
            (r#"{"techniques": {"pcss": {"filter_taps": 0}}}"#, "1 to 64"),
            (r#"{"techniques": {"none_such": {}}}"#, "none_such"),
        ] {
            let error = settings_from_json(text, &Techniques::built_in()).unwrap_err().to_string();
            assert!(error.contains(expected) && error.lines().count() == 1, "{text}: {error}");
        }
    }

    #[test]
    fn all_defaults_of_the_schema_are_accepted() {
        let techniques = Techniques::built_in();
        fn defaults(schema: &Value) -> Value {
            let fields = schema["properties"].as_object().into_iter().flatten();
            let value = |schema: &Value| match &schema["properties"] {
                Value::Object(_) if schema["default"].is_null() => defaults(schema),
                _ => schema["default"].clone(),
            };
            fields.map(|(name, schema)| (name.clone(), value(schema))).collect()
        }
        let all = defaults(&techniques.settings_schema());
        assert!(all["techniques"]["pcss"]["filter_taps"].is_number());
        let (settings, has_distance) = settings_from_json(&all.to_string(), &techniques).unwrap();
        assert!(has_distance);
        assert_eq!(settings.cascades, ShadowSettings::default().cascades);
    }
}
