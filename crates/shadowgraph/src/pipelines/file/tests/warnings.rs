//! What is valid and serves nothing, or not what it is for.

use super::*;

fn warnings(text: &str, part: &str) -> Vec<String> {
    let pipeline = load_beside(text, part, &Choices::default()).unwrap();
    let own = |warning: &PipelineError| {
        let text = warning.to_string();
        text.rsplit('/').next().unwrap().to_owned()
    };
    pipeline.warnings().iter().map(own).collect()
}

#[test]
fn nodes_that_lead_to_no_output_are_told_each_with_its_place() {
    let text = changed(&[(
        "(name: \"picture\"",
        "(name: \"pyramid\", kind: \"hi_z\", inputs: {\"depth\": \"geometry\"}),
        (name: \"occlusion\", kind: \"ssao\", inputs: {\"view\": \"view\", \"depth\": \"geometry\"}),
        (name: \"clusters\", kind: \"clusters\", inputs: {\"view\": \"occlusion\"}),
        (name: \"picture\"",
    )]);
    let told = warnings(&text, "");
    let [pyramid, occlusion, clusters] = &told[..] else { panic!("{told:?}") };
    let line = 1 + text[..text.find("pyramid").unwrap()].matches('\n').count();
    let place = |line| format!("mine.ron:{line}:");
    assert!(pyramid.starts_with(&place(line)), "{pyramid}");
    assert!(pyramid.contains("`pyramid` (hi_z) leads to no output: name it in the inputs"), "{pyramid}");
    // What feeds only those leads to none either.
    assert!(occlusion.starts_with(&place(line + 1)) && clusters.starts_with(&place(line + 2)), "{told:?}");
}

#[test]
fn a_node_that_any_choice_makes_use_of_or_that_is_not_there_is_not_told() {
    assert_eq!(warnings(&switched(), ""), [""; 0]);
    // The first of a list is taken where it is there, and the second where not.
    let text = changed(&[
        ("inputs: {\"light\": \"lighting\"})", "inputs: {\"light\": [\"glow.light\", \"lighting\"]})"),
        ("nodes: [", "parameters: {\"glow\": true}, nodes: ["),
        (
            "(name: \"picture\"",
            "(name: \"glow\", kind: \"bloom\", when: On(\"glow\"), inputs: {\"light\": \"lighting\"}),
        (name: \"picture\"",
        ),
    ]);
    assert_eq!(warnings(&text, ""), [""; 0]);
    // One that is not there now says nothing.
    let off = text.replace("[\"glow.light\", \"lighting\"]", "\"lighting\"");
    assert_eq!(warnings(&off, "").len(), 1);
    assert_eq!(warnings(&off.replace("\"glow\": true", "\"glow\": false"), ""), [""; 0]);
}

#[test]
fn parameters_that_nothing_asks_for_are_told_and_those_for_an_included_node_are_not() {
    let part = "(nodes: [(name: \"view\", kind: \"view\"), \
                (name: \"shadows\", kind: \"shadows\", settings: {\"technique\": \"$technique\"})])";
    let text = "(include: [\"part.ron\"], parameters: {\"technique\": \"msm\", \"bloom\": 0.1}, nodes: [
        (name: \"lighting\", kind: \"forward\", inputs: {\"view\": \"view\", \"shadows\": \"shadows\"}),
        (name: \"picture\", kind: \"tonemap\", inputs: {\"light\": \"lighting\"}),
    ], tiers: {\"low\": {\"bloom\": 0.0}}, outputs: {\"picture\": \"picture\"})";
    let told = warnings(text, part);
    let problem = "mine.ron:1:58: nothing asks for the parameter `bloom`: a setting does by \"$bloom\", or a node by `when`";
    assert_eq!(told, [problem]);
}

#[test]
fn temporal_anti_aliasing_without_jitter_is_told_and_so_is_jitter_without_it() {
    const TAA: (&str, &str) = (
        "(name: \"picture\"",
        "(name: \"temporal\", kind: \"taa\", inputs: {\"view\": \"view\", \"light\": \"lighting\", \"depth\": \"geometry\"}),
        (name: \"picture\"",
    );
    const TAKEN: (&str, &str) = ("inputs: {\"light\": \"lighting\"})", "inputs: {\"light\": \"temporal\"})");
    const JITTER: (&str, &str) = ("kind: \"view\"", "kind: \"view\", settings: {\"jitter\": true}");
    let still = "mine.ron:8:16: `temporal` (taa) smooths no edge without jitter: give `view` settings: {\"jitter\": true}";
    assert_eq!(warnings(&changed(&[TAKEN, TAA]), ""), [still]);
    assert_eq!(warnings(&changed(&[TAKEN, TAA, JITTER]), ""), [""; 0]);
    // By way of a node that passes the camera on.
    let through = [
        TAKEN,
        (
            TAA.0,
            "(name: \"clusters\", kind: \"clusters\", inputs: {\"view\": \"view\"}),\n(name: \"picture\"",
        ),
        (TAA.0, &*TAA.1.replacen("\"view\": \"view\"", "\"view\": \"clusters\"", 1)),
        JITTER,
    ];
    assert_eq!(warnings(&changed(&through), ""), [""; 0]);
    let swims = "mine.ron:4:49: `view` jitters and no `taa` takes it, so edges swim: add one, or take the setting out";
    assert_eq!(warnings(&changed(&[JITTER]), ""), [swims]);
}

#[test]
fn built_in_pipelines_and_those_of_the_documents_have_nothing_that_serves_nothing() {
    let page = include_str!("../../../../../../docs/pipelines.md");
    let (_, after) = page.split_once("```ron\n").unwrap();
    let (of_page, _) = after.split_once("```").unwrap();
    let built_in = crate::pipelines::BUILT_IN.iter().map(|name| Pipeline::text_of(name).unwrap());
    for text in built_in.chain([of_page, include_str!("../../../../../../docs/everything.ron")]) {
        assert_eq!(warnings(text, ""), [""; 0], "{text}");
    }
}
