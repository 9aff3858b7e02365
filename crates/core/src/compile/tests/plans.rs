//! Plans found again.

use super::helpers::{BLACK, filter};
use crate::{ClearValue, Contents, Error, Format, Frame, Graph, PlanCounts, TextureDesc};

/// Draws, then filters, at a size.
fn declare(frame: &mut Frame<'_>, name: &str, side: u32, contents: Contents) {
    let mut a = frame.create_texture(name, TextureDesc::d2(side, side, Format::Rgba8Unorm));
    frame.render_pass("draw").color(&mut a, contents);
    let b = filter(frame, "filter", &a);
    frame.export_texture(&b);
}

fn compile(graph: &mut Graph, name: &str, side: u32, contents: Contents) -> std::sync::Arc<crate::Plan> {
    let mut frame = graph.frame();
    declare(&mut frame, name, side, contents);
    graph.compile(frame).unwrap().shared_plan()
}

#[test]
fn equal_frames_share_a_plan() {
    let mut graph = Graph::new();
    let first = compile(&mut graph, "a", 64, BLACK);
    let second = compile(&mut graph, "a", 64, BLACK);
    assert!(std::sync::Arc::ptr_eq(&first, &second));
    assert_eq!(graph.plan_counts(), PlanCounts { compiled: 1, reused: 1, ..Default::default() });
}

#[test]
fn a_change_of_size_only_is_not_a_full_compile() {
    let mut graph = Graph::new();
    compile(&mut graph, "a", 64, BLACK);
    let resized = compile(&mut graph, "a", 128, BLACK);
    assert_eq!(graph.plan_counts(), PlanCounts { compiled: 1, resized: 1, ..Default::default() });
    let mut frame = Frame::new();
    declare(&mut frame, "a", 128, BLACK);
    assert_eq!(*resized, frame.compile().unwrap().into_plan(), "the plan of a full compile");
}

#[test]
fn a_change_of_clear_values_only_is_not_a_full_compile() {
    let mut graph = Graph::new();
    let white = Contents::Clear(ClearValue::Color([1.0; 4]));
    compile(&mut graph, "a", 64, BLACK);
    let cleared = compile(&mut graph, "a", 64, white);
    assert_eq!(graph.plan_counts(), PlanCounts { compiled: 1, cleared: 1, ..Default::default() });
    let mut frame = Frame::new();
    declare(&mut frame, "a", 64, white);
    assert_eq!(*cleared, frame.compile().unwrap().into_plan(), "the plan of a full compile");
    let mut frame = graph.frame();
    declare(&mut frame, "a", 64, Contents::Clear(ClearValue::Depth(1.0)));
    assert!(matches!(graph.compile(frame), Err(Error::Clear { .. })));
    compile(&mut graph, "a", 64, white);
    assert_eq!(graph.plan_counts().reused, 1);
}

#[test]
fn any_other_change_is_a_full_compile() {
    let mut graph = Graph::new();
    compile(&mut graph, "a", 64, BLACK);
    compile(&mut graph, "b", 64, BLACK);
    compile(&mut graph, "b", 32, Contents::Clear(ClearValue::Color([1.0; 4])));
    compile(&mut graph, "b", 32, Contents::Overwrite);
    assert_eq!(graph.plan_counts(), PlanCounts { compiled: 4, ..Default::default() });
}

#[test]
fn frames_that_alternate_keep_their_plans() {
    let mut graph = Graph::new();
    for _ in 0..3 {
        for name in ["a", "b", "c", "d"] {
            compile(&mut graph, name, 64, BLACK);
        }
    }
    assert_eq!(graph.plan_counts(), PlanCounts { compiled: 4, reused: 8, ..Default::default() });
}

#[test]
fn a_frame_with_an_error_does_not_change_the_plans() {
    let mut graph = Graph::new();
    compile(&mut graph, "a", 64, BLACK);
    let mut frame = graph.frame();
    frame.render_pass("bad");
    assert!(graph.compile(frame).is_err());
    compile(&mut graph, "a", 64, BLACK);
    assert_eq!(graph.plan_counts().reused, 1);
}

#[test]
fn notes_are_in_every_dump_and_part_of_the_declaration() {
    let mut graph = Graph::new();
    let mut plan = |note: &str| {
        let mut frame = graph.frame();
        declare(&mut frame, "a", 64, BLACK);
        let texture = frame.find_texture("a").unwrap();
        frame.note(&texture, note);
        let mut b = frame.create_texture("b", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
        let mut pass = frame.render_pass("drawn");
        pass.note("drawn: `Fox` moved");
        pass.color(&mut b, BLACK);
        graph.compile(frame).unwrap().shared_plan()
    };
    let plans = [plan("kept: 1 caster"), plan("kept: 2 casters")];
    assert_ne!(plans[0], plans[1]);
    let texture = plans[1].resources().find(|(_, resource)| resource.name == "a").unwrap().0;
    assert!(plans[1].resource_notes(texture).eq(["kept: 2 casters"]));
    let pass = plans[1].find_pass("drawn").unwrap();
    assert!(plans[1].pass_notes(pass).eq(["drawn: `Fox` moved"]));
    let text = plans[1].to_text();
    assert!(text.contains("kept: 2 casters"), "{text}");
    let json = plans[1].to_json().unwrap();
    assert!(json.contains("kept: 2 casters") && json.contains("drawn: `Fox` moved"), "{json}");
}
