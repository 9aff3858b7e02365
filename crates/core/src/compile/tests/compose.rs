//! Frames put together from nodes.

use super::helpers::{BLACK, color, draw, filter, look, order, plan};
use crate::{ClearValue, Error, Format, Frame, NodePlan, Resize, Texture, TextureDesc};

#[test]
fn nodes_nest_and_name_their_passes() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.node("post", |frame| frame.node("bloom", |frame| draw(frame, "blur", &mut a, BLACK)));
    frame.export_texture(&a);
    let plan = plan(frame);
    assert_eq!(plan.pass_path(plan.order()[0]), "post/bloom/blur");
    let nodes: Vec<NodePlan<'_>> = plan.nodes().collect();
    assert_eq!(nodes.iter().map(|node| node.name).collect::<Vec<_>>(), ["post", "bloom"]);
    assert_eq!(nodes[1].parent.map(|parent| parent.index()), Some(0));
}

#[test]
fn a_node_without_declarations_is_removed() {
    let mut frame = Frame::new();
    frame.node("off", |frame| frame.node("also off", |_| {}));
    let plan = plan(frame);
    assert_eq!((plan.nodes().len(), plan.pass_count()), (0, 0));
}

#[test]
fn a_resource_belongs_to_its_node_even_if_the_node_has_no_pass() {
    let mut frame = Frame::new();
    let mut a = frame.node("targets", |frame| color(frame, "a"));
    frame.node("scene", |frame| draw(frame, "draw", &mut a, BLACK));
    frame.export_texture(&a);
    let plan = plan(frame);
    let (id, _) = plan.resources().next().unwrap();
    assert_eq!(plan.resource_path(id), "targets/a");
    let mut alone = Frame::new();
    alone.node("targets", |frame| color(frame, "unused"));
    assert!(alone.compile().unwrap().into_plan().to_text().contains("unused"));
}

#[test]
fn a_false_condition_declares_nothing() {
    let glow = |frame: &mut Frame<'_>| {
        let mut glow = color(frame, "glow");
        draw(frame, "glow", &mut glow, BLACK);
        glow
    };
    let passes = |condition: bool| {
        let mut frame = Frame::new();
        let mut out = color(&mut frame, "out");
        let glow = frame.when(condition, glow);
        let mut pass = frame.render_pass("out");
        if let Some(glow) = &glow {
            pass.sample(glow);
        }
        pass.color(&mut out, BLACK);
        frame.export_texture(&out);
        plan(frame).pass_count()
    };
    assert_eq!([passes(false), passes(true)], [1, 2]);
}

#[test]
fn a_placeholder_is_one_texel_cleared_once_and_only_if_it_is_read() {
    let white = ClearValue::Color([1.0; 4]);
    let mut frame = Frame::new();
    let placeholder = frame.or_placeholder(None, Format::R8Unorm, white);
    look(&mut frame, "look", &placeholder);
    let read = plan(frame);
    assert_eq!(order(&read), ["placeholder R8Unorm", "look"]);
    assert_eq!(read.resource(placeholder.id()).desc.bytes(), 1);

    let mut frame = Frame::new();
    frame.or_placeholder(None, Format::Depth32Float, ClearValue::Depth(0.0));
    assert_eq!(plan(frame).order().len(), 0);

    let mut frame = Frame::new();
    let own = color(&mut frame, "own");
    assert_eq!(frame.or_placeholder(Some(&own), Format::R8Unorm, white), own, "what is there is taken");
}

struct Scene(Texture);

#[test]
fn nodes_look_up_what_others_published() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    draw(&mut frame, "draw", &mut a, BLACK);
    frame.publish(Scene(a));
    let Scene(found) = frame.published().unwrap();
    let found = found.clone();
    let out = filter(&mut frame, "filter", &found);
    frame.export_texture(&out);
    assert_eq!(order(&plan(frame)), ["draw", "filter"]);
}

#[test]
fn what_nothing_published_is_an_error_that_names_the_node_and_the_type() {
    let mut frame = Frame::new();
    let error = frame.node("post", |frame| frame.published::<Scene>().map(drop).unwrap_err());
    let Error::NotPublished { location, value } = &error else { panic!("{error}") };
    assert!(location.contains("`post`") && value.ends_with("Scene"), "{error}");
}

#[test]
fn views_repeat_declarations_and_have_separate_histories() {
    let mut frame = Frame::new();
    for eye in ["left", "right"] {
        frame.view(eye, |frame| {
            let mut glow = frame.history("glow", TextureDesc::d2(8, 8, Format::Rgba8Unorm), Resize::Reset);
            let mut pass = frame.render_pass("accumulate");
            pass.sample(&glow.previous);
            pass.color(&mut glow.current, BLACK);
        });
    }
    let plan = plan(frame);
    let paths: Vec<_> = plan.order().iter().map(|&id| plan.pass_path(id)).collect();
    assert_eq!(paths, ["left/accumulate", "right/accumulate"]);
    let histories = plan.resources().filter_map(|(_, resource)| match resource.origin {
        crate::Origin::Current { history } => Some(history),
        _ => None,
    });
    assert_eq!(histories.collect::<Vec<_>>(), [0, 1]);
}
