//! The JSON dump matches `docs/dump/schema.json`, and the example reader can read it.

use super::dump;
use serde_json::Value;
use std::process::Command;

/// Lists where a value violates a schema. Knows only the keywords of JSON Schema that ours uses.
pub(super) fn faults(root: &Value, schema: &Value, value: &Value, place: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (word, rule) in schema.as_object().unwrap() {
        let holds = match word.as_str() {
            "title" | "description" | "$schema" | "$defs" => true,
            "$ref" => {
                let target = root.pointer(rule.as_str().unwrap().trim_start_matches('#')).unwrap();
                found.extend(faults(root, target, value, place));
                true
            }
            "anyOf" => rule.as_array().unwrap().iter().any(|one| faults(root, one, value, place).is_empty()),
            "const" => value == rule,
            "enum" => rule.as_array().unwrap().contains(value),
            "type" => match rule.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "integer" => value.is_i64() || value.is_u64(),
                "number" => value.is_number(),
                "null" => value.is_null(),
                other => panic!("no type {other}"),
            },
            "minimum" => value.as_f64() >= rule.as_f64(),
            "required" => {
                let names = rule.as_array().unwrap();
                names.iter().all(|name| value.get(name.as_str().unwrap()).is_some())
            }
            "additionalProperties" => {
                let known = schema["properties"].as_object().unwrap();
                value.as_object().is_none_or(|own| own.keys().all(|name| known.contains_key(name)))
            }
            "properties" => {
                for (name, rule) in rule.as_object().unwrap() {
                    let own = value.get(name);
                    found.extend(
                        own.map_or(Vec::new(), |own| faults(root, rule, own, &format!("{place}/{name}"))),
                    );
                }
                true
            }
            "items" | "prefixItems" => {
                let rules = |index: usize| if word == "items" { Some(rule) } else { rule.get(index) };
                for (index, own) in value.as_array().into_iter().flatten().enumerate() {
                    let of_item = |rule| faults(root, rule, own, &format!("{place}/{index}"));
                    found.extend(rules(index).map(of_item).unwrap_or_default());
                }
                true
            }
            "minItems" => value.as_array().is_none_or(|items| items.len() as u64 >= rule.as_u64().unwrap()),
            "maxItems" => value.as_array().is_none_or(|items| items.len() as u64 <= rule.as_u64().unwrap()),
            other => panic!("the schema uses `{other}`, which is not checked"),
        };
        if !holds {
            found.push(format!("{place}: {value} is not {word} {rule}"));
        }
    }
    found
}

/// The committed schema accepts the program's dumps, and rejects other values.
#[test]
fn the_json_dump_matches_its_schema() {
    let text =
        std::fs::read_to_string(shadowgraph_tests::repository().join("docs/dump/schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&text).unwrap();
    for technique in ["pcf", "evsm", "sdsm", "pcf+contact", "raytraced"] {
        let program = shadowgraph_tests::program().unwrap();
        let args = ["dump", "--technique", technique, "--format", "json"];
        let output = Command::new(program).args(args).output().unwrap();
        let mut dump: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(faults(&schema, &schema, &dump, ""), Vec::<String>::new(), "{technique}");
        dump["plan"]["passes"][0]["kind"] = "Paint".into();
        assert_eq!(faults(&schema, &schema, &dump, "").len(), 1, "an unknown kind");
    }
}

#[test]
fn the_example_reader_in_python_reads_a_dump() {
    if !shadowgraph_tests::on_path("python3") {
        return shadowgraph_tests::skip("python", "python3 is not installed");
    }
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("dump.json");
    std::fs::write(&file, dump("json")).unwrap();
    let reader = shadowgraph_tests::repository().join("docs/dump/read_dump.py");
    let output = Command::new("python3").arg(reader).arg(&file).output().unwrap();
    let (text, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{error}");
    assert!(text.contains("14 passes in 9 steps") && text.contains("lighting/forward"), "{text}");
    assert!(text.contains("cascades") && text.contains("64.0 MiB"), "{text}");
}
