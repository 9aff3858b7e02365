//! The output of `shadowgraph dump` for the demo scene.

mod culled;
mod diff;
mod schema;

use std::io::Write as _;
use std::process::{Command, Stdio};

fn dump(format: &str) -> String {
    let program = shadowgraph_tests::program().unwrap();
    let output = Command::new(program)
        .args(["dump", "--pipeline", "minimal_lit", "--format", format])
        .output()
        .unwrap();
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
        "same render pass: it has the same attachments",
        "resources by slot",
        "  slot 0 ",
        "lights\n",
        "casts shadows",
    ] {
        assert!(text.contains(expected), "{expected} is missing in\n{text}");
    }
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(110), "{widest:?} columns\n{text}");
}

#[test]
fn the_tiles_of_a_shadow_map_are_one_render_pass() {
    let text = dump("text");
    assert!(
        text.starts_with("plan: 14 passes in 9 steps, 0 culled; 7 resources in 7 slots of 14.1 MiB"),
        "{text}"
    );
    let json: serde_json::Value = serde_json::from_str(&dump("json")).unwrap();
    let passes = json["plan"]["passes"].as_array().unwrap();
    let names = |step: &serde_json::Value| -> Vec<String> {
        let ids = step["passes"].as_array().unwrap().iter().map(|id| id.as_u64().unwrap() as usize);
        ids.map(|id| passes[id]["name"].as_str().unwrap().to_owned()).collect()
    };
    let steps: Vec<_> = json["plan"]["order"].as_array().unwrap().iter().map(names).collect();
    // New maps that are kept need no clear.
    let cascades = ["cascade 0", "cascade 1", "cascade 2", "cascade 3"];
    let atlas = ["light 1", "light 2", "light 3"];
    for map in [&cascades[..], &atlas[..]] {
        assert!(steps.iter().any(|step| step == map), "{steps:?}");
    }
    // Nothing is cleared by a draw.
    let ops =
        passes.iter().flat_map(|pass| pass["accesses"].as_array().unwrap()).map(|access| &access["ops"]);
    let attachments: Vec<_> = ops.filter(|ops| !ops.is_null()).collect();
    assert_eq!(attachments.len(), cascades.len() + atlas.len() + 3);
    assert!(attachments.iter().all(|ops| ops["clear_drawn"] == false), "{attachments:?}");
}

#[test]
fn json_has_the_plan_its_reasons_and_the_lights() {
    let json: serde_json::Value = serde_json::from_str(&dump("json")).unwrap();
    assert_eq!(json["schema"], 3);
    assert_eq!(json["lights"].as_array().unwrap().len(), 4);
    assert!(json["plan"]["passes"].as_array().unwrap().len() > 5);
    assert!(json["reasons"].as_array().unwrap().iter().all(|reason| reason["because"].is_string()));
    assert_eq!(dump("json"), dump("json"), "the same frame gives the same bytes");
}

#[test]
fn explain_describes_a_pass_a_resource_and_an_order() {
    let explain = |args: &[&str]| {
        let output = Command::new(shadowgraph_tests::program().unwrap())
            .args(["explain", "--pipeline", "minimal_lit"])
            .args(args)
            .output()
            .unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    let (code, words, _) = explain(&["forward"]);
    assert_eq!(code, Some(0));
    assert!(
        words.starts_with("render pass `lighting/forward`\n  runs: `tonemap/tonemap` needs `lit`"),
        "{words}"
    );
    assert!(explain(&["cascades"]).1.contains("cascades`: 4096x4096 Depth32Float, 64.0 MiB"));
    assert!(explain(&["cascades"]).1.contains("cascade 0 drawn: nothing is kept of it"));
    let resting = explain(&["cascades", "--frames", "2", "--animation", "none"]).1;
    assert!(resting.contains("cascade 0 kept: "), "{resting}");
    let moving = explain(&["cascades", "--frames", "2"]).1;
    assert!(moving.contains("drawn: `flag` moved"), "{moving}");
    let (_, words, _) = explain(&["cascade 0", "--before", "tonemap"]);
    assert!(
        words.contains("`lighting/forward` needs what `shadows/cascades/cascade 0` wrote to `cascades`"),
        "{words}"
    );
    let (code, _, error) = explain(&["forwrad"]);
    assert_eq!((code, error.lines().count()), (Some(1), 1), "{error}");
    assert!(error.contains("did you mean `forward`?"), "{error}");
}

#[test]
fn mermaid_has_a_box_for_each_pass_and_a_group_for_each_node() {
    let text = dump("mermaid");
    assert!(text.starts_with("flowchart LR\n"), "{text}");
    assert_eq!(text.matches("<br/>step ").count(), 14, "{text}");
    assert_eq!(
        text.matches("subgraph ").count(),
        text.matches("\n  end\n").count() + text.matches("    end\n").count()
    );
    assert!(text.contains("subgraph n4 [\"cascades\"]"), "{text}");
}

#[test]
fn graphviz_accepts_the_dot_dump() {
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
