//! Frames that draw the wrong thing, and the cause that `explain` reports.
#![allow(clippy::unwrap_used, reason = "tests")]

use shadowgraph_core::{Contents, Format, Frame, Plan, TextureDesc};
use shadowgraph_inspect::{explain, explain_order};

fn color() -> TextureDesc {
    TextureDesc::d2(64, 64, Format::Rgba16Float)
}

/// Ambient occlusion without effect: the lit pass samples the texture before the blur.
fn culled() -> Plan {
    let mut frame = Frame::new();
    let mut raw = frame.create_texture("raw occlusion", color());
    let mut blurred = frame.create_texture("occlusion", color());
    frame.render_pass("occlusion").color(&mut raw, Contents::clear_color([1.0; 4]));
    let mut blur = frame.render_pass("blur occlusion");
    blur.sample(&raw);
    blur.color(&mut blurred, Contents::Overwrite);
    let mut lit = frame.create_texture("lit", color());
    let mut light = frame.render_pass("light");
    light.sample(&raw); // `blurred` was meant
    light.color(&mut lit, Contents::clear_color([0.0; 4]));
    frame.export_texture(&lit);
    frame.compile().unwrap().into_plan()
}

#[test]
fn a_wrongly_culled_pass_names_the_unread_resource() {
    let plan = culled();
    let why = explain(&plan, "blur occlusion").unwrap();
    assert!(why.contains("does not run: nothing reads `occlusion`"), "{why}");
    let read = explain(&plan, "light").unwrap();
    assert!(read.contains("samples `raw occlusion`: from `occlusion`"), "{read}");
}

/// Decals that cost a render pass: they test depth that the previous pass writes.
#[test]
fn a_refused_merge_names_the_attachment_that_differs() {
    let mut frame = Frame::new();
    let mut lit = frame.create_texture("lit", color());
    let mut depth = frame.create_texture("depth", TextureDesc::d2(64, 64, Format::Depth32Float));
    let mut opaque = frame.render_pass("opaque");
    opaque.color(&mut lit, Contents::clear_color([0.0; 4]));
    opaque.depth(&mut depth, Contents::clear_depth(0.0));
    let mut decals = frame.render_pass("decals");
    decals.color(&mut lit, Contents::Preserve);
    decals.depth_read(&depth);
    frame.export_texture(&lit);
    let why = explain(&frame.compile().unwrap().into_plan(), "decals").unwrap();
    assert!(why.contains("not merged: it only tests against `depth`, which `opaque` writes"), "{why}");
}

/// Reflections that lag behind: they are declared before the fog that they should show.
#[test]
fn a_stale_read_names_the_version_and_its_writer() {
    let mut frame = Frame::new();
    let mut lit = frame.create_texture("lit", color());
    let mut reflected = frame.create_texture("reflected", color());
    frame.render_pass("opaque").color(&mut lit, Contents::clear_color([0.0; 4]));
    let mut reflections = frame.render_pass("reflections");
    reflections.sample(&lit);
    reflections.color(&mut reflected, Contents::Overwrite);
    frame.render_pass("fog").color(&mut lit, Contents::Preserve);
    frame.export_texture(&lit);
    frame.export_texture(&reflected);
    let plan = frame.compile().unwrap().into_plan();
    let why = explain(&plan, "reflections").unwrap();
    assert!(why.contains("samples `lit`: from `opaque`"), "{why}");
    let versions = explain(&plan, "lit").unwrap();
    assert!(versions.contains("version 1: `reflections` samples it"), "{versions}");
    assert!(versions.contains("version 2: `fog` draws into it"), "{versions}");
    let order = explain_order(&plan, "reflections", "fog").unwrap();
    assert!(order.contains("`fog` overwrites `lit`, which `reflections` reads"), "{order}");
}

#[test]
fn a_shared_name_is_explained_for_each_and_a_path_for_one() {
    let mut frame = Frame::new();
    for node in ["left", "right"] {
        frame.node(node, |frame| {
            let mut target = frame.create_texture("target", color());
            frame.render_pass("clear").color(&mut target, Contents::clear_color([0.0; 4]));
            frame.export_texture(&target);
        });
    }
    let plan = frame.compile().unwrap().into_plan();
    let both = explain(&plan, "clear").unwrap();
    assert!(both.contains("pass `left/clear`") && both.contains("pass `right/clear`"), "{both}");
    let one = explain(&plan, "left/clear").unwrap();
    assert!(!one.contains("right/clear"), "{one}");
    assert_eq!(explain(&plan, "target").unwrap().matches("/target`: 64x64").count(), 2);
    let right = explain(&plan, "right/target").unwrap();
    assert!(right.contains("`right/clear`") && !right.contains("left"), "{right}");
}

#[test]
fn an_unknown_name_is_an_error_with_a_suggestion() {
    let error = explain(&culled(), "blur oclusion").unwrap_err();
    assert_eq!(error.code(), "SG0701");
    assert!(error.to_string().ends_with("did you mean `blur occlusion`?"), "{error}");
    let error = explain(&culled(), "Blur Occlusion").unwrap_err().to_string();
    assert!(error.ends_with("did you mean `blur occlusion`?"), "{error}");
    let error = explain(&culled(), "?").unwrap_err().to_string();
    assert!(error.ends_with("`dump` lists all names"), "{error}");
    assert!(explain_order(&culled(), "light", "ligth").is_err());
    let error = explain_order(&culled(), "lit", "light").unwrap_err().to_string();
    assert!(error.contains("it is a resource, and only passes have an order"), "{error}");
}

#[test]
fn the_name_of_a_node_leads_to_its_passes() {
    let mut frame = Frame::new();
    frame.node("post", |frame| {
        let mut target = frame.create_texture("target", color());
        frame.render_pass("blur").color(&mut target, Contents::clear_color([0.0; 4]));
    });
    let error = explain(&frame.compile().unwrap().into_plan(), "post").unwrap_err().to_string();
    assert!(error.ends_with("`post`: it is a node with the passes `post/blur`"), "{error}");
}
