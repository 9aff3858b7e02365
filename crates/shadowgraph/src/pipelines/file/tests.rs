#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use super::*;
use crate::pipelines::Pipeline;
use serde_json::json;

mod warnings;

const FORWARD: &str = include_str!("../../../pipelines/minimal_lit.ron");

fn load_with(text: &str, parameters: &Parameters) -> Result<Pipeline, String> {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("mine.ron");
    std::fs::write(&file, text).unwrap();
    let (nodes, techniques) = (Nodes::built_in(), Techniques::built_in());
    Pipeline::load(&file, &nodes, &techniques, parameters).map_err(|error| {
        let text = error.to_string();
        text.replace(&format!("{}/", directory.path().display()), "")
    })
}

fn load(text: &str) -> Result<Pipeline, String> {
    load_with(text, &Parameters::default())
}

/// The file of `minimal_lit` with parts of it replaced.
fn changed(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(FORWARD.to_owned(), |text, (old, new)| {
        assert!(text.contains(old), "{old} is not in the file");
        text.replacen(old, new, 1)
    })
}

#[test]
fn errors_name_the_file_line_and_column_and_what_is_expected() {
    let cases: &[(&[(&str, &str)], &str)] = include!("tests/malformed.rs");
    assert!(cases.len() >= 53, "{}", cases.len());
    let mut wrong = Vec::new();
    for (changes, expected) in cases {
        let error = load(&changed(changes)).err().unwrap_or_else(|| "it is accepted".into());
        if !error.contains(expected) || error.lines().count() != 1 {
            wrong.push(format!("{changes:?}\n  {error}\n  expected: {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn truncated_and_damaged_files_are_refused_in_one_line_or_accepted() {
    // Each built-in file, truncated at every character, and with every character removed once.
    for name in crate::pipelines::BUILT_IN {
        let text = Pipeline::built_in_text(name).unwrap();
        let ends = text.char_indices().map(|(at, _)| text[..at].to_owned());
        let holes =
            text.char_indices().map(|(at, c)| format!("{}{}", &text[..at], &text[at + c.len_utf8()..]));
        for broken in ends.chain(holes) {
            if let Err(error) = PipelineFile::parse(name, &broken, &Parameters::default()) {
                let error = error.to_string();
                assert!(error.lines().count() == 1 && error.starts_with(name), "{error}");
            }
        }
    }
}

#[test]
fn a_file_is_valid_in_any_order_of_its_nodes() {
    assert!(load(FORWARD).is_ok());
    let mut lines: Vec<&str> = FORWARD.lines().collect();
    let (first, last) = (
        lines.iter().position(|line| line.contains("kind: \"view\"")).unwrap(),
        lines.iter().position(|line| line.contains("tonemap")).unwrap(),
    );
    lines.swap(first, last);
    assert!(load(&lines.join("\n")).is_ok());
}

#[test]
fn a_file_with_former_names_of_ports_outputs_and_settings_gives_the_same_pipeline() {
    const DEBUG: &str = include_str!("../../../pipelines/debug_cascades.ron");
    let with_fxaa = |port: &str| {
        let smooth = format!(
            "\n(name: \"smooth\", kind: \"fxaa\", inputs: {{\"{port}\": \"overlay.{port}\"}}),\n    ],"
        );
        DEBUG
            .replace("\n    ],", &smooth)
            .replace("\"image\": \"overlay\"", &format!("\"{port}\": \"smooth.{port}\""))
    };
    let former = with_fxaa("picture").replace("\"image\": \"tonemap\"", "\"picture\": \"tonemap.picture\"");
    assert!(former.matches("picture").count() == 6 && !former.contains("\"image"), "{former}");
    let connections = |text: &str| {
        let resolved = PipelineFile::parse("mine", text, &Parameters::default()).unwrap().resolved;
        let inputs = |node: &ResolvedNode| {
            node.inputs.iter().map(|(port, value)| (port.name, *value)).collect::<Vec<_>>()
        };
        let nodes: Vec<_> = resolved.nodes.iter().map(|node| (node.name.clone(), inputs(node))).collect();
        (nodes, resolved.image, resolved.image_output)
    };
    assert_eq!(connections(&former), connections(&with_fxaa("image")));
    let setting = ("inputs: {\"surfaces\": \"geometry\"}", "settings: {\"collected\": true}");
    assert!(load(&changed(&[setting])).unwrap().has_screen_shadows());
    let both = changed(&[("outputs: {", "outputs: {\"picture\": \"tonemap\", ")]);
    let error = load(&both).err().unwrap();
    assert!(
        error.contains("unknown output `picture` of a pipeline; expected one of: image, light"),
        "{error}"
    );
}

/// A file whose prepass and technique are parameters.
fn switched() -> String {
    changed(&[
        ("nodes: [", "parameters: {\"prepass\": true, \"technique\": \"pcf\"},\n nodes: ["),
        ("(name: \"geometry\", ", "(name: \"geometry\", when: On(\"prepass\"), "),
        (
            "inputs: {\"surfaces\": \"geometry\"}",
            "inputs: {\"surfaces\": \"geometry\"}, settings: {\"technique\": \"$technique\"}",
        ),
        ("\"depth\": \"geometry\"},\n)", "\"depth\": [\"geometry\", \"lighting\"]},\n)"),
    ])
}

fn set(name: &str, value: serde_json::Value) -> Parameters {
    Parameters(vec![(name.into(), value)])
}

fn names(text: &str, parameters: &Parameters) -> (Vec<String>, Option<String>) {
    let file = PipelineFile::parse("switched", text, parameters).unwrap();
    let nodes = file.resolved.nodes.iter().map(|node| node.name.clone()).collect();
    (nodes, file.technique.map(|technique| technique.name()))
}

#[test]
fn parameters_choose_the_nodes_and_the_technique() {
    let all = ["view", "geometry", "shadows", "lighting", "tonemap"];
    let without = ["view", "shadows", "lighting", "tonemap"];
    let with = |parameters: &Parameters| names(&switched(), parameters);
    assert_eq!(with(&Parameters::default()), (all.map(String::from).to_vec(), Some("pcf".into())));
    assert_eq!(with(&set("prepass", json!(false))).0, without);
    let evsm = with(&set("technique", json!("evsm")));
    assert_eq!(evsm, (all.map(String::from).to_vec(), Some("evsm".into())));
    let opposite = switched().replace("when: On(\"prepass\")", "when: Not(On(\"prepass\"))");
    assert_eq!(names(&opposite, &Parameters::default()).0, without);
    assert_eq!(names(&opposite, &set("prepass", json!(false))).0, all);
}

#[test]
fn an_unknown_parameter_or_one_of_another_type_is_refused() {
    let error = |parameters| load_with(&switched(), &parameters).err().unwrap();
    let unknown = error(set("prepas", json!(true)));
    assert!(unknown.contains("unknown parameter `prepas`; did you mean `prepass`?"), "{unknown}");
    let other_type = error(set("prepass", json!(3)));
    assert!(
        other_type.contains("parameter `prepass`: expected a boolean, found 3, a number"),
        "{other_type}"
    );
}

#[test]
fn what_is_overwritten_in_place_is_read_before_and_outputs_name_the_last_node() {
    let fog = |name: &str, from: &str| {
        format!(
            "(name: \"{name}\", kind: \"fog\", inputs: {{\"view\": \"view\", \"shadows\": \"shadows\", \"depth\": \"geometry\", \"light\": \"{from}\"}}),\n        "
        )
    };
    let with = |nodes: &str, light: &str| {
        changed(&[
            ("(name: \"tonemap\"", &format!("{nodes}(name: \"tonemap\"")),
            ("\"light\": \"lighting\", \"depth\"", &format!("\"light\": \"{light}\", \"depth\"")),
        ])
    };
    let two = fog("late", "early") + &fog("early", "lighting");
    assert!(load(&with(&two, "late")).is_ok());
    let error = load(&with(&two, "lighting")).err().unwrap();
    assert!(error.contains("`lighting.light` is overwritten in place: name `late.light`"), "{error}");
    let twice = fog("one", "lighting") + &fog("other", "lighting");
    let error = load(&with(&twice, "one")).err().unwrap();
    assert!(error.contains("overwrites its input `light` in place, and so does `one`"), "{error}");
}

#[test]
fn the_schema_has_every_kind_with_its_ports_and_ranges() {
    let schema = schema::schema(&Nodes::built_in());
    let kinds = schema["properties"]["nodes"]["items"]["anyOf"].as_array().unwrap();
    assert_eq!(kinds.len(), Nodes::built_in().kinds().len());
    let forward = kinds.iter().find(|kind| kind["properties"]["kind"]["const"] == "forward").unwrap();
    assert_eq!(forward["properties"]["inputs"]["required"], json!(["view", "shadows"]));
    let shadows = kinds.iter().find(|kind| kind["properties"]["kind"]["const"] == "shadows").unwrap();
    assert_eq!(shadows["properties"]["settings"]["properties"]["screen_space"]["default"], json!(false));
}

#[test]
fn an_error_due_to_a_parameter_names_it_and_a_disabled_node_is_known() {
    let text = changed(&[
        ("nodes: [", "parameters: {\"blur\": 0.1, \"on\": false},\n nodes: ["),
        (
            "(name: \"tonemap\"",
            "(name: \"glow\", kind: \"bloom\", when: On(\"on\"), inputs: {\"light\": \"lighting\"}, settings: {\"strength\": \"$blur\"}),\n(name: \"tonemap\"",
        ),
        ("inputs: {\"light\": \"lighting\"})", "inputs: {\"light\": [\"glow\", \"lighting\"]})"),
    ]);
    let set = |blur: f64, on: bool| Parameters(vec![("blur".into(), json!(blur)), ("on".into(), json!(on))]);
    let error = load_with(&text, &set(5.0, true)).unwrap_err();
    assert!(error.ends_with(", set by the parameter `blur` (with blur=5.0 on=true)"), "{error}");
    assert!(load_with(&text, &set(0.5, false)).unwrap().is_disabled("glow"));
    assert!(!load_with(&text, &set(0.5, true)).unwrap().is_disabled("glow"));
}
