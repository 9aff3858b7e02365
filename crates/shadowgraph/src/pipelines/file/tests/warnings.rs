//! Warnings about valid files.

use super::*;

fn warnings(text: &str) -> Vec<String> {
    let pipeline = load(text).unwrap();
    let own = |warning: &PipelineError| {
        let text = warning.to_string();
        text.rsplit('/').next().unwrap().to_owned()
    };
    pipeline.warnings().iter().map(own).collect()
}

#[test]
fn nodes_that_no_output_depends_on_are_reported_with_their_locations() {
    let text = changed(&[(
        "(name: \"tonemap\"",
        "(name: \"pyramid\", kind: \"hi_z\", inputs: {\"depth\": \"geometry\"}),
        (name: \"occlusion\", kind: \"ssao\", inputs: {\"view\": \"view\", \"depth\": \"geometry\"}),
        (name: \"clusters\", kind: \"clusters\", inputs: {\"view\": \"occlusion\"}),
        (name: \"tonemap\"",
    )]);
    let found = warnings(&text);
    let [pyramid, occlusion, clusters] = &found[..] else { panic!("{found:?}") };
    let line = 1 + text[..text.find("pyramid").unwrap()].matches('\n').count();
    let location = |line| format!("mine.ron:{line}:");
    assert!(pyramid.starts_with(&location(line)), "{pyramid}");
    assert!(pyramid.contains("no output depends on `pyramid` (hi_z): connect it"), "{pyramid}");
    // Nor does one depend on what only those read.
    assert!(
        occlusion.starts_with(&location(line + 1)) && clusters.starts_with(&location(line + 2)),
        "{found:?}"
    );
}

#[test]
fn a_node_that_is_used_with_other_parameters_or_is_disabled_is_not_reported() {
    assert_eq!(warnings(&switched()), [""; 0]);
    // The first of a list counts if it is enabled, else the second.
    let text = changed(&[
        ("inputs: {\"light\": \"lighting\"})", "inputs: {\"light\": [\"glow.light\", \"lighting\"]})"),
        ("nodes: [", "parameters: {\"glow\": true}, nodes: ["),
        (
            "(name: \"tonemap\"",
            "(name: \"glow\", kind: \"bloom\", when: On(\"glow\"), inputs: {\"light\": \"lighting\"}),
        (name: \"tonemap\"",
        ),
    ]);
    assert_eq!(warnings(&text), [""; 0]);
    // A disabled node is not reported.
    let off = text.replace("[\"glow.light\", \"lighting\"]", "\"lighting\"");
    assert_eq!(warnings(&off).len(), 1);
    assert_eq!(warnings(&off.replace("\"glow\": true", "\"glow\": false")), [""; 0]);
}

#[test]
fn unused_parameters_are_reported() {
    let text = changed(&[
        ("nodes: [", "parameters: {\"technique\": \"msm\", \"bloom\": 0.1}, nodes: ["),
        (
            "inputs: {\"surfaces\": \"geometry\"}",
            "inputs: {\"surfaces\": \"geometry\"}, settings: {\"technique\": \"$technique\"}",
        ),
    ]);
    let expected =
        "mine.ron:3:38: unused parameter `bloom`: use it as \"$bloom\" in a setting, or in a node's `when`";
    assert_eq!(warnings(&text), [expected]);
}

#[test]
fn temporal_anti_aliasing_without_jitter_is_reported_and_jitter_without_it() {
    const TAA: (&str, &str) = (
        "(name: \"tonemap\"",
        "(name: \"temporal\", kind: \"taa\", inputs: {\"view\": \"view\", \"light\": \"lighting\", \"depth\": \"geometry\"}),
        (name: \"tonemap\"",
    );
    const USED: (&str, &str) = ("inputs: {\"light\": \"lighting\"})", "inputs: {\"light\": \"temporal\"})");
    const JITTER: (&str, &str) = ("kind: \"view\"", "kind: \"view\", settings: {\"jitter\": true}");
    let still = "mine.ron:8:16: `temporal` (taa) has no effect on edges without jitter: add settings: {\"jitter\": true} to `view`";
    assert_eq!(warnings(&changed(&[USED, TAA])), [still]);
    assert_eq!(warnings(&changed(&[USED, TAA, JITTER])), [""; 0]);
    // Through a node that passes the camera on.
    let through = [
        USED,
        (
            TAA.0,
            "(name: \"clusters\", kind: \"clusters\", inputs: {\"view\": \"view\"}),\n(name: \"tonemap\"",
        ),
        (TAA.0, &*TAA.1.replacen("\"view\": \"view\"", "\"view\": \"clusters\"", 1)),
        JITTER,
    ];
    assert_eq!(warnings(&changed(&through)), [""; 0]);
    let shimmers = "mine.ron:4:49: `view` jitters the camera without a `taa` node, so edges shimmer: add `taa` or remove the setting";
    assert_eq!(warnings(&changed(&[JITTER])), [shimmers]);
}

#[test]
fn built_in_pipelines_and_those_of_the_documents_have_no_warnings() {
    let page = include_str!("../../../../../../docs/pipelines.md");
    let (_, after) = page.split_once("```ron\n").unwrap();
    let (of_page, _) = after.split_once("```").unwrap();
    let built_in = crate::pipelines::BUILT_IN.iter().map(|name| Pipeline::built_in_text(name).unwrap());
    for text in built_in.chain([of_page, include_str!("../../../../../../docs/everything.ron")]) {
        assert_eq!(warnings(text), [""; 0], "{text}");
    }
}
