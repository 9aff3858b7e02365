//! Requirements of every dump format.

use super::{BLACK, FAR, draw, filter, hdr, plan};
use shadowgraph_core::{Contents, Frame, Plan, Rect, Subresource, TextureUsages};
use std::collections::BTreeSet;

/// A frame with every kind of decision: culled, merged, clears drawn, loads and stores, slots, imports, two nodes.
fn frame() -> Frame<'static> {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let atlas = shadowgraph_core::TextureDesc::d2(1024, 512, shadowgraph_core::Format::Depth32Float);
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
    let mut atlas = frame.declare_import_texture("atlas", atlas, usage, true);
    frame.node("shadows", |frame| {
        for light in 0..2 {
            let tile = Subresource::FULL.rect(Rect::new(light * 256, 0, 256, 256));
            frame.render_pass(format_args!("light {light}")).subresource(tile).depth(&mut atlas, FAR);
        }
    });
    let image = frame.node("post", |frame| {
        let half = filter(frame, "half", &scene);
        filter(frame, "unused", &half);
        let mut image = hdr(frame, "image");
        let mut last = frame.render_pass("last");
        last.sample(&half);
        last.sample(&atlas);
        last.color(&mut image, Contents::Overwrite);
        image
    });
    frame.export_texture(&image);
    frame
}

fn all() -> Plan {
    plan(frame())
}

#[test]
fn the_same_declaration_gives_the_same_bytes() {
    assert_eq!(all(), all());
    assert_eq!(all().to_json().unwrap(), all().to_json().unwrap());
    assert_eq!(all().to_text(), all().to_text());
    assert_eq!(all().to_dot(), all().to_dot());
}

#[test]
fn the_json_dump_has_every_decision_as_a_sentence() {
    let json: serde_json::Value = serde_json::from_str(&all().to_json().unwrap()).unwrap();
    assert_eq!(json["schema"], 3);
    assert_eq!(json["plan"]["passes"].as_array().unwrap().len(), 6);
    let reasons = json["reasons"].as_array().unwrap();
    let kinds: BTreeSet<_> = reasons.iter().map(|reason| reason["decision"].as_str().unwrap()).collect();
    let expected = ["clear drawn", "culled", "load", "merged", "placed", "slot", "store"];
    assert_eq!(kinds, expected.into_iter().collect());
    assert!(reasons.iter().all(|reason| !reason["because"].as_str().unwrap().is_empty()));

    let of = |decision: &str| reasons.iter().filter(|reason| reason["decision"] == decision).count();
    let plan = all();
    let attachments =
        plan.order().iter().flat_map(|&pass| plan.accesses(pass)).filter(|a| a.ops.is_some()).count();
    assert_eq!((of("culled"), of("placed"), of("merged")), (1, 5, 5));
    assert_eq!((of("load"), of("store")), (attachments, attachments));
    assert_eq!((of("clear drawn"), of("slot")), (2, plan.resources().len()));
}

#[test]
fn the_dot_dump_clusters_nodes_and_marks_merged_and_culled_passes() {
    let dot = all().to_dot();
    assert!(dot.starts_with("digraph"));
    for expected in [
        "subgraph cluster_0 {",
        "label=\"post\"",
        "label=\"unused\\nculled\"",
        "tooltip=\"nothing reads `unused`\"",
        "2 of 2\"",
        "tooltip=\"one render pass\"",
        "[label=\"atlas\", tooltip=\"`post/last` needs what `shadows/light 1` wrote to `atlas`\"",
    ] {
        assert!(dot.contains(expected), "{expected} is missing in\n{dot}");
    }
}

#[test]
fn quotes_in_names_do_not_break_the_dot_dump() {
    let mut frame = Frame::new();
    let mut image = hdr(&mut frame, "a \"quoted\" \\ name");
    frame.render_pass("draw \"it\"").color(&mut image, BLACK);
    frame.export_texture(&image);
    let dot = plan(frame).to_dot();
    assert!(dot.contains("label=\"draw \\\"it\\\"\\nrender"), "{dot}");
}

#[test]
fn long_names_do_not_widen_the_text_dump() {
    let mut frame = Frame::new();
    let name = "a name that goes on ".repeat(20);
    let mut image = hdr(&mut frame, &name);
    frame.node(&name, |frame| {
        let half = Subresource::FULL.rect(Rect::new(0, 0, 1280, 360));
        frame.render_pass(&name).color(&mut image, BLACK);
        frame.render_pass(&name).subresource(half).color(&mut image, BLACK);
    });
    frame.export_texture(&image);
    let text = plan(frame).to_text();
    assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
    assert!(text.contains("… v2, 1280x360 at 0,0"), "the part is not cut: {text}");
}

#[test]
fn contents_that_no_pass_wrote_come_from_the_caller() {
    let text = all().to_text();
    assert!(text.contains("from the caller and 2 more"), "{text}");
}

#[test]
fn an_empty_frame_has_dumps_too() {
    let plan = plan(Frame::new());
    assert!(plan.to_text().starts_with("plan: 0 passes in 0 steps, 0 culled"), "{}", plan.to_text());
    assert!(plan.to_json().is_ok());
}
