//! `shadowgraph nodes`.

use std::process::Command;

#[test]
fn nodes_lists_pipelines_techniques_and_their_settings() {
    let output = Command::new(shadowgraph_tests::program().unwrap()).arg("nodes").output().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    for name in ["forward", "screen_shadows", "minimal", "raytraced", "none", "+contact", "filter_taps: 24"] {
        assert!(text.contains(name), "{text}");
    }
}

/// Runs `nodes` with these arguments.
fn nodes(arguments: &[&str]) -> (Option<i32>, String, String) {
    let program = shadowgraph_tests::program().unwrap();
    let output = Command::new(program).arg("nodes").args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn nodes_describes_a_node_a_pipeline_a_technique_and_the_shared_settings() {
    let (code, text, _) = nodes(&["bloom"]);
    assert!(code == Some(0) && text.contains("setting  strength           0.06; 0 to 1: "), "{text}");
    let (_, text, _) = nodes(&["deferred"]);
    assert!(text.starts_with("pipeline deferred, as a file") && text.contains("input    gbuffer"), "{text}");
    let (_, text, _) = nodes(&["pcss"]);
    assert!(text.contains("filter_taps") && text.contains("24; 1 to 64"), "{text}");
    let (_, text, _) = nodes(&["pcf+contact"]);
    assert!(
        text.contains("technique pcf: ")
            && text.contains("technique +contact: ")
            && text.contains("length_texels"),
        "{text}"
    );
    let (_, text, _) = nodes(&["settings"]);
    assert!(text.contains("distance_m") && text.contains("150.0; 0.001 to 1000000 (metres)"), "{text}");
    let (code, _, error) = nodes(&["blom"]);
    assert!(
        code == Some(1) && error.lines().count() == 1 && error.ends_with("did you mean `bloom`?\n"),
        "{error}"
    );
    let (_, schema, _) = nodes(&["--schema"]);
    let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
    assert_eq!(schema["required"], serde_json::json!(["nodes"]));
    let (_, schema, _) = nodes(&["settings", "--schema"]);
    let schema: serde_json::Value = serde_json::from_str(&schema).unwrap();
    assert_eq!(
        schema["properties"]["techniques"]["properties"]["pcss"]["properties"]["filter_taps"]["maximum"],
        64
    );
    assert_eq!(schema["properties"]["cascades"]["properties"]["count"]["default"], 4);
}
