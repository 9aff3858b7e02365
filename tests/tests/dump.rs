//! What `shadowgraph dump` prints for the demo scene.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::io::Write as _;
use std::process::{Command, Stdio};

fn dump(format: &str) -> String {
    let program = shadowgraph_tests::program().unwrap();
    let output = Command::new(program).args(["dump", "--format", format]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn text_has_passes_by_node_reasons_lights_and_at_most_110_columns() {
    let text = dump("text");
    for expected in [
        "  shadows/cascades\n",
        "  lighting\n",
        "clear 0: the pass clears it",
        "store: `lighting/forward` needs it",
        "resources\n",
        "slots (",
        "lights\n",
        "casts shadows",
    ] {
        assert!(text.contains(expected), "{expected} is missing in\n{text}");
    }
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(110), "{widest:?} columns\n{text}");
}

#[test]
fn json_has_the_plan_its_reasons_and_the_lights() {
    let json: serde_json::Value = serde_json::from_str(&dump("json")).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["lights"].as_array().unwrap().len(), 4);
    assert!(json["plan"]["passes"].as_array().unwrap().len() > 5);
    assert!(json["reasons"].as_array().unwrap().iter().all(|reason| reason["because"].is_string()));
    assert_eq!(dump("json"), dump("json"), "the same frame, the same bytes");
}

#[test]
fn graphviz_draws_the_dot_dump() {
    let dot = dump("dot");
    let graphviz = Command::new("dot").arg("-Tsvg").stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let Ok(mut graphviz) = graphviz else {
        return shadowgraph_tests::skip("graphviz", "Graphviz (dot) is not installed");
    };
    graphviz.stdin.take().unwrap().write_all(dot.as_bytes()).unwrap();
    let output = graphviz.wait_with_output().unwrap();
    let svg = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && svg.contains("<svg") && svg.contains("cascades"), "{svg}");
}
