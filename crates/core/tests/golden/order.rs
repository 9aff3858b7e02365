//! Causes of an order between passes, and what is none.

use super::{BLACK, FAR, check, depth, draw, filter, hdr, plan};
use shadowgraph_core::{Contents, Format, Frame, TextureDesc, TextureUsages};

/// Read-only depth may be sampled in the same pass, needs no store, and orders no readers.
#[test]
fn read_only_depth() {
    let mut frame = Frame::new();
    let mut depth = depth(&mut frame, "depth");
    frame.render_pass("depth first").depth(&mut depth, FAR);
    let mut scene = hdr(&mut frame, "scene");
    let mut pass = frame.render_pass("soft particles");
    pass.color(&mut scene, BLACK);
    pass.depth_read(&depth);
    pass.sample(&depth);
    frame.export_texture(&scene);
    check("read_only_depth", &plan(frame).to_text());
}

/// Effects that the graph cannot see are kept by `keep` and ordered by `after`.
#[test]
fn explicit_after() {
    let mut frame = Frame::new();
    let mut start = frame.encoder_pass("start the video encoder");
    start.keep();
    let start = start.id();
    let scene = draw(&mut frame, "scene");
    let mut submit = frame.encoder_pass("hand over the picture");
    submit.copy_source(&scene);
    submit.after(start);
    submit.keep();
    let submit = submit.id();
    let plan = plan(frame);
    let why = plan.explain_why_before(start, submit);
    check("explicit_after", &format!("{}\n{why}", plan.to_text()));
}

/// The same node declared for each view: names distinguish them, and the second view reuses the memory of the first.
#[test]
fn two_views() {
    let mut frame = Frame::new();
    let window = TextureDesc::d2(2560, 720, Format::Bgra8UnormSrgb);
    let usage = TextureUsages::RENDER_ATTACHMENT;
    let mut window = frame.declare_import_texture("window", window, usage, false);
    for (index, side) in ["left", "right"].into_iter().enumerate() {
        frame.view(side, |frame| {
            let scene = draw(frame, "scene");
            let picture = filter(frame, "bloom", &scene);
            let mut present = frame.render_pass("present");
            present.sample(&picture);
            present.color(&mut window, if index == 0 { BLACK } else { Contents::Preserve });
        });
    }
    check("two_views", &plan(frame).to_text());
}

/// A frame may fix its order: no pass moves, even if another order would merge passes or save memory.
#[test]
fn fixed_order() {
    let mut frame = Frame::new();
    frame.fix_order();
    let mut scene = hdr(&mut frame, "scene");
    frame.render_pass("sky").color(&mut scene, BLACK);
    let shadow = draw(&mut frame, "shadow");
    let mut pass = frame.render_pass("ground");
    pass.color(&mut scene, Contents::Preserve);
    let ground = pass.id();
    frame.export_texture(&scene);
    frame.export_texture(&shadow);
    let plan = plan(frame);
    let why = plan.explain_why_before(plan.find_pass("draw shadow").unwrap(), ground);
    check("fixed_order", &format!("{}\n{why}", plan.to_text()));
}

/// The same frame with its order left open: the pass in between moves away, and the other two become one.
#[test]
fn order_chosen_for_merging() {
    let mut frame = Frame::new();
    let mut scene = hdr(&mut frame, "scene");
    frame.render_pass("sky").color(&mut scene, BLACK);
    let shadow = draw(&mut frame, "shadow");
    let mut pass = frame.render_pass("ground");
    pass.color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    frame.export_texture(&shadow);
    check("order_chosen_for_merging", &plan(frame).to_text());
}

/// The reason why one pass runs before another: the shortest chain of dependencies.
#[test]
fn why_before() {
    let mut frame = Frame::new();
    let mut scene = draw(&mut frame, "scene");
    let half = filter(&mut frame, "half", &scene);
    let quarter = filter(&mut frame, "quarter", &half);
    let mut add = frame.render_pass("add glow");
    add.sample(&quarter);
    add.color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    filter(&mut frame, "unread", &quarter);
    let plan = plan(frame);
    let why = |before: &str, after: &str| {
        plan.explain_why_before(plan.find_pass(before).unwrap(), plan.find_pass(after).unwrap())
    };
    let questions = [
        why("draw scene", "add glow"),
        why("draw scene", "quarter"),
        why("half", "draw scene"),
        why("half", "unread"),
    ];
    check("why_before", &questions.join("\n"));
}
