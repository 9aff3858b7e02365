//! The plan's dependencies as a graph.

use super::helpers::{BLACK, color, draw, filter, pass, plan};
use crate::{DependencyKind, Frame, Plan};
use petgraph::algo::{has_path_connecting, is_cyclic_directed};

/// draw -> a -> b, and an independent `far`.
fn frame() -> Plan {
    let mut frame = Frame::new();
    let (mut source, mut other) = (color(&mut frame, "source"), color(&mut frame, "other"));
    draw(&mut frame, "draw", &mut source, BLACK);
    let a = filter(&mut frame, "a", &source);
    let b = filter(&mut frame, "b", &a);
    draw(&mut frame, "far", &mut other, BLACK);
    frame.export_texture(&b);
    frame.export_texture(&other);
    plan(frame)
}

#[test]
fn nodes_are_passes_and_edges_are_dependencies() {
    let plan = frame();
    let graph = plan.graph();
    assert_eq!((graph.node_count(), graph.edge_count()), (4, 2));
    assert!(!is_cyclic_directed(&graph));
    let index = |name| pass(&plan, name).0.into();
    assert!(has_path_connecting(&graph, index("draw"), index("b"), None));
    assert!(!has_path_connecting(&graph, index("draw"), index("far"), None));
}

#[test]
fn why_a_pass_runs_before_another_is_a_chain_of_dependencies() {
    let plan = frame();
    let why = |before, after| plan.why_before(pass(&plan, before), pass(&plan, after));
    let chain = why("draw", "b").unwrap();
    let names: Vec<_> = chain.iter().map(|d| plan.pass(d.after).name).collect();
    assert_eq!(names, ["a", "b"]);
    assert!(chain.iter().all(|d| d.kind == DependencyKind::ReadAfterWrite));
    assert_eq!(why("b", "draw"), None);
    assert_eq!(why("draw", "far"), None, "nothing orders these two");
}

#[test]
fn why_before_takes_the_shortest_chain() {
    let mut frame = Frame::new();
    let mut source = color(&mut frame, "source");
    draw(&mut frame, "draw", &mut source, BLACK);
    let a = filter(&mut frame, "a", &source);
    let mut last = frame.compute_pass("last");
    last.sample(&a);
    last.sample(&source);
    last.keep();
    let plan = plan(frame);
    assert_eq!(plan.why_before(pass(&plan, "draw"), pass(&plan, "last")).unwrap().len(), 1);
}

#[test]
fn the_critical_path_is_the_heaviest_chain() {
    let plan = frame();
    let names = |path: Vec<crate::PassId>| -> Vec<String> {
        path.into_iter().map(|id| plan.pass(id).name.to_owned()).collect()
    };
    assert_eq!(names(plan.critical_path(|_| 1.0)), ["draw", "a", "b"]);
    let far = pass(&plan, "far");
    assert_eq!(names(plan.critical_path(|id| if id == far { 10.0 } else { 1.0 })), ["far"]);
}

#[test]
fn an_empty_plan_has_no_critical_path() {
    assert!(plan(Frame::new()).critical_path(|_| 1.0).is_empty());
}
