//! Slots, and the dumps that show them.

use super::{BLACK, color, filter, plan};
use crate::{Contents, Format, Frame, Plan, TextureDesc, TextureUsages};

/// draw -> a -> b -> c -> d, of which a and c, b and d can share.
fn chain() -> Plan {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.node("scene", |frame| {
        frame.render_pass("draw").color(&mut a, BLACK);
    });
    let d = frame.node("post", |frame| {
        let b = filter(frame, "b", &a);
        let c = filter(frame, "c", &b);
        filter(frame, "unused", &c);
        filter(frame, "d", &c)
    });
    frame.export_texture(&d);
    plan(frame)
}

#[test]
fn resources_with_disjoint_lifetimes_share_a_slot() {
    let plan = chain();
    assert_eq!(plan.slots.len(), 2);
    let slots: Vec<_> = plan.resources.iter().map(|r| r.slot.map(|s| s.0)).collect();
    assert_eq!(slots, [Some(0), Some(1), Some(0), None, Some(1)]);
    assert_eq!(plan.saved_bytes(), 2 * 64 * 64 * 4);
    let usage = plan.slots[1].texture_usage;
    assert!(usage.contains(TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING), "{usage:?}");
}

#[test]
fn resources_of_different_shape_never_share() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    let b = filter(&mut frame, "b", &a);
    let mut wide = frame.create_texture("wide", TextureDesc::d2(65, 64, Format::Rgba8Unorm));
    let mut pass = frame.render_pass("wide");
    pass.sample(&b);
    pass.color(&mut wide, Contents::Cover);
    frame.export_texture(&wide);
    assert_eq!(plan(frame).slots.len(), 3);
}

#[test]
fn a_storage_texture_does_not_share_with_a_plain_attachment() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    let b = filter(&mut frame, "b", &a);
    let mut c = color(&mut frame, "c");
    let mut compute = frame.compute_pass("c");
    compute.sample(&b);
    compute.storage_texture_mut(&mut c, Contents::Cover);
    frame.export_texture(&c);
    assert_eq!(plan(frame).slots.len(), 3);
}

#[test]
fn the_same_declaration_gives_the_same_bytes() {
    assert_eq!(chain(), chain());
    assert_eq!(chain().to_json().unwrap(), chain().to_json().unwrap());
    assert_eq!(chain().to_text(), chain().to_text());
    assert_eq!(chain().to_dot(), chain().to_dot());
}

#[test]
fn the_text_dump_shows_nodes_reasons_and_sharing_within_110_columns() {
    let text = chain().to_text();
    for expected in [
        "plan: 4 passes in 4 steps, 1 culled",
        "  scene\n",
        "  post\n",
        "clear 0: the pass clears it",
        "store: `post/b` needs it",
        "store: it is exported",
        "post/unused",
        "nothing reads `unused`",
        "shared: a, then c",
        "shared: b, then d",
    ] {
        assert!(text.contains(expected), "{expected} is missing in\n{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
}

#[test]
fn long_names_do_not_widen_the_text_dump() {
    let mut frame = Frame::new();
    let name = "a name that goes on ".repeat(20);
    let mut a = color(&mut frame, &name);
    frame.node(&name, |frame| {
        frame.render_pass(&name).color(&mut a, BLACK);
    });
    frame.export_texture(&a);
    let text = plan(frame).to_text();
    assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
}

#[test]
fn the_json_dump_holds_the_plan_and_its_reasons_in_words() {
    let json: serde_json::Value = serde_json::from_str(&chain().to_json().unwrap()).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["plan"]["passes"].as_array().unwrap().len(), 5);
    let reasons = json["reasons"].as_array().unwrap();
    assert!(reasons.iter().any(|r| r["pass"] == "post/unused" && r["because"] == "nothing reads `unused`"));
    assert!(reasons.iter().any(|r| r["decision"] == "discard" || r["decision"] == "store"));
}

#[test]
fn the_dot_dump_clusters_nodes_and_marks_culled_passes() {
    let dot = chain().to_dot();
    assert!(dot.starts_with("digraph"));
    assert!(dot.contains("subgraph cluster_0") && dot.contains("label=\"post\""), "{dot}");
    assert!(dot.contains("culled") && dot.contains("tooltip=\"nothing reads `unused`\""), "{dot}");
    assert!(dot.contains("p0 -> p1 [label=\"a\"]"), "{dot}");
}

#[test]
fn quotes_in_names_do_not_break_the_dot_dump() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a \"quoted\" \\ name");
    frame.render_pass("draw \"it\"").color(&mut a, BLACK);
    frame.export_texture(&a);
    assert!(plan(frame).to_dot().contains("draw \\\"it\\\""));
}
