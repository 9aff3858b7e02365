#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use super::*;
use crate::pipelines::Pipeline;
use serde_json::json;

mod warnings;

const FORWARD: &str = include_str!("../../../pipelines/forward.ron");

/// Loads a file of this text, from a folder where `part.ron` is another.
fn load_beside(text: &str, part: &str, choices: &Choices) -> Result<Pipeline, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.ron");
    std::fs::write(&file, text).unwrap();
    std::fs::write(folder.path().join("part.ron"), part).unwrap();
    let (nodes, techniques) = (Nodes::built_in(), Techniques::built_in());
    Pipeline::load(&file, &nodes, &techniques, choices).map_err(|error| {
        let text = error.to_string();
        text.replace(&format!("{}/", folder.path().display()), "")
    })
}

fn load(text: &str) -> Result<Pipeline, String> {
    load_beside(text, "", &Choices::default())
}

/// The file of `forward` with parts of it replaced.
fn changed(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(FORWARD.to_owned(), |text, (old, new)| {
        assert!(text.contains(old), "{old} is not in the file");
        text.replacen(old, new, 1)
    })
}

#[test]
fn what_is_wrong_is_told_with_file_line_column_and_the_way_out() {
    let cases: &[(&[(&str, &str)], &str)] = include!("tests/malformed.rs");
    assert!(cases.len() >= 55, "{}", cases.len());
    let mut wrong = Vec::new();
    for (changes, expected) in cases {
        let error = load(&changed(changes)).err().unwrap_or_else(|| "it is taken".into());
        if !error.contains(expected) || error.lines().count() != 1 {
            wrong.push(format!("{changes:?}\n  {error}\n  expected: {expected}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_that_are_cut_off_or_mixed_up_are_refused_in_one_line_or_taken() {
    // A corpus made from the built-in files: each cut off at every place, and with every character left out once.
    for name in crate::pipelines::BUILT_IN {
        let text = Pipeline::text_of(name).unwrap();
        let ends = text.char_indices().map(|(at, _)| text[..at].to_owned());
        let holes =
            text.char_indices().map(|(at, c)| format!("{}{}", &text[..at], &text[at + c.len_utf8()..]));
        for broken in ends.chain(holes) {
            if let Err(error) = PipelineFile::of_text(name, &broken, &Choices::default()) {
                let error = error.to_string();
                assert!(error.lines().count() == 1 && error.starts_with(name), "{error}");
            }
        }
    }
}

#[test]
fn a_file_without_changes_is_taken_whatever_the_order_of_its_nodes() {
    assert!(load(FORWARD).is_ok());
    let mut lines: Vec<&str> = FORWARD.lines().collect();
    let (first, last) = (
        lines.iter().position(|line| line.contains("kind: \"view\"")).unwrap(),
        lines.iter().position(|line| line.contains("tonemap")).unwrap(),
    );
    lines.swap(first, last);
    assert!(load(&lines.join("\n")).is_ok());
}

/// A file whose lighting is switched, by a parameter and by tiers.
fn switched() -> String {
    changed(&[
        (
            "nodes: [",
            "parameters: {\"prepass\": true, \"technique\": \"pcf\"},
             tiers: {\"low\": {\"prepass\": false}, \"high\": {\"technique\": \"evsm\"}},
             tier_for: {\"cpu\": \"low\"},
             nodes: [",
        ),
        ("(name: \"geometry\", ", "(name: \"geometry\", when: On(\"prepass\"), "),
        (
            "inputs: {\"surfaces\": \"geometry\"}",
            "inputs: {\"surfaces\": \"geometry\"}, settings: {\"technique\": \"$technique\"}",
        ),
        ("\"depth\": \"geometry\"},\n)", "\"depth\": [\"geometry\", \"lighting\"]},\n)"),
    ])
}

fn names(choices: &Choices) -> (Vec<String>, Option<String>) {
    let source = Arc::new(Source { name: "switched".into(), text: switched() });
    let document = Arc::new(Document::parse(&source).unwrap());
    let (nodes, techniques) = (Nodes::built_in(), Techniques::built_in());
    let file = PipelineFile::checked("switched", document, &nodes, &techniques, choices).unwrap();
    let nodes = file.resolved.nodes.iter().map(|node| node.name.clone()).collect();
    (nodes, file.technique.map(|technique| technique.name()))
}

#[test]
fn parameters_tiers_and_devices_choose_what_is_there() {
    let all = ["view", "geometry", "shadows", "lighting", "picture"];
    let without = ["view", "shadows", "lighting", "picture"];
    let tier = |tier: &str| Choices { tier: Some(tier.into()), ..Choices::default() };
    let of = |choices: &Choices| names(choices);
    assert_eq!(of(&Choices::default()), (all.map(String::from).to_vec(), Some("pcf".into())));
    assert_eq!(of(&tier("low")).0, without);
    assert_eq!(of(&tier("high")), (all.map(String::from).to_vec(), Some("evsm".into())));
    let on_cpu = Choices { device: Some("cpu"), ..Choices::default() };
    assert_eq!(of(&on_cpu).0, without);
    // What is asked for by name goes before what the tier says, and a tier that is asked for before that of the device.
    let both = Choices { parameters: vec![("prepass".into(), json!(true))], ..on_cpu.clone() };
    assert_eq!(of(&both).0, all);
    assert_eq!(of(&Choices { device: Some("cpu"), ..tier("high") }).0, all);
}

#[test]
fn a_choice_that_the_file_does_not_have_is_told_with_those_that_it_has() {
    let choose = |choices: Choices| load_beside(&switched(), "", &choices).err().unwrap();
    let parameter =
        |name: &str, value| Choices { parameters: vec![(name.into(), value)], ..Choices::default() };
    let error = choose(parameter("prepas", json!(true)));
    assert!(error.contains("there is no parameter `prepas`; did you mean `prepass`?"), "{error}");
    let error = choose(parameter("prepass", json!(3)));
    assert!(
        error.contains("parameter `prepass`: 3 is a number, and the parameter is true or false"),
        "{error}"
    );
    let error = choose(Choices { tier: Some("ultra".into()), ..Choices::default() });
    assert!(error.contains("there is no tier `ultra`; there is: low, high"), "{error}");
}

#[test]
fn a_file_includes_nodes_of_another_and_replaces_its_parameters() {
    let part = "(parameters: {\"technique\": \"pcf\"}, nodes: [(name: \"view\", kind: \"view\"), \
                (name: \"shadows\", kind: \"shadows\", settings: {\"technique\": \"$technique\"})])";
    let text = "(include: [\"part.ron\"], parameters: {\"technique\": \"msm\"}, nodes: [
        (name: \"lighting\", kind: \"forward\", inputs: {\"view\": \"view\", \"shadows\": \"shadows\"}),
        (name: \"picture\", kind: \"tonemap\", inputs: {\"light\": \"lighting\"}),
    ], outputs: {\"picture\": \"picture\"})";
    let pipeline = load_beside(text, part, &Choices::default()).unwrap();
    assert_eq!(pipeline.technique().map(|technique| technique.name()).as_deref(), Some("msm"));
    let wrong = |text: &str, part: &str| load_beside(text, part, &Choices::default()).err().unwrap();
    let error = wrong(text, &part.replace("shadows\", settings", "shadow\", settings"));
    assert!(error.starts_with("part.ron:1:") && error.contains("no kind of node `shadow`"), "{error}");
    let error = wrong(&text.replace("\"lighting\", kind", "\"view\", kind"), part);
    assert!(error.starts_with("mine.ron:2:16: there is a node `view` already, at part.ron:1:"), "{error}");
    let error = wrong(text, "(include: [\"mine.ron\"], nodes: [])");
    assert!(error.starts_with("part.ron:1:12: `mine.ron` includes itself by this"), "{error}");
    let error = wrong(&text.replace("part.ron", "parts.ron"), part);
    assert!(error.starts_with("mine.ron:1:12: `parts.ron` cannot be read: "), "{error}");
}

#[test]
fn what_is_drawn_over_is_read_before_and_named_by_what_draws_last() {
    let sky = |name: &str, from: &str| {
        format!(
            "(name: \"{name}\", kind: \"sky\", inputs: {{\"view\": \"view\", \"depth\": \"geometry\", \"light\": \"{from}\"}}),\n        "
        )
    };
    let with = |nodes: &str, light: &str| {
        changed(&[
            ("(name: \"picture\"", &format!("{nodes}(name: \"picture\"")),
            ("\"light\": \"lighting\", \"depth\"", &format!("\"light\": \"{light}\", \"depth\"")),
        ])
    };
    let two = sky("late", "early") + &sky("early", "lighting");
    assert!(load(&with(&two, "late")).is_ok());
    let error = load(&with(&two, "lighting")).err().unwrap();
    assert!(error.contains("`lighting.light` is drawn over: name \"late.light\""), "{error}");
    let twice = sky("one", "lighting") + &sky("other", "lighting");
    let error = load(&with(&twice, "one")).err().unwrap();
    assert!(error.contains("draws over what feeds its `light`, and so does `one`"), "{error}");
}

#[test]
fn the_schema_has_every_kind_with_its_ports_and_ranges() {
    let schema = schema(&Nodes::built_in());
    let kinds = schema["properties"]["nodes"]["items"]["anyOf"].as_array().unwrap();
    assert_eq!(kinds.len(), Nodes::built_in().kinds().len());
    let forward = kinds.iter().find(|kind| kind["properties"]["kind"]["const"] == "forward").unwrap();
    assert_eq!(forward["properties"]["inputs"]["required"], json!(["view", "shadows"]));
    let shadows = kinds.iter().find(|kind| kind["properties"]["kind"]["const"] == "shadows").unwrap();
    assert_eq!(shadows["properties"]["settings"]["properties"]["collected"]["default"], json!(false));
}

#[test]
fn what_is_wrong_with_a_choice_is_told_with_the_option_and_a_node_left_out_is_known() {
    let text = changed(&[
        ("nodes: [", "parameters: {\"blur\": 0.1, \"on\": false},\n nodes: ["),
        (
            "(name: \"picture\"",
            "(name: \"glow\", kind: \"bloom\", when: On(\"on\"), inputs: {\"light\": \"lighting\"}, settings: {\"strength\": \"$blur\"}),\n(name: \"picture\"",
        ),
        ("inputs: {\"light\": \"lighting\"})", "inputs: {\"light\": [\"glow\", \"lighting\"]})"),
    ]);
    let choose = |blur: f64, on: bool| Choices {
        parameters: vec![("blur".into(), json!(blur)), ("on".into(), json!(on))],
        ..Choices::default()
    };
    let error = load_beside(&text, "", &choose(5.0, true)).unwrap_err();
    assert!(
        error.ends_with(
            "it can be a number from 0 to 1, by the parameter `blur` (with --set blur=5.0 --set on=true)"
        ),
        "{error}"
    );
    assert!(load_beside(&text, "", &choose(0.5, false)).unwrap().leaves_out("glow"));
    assert!(!load_beside(&text, "", &choose(0.5, true)).unwrap().leaves_out("glow"));
}
