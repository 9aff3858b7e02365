//! Small frames, each showing one feature, with their dumps and explanations.
//!
//! The texts are in `golden/NAME.txt`. A different text fails the test and prints the difference; after
//! reading it, accept it with `UPDATE_GOLDEN=1 cargo test -p shadowgraph-inspect --test golden`. More frames, without
//! explanations, are in the tests of `shadowgraph-core`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "../../core/tests/golden/compare.rs"]
mod compare;
#[path = "../../core/tests/golden/helpers.rs"]
mod helpers;

use compare::check;
use helpers::{BLACK, FAR, depth, draw, filter, hdr, plan};
use shadowgraph_core::{
    BufferDesc, Contents, Format, Frame, Options, Rect, Resize, Subresource, TextureDesc, TextureUsages,
};
use shadowgraph_inspect::{explain_pass, explain_resource, explain_why_before};

fn tile(index: u32) -> Subresource {
    Subresource::FULL.rect(Rect::new(index % 2 * 1024, index / 2 * 1024, 1024, 1024))
}

const ATLAS: (u32, u32, Format) = (2048, 2048, Format::Depth32Float);

/// An import is needed after the frame, so passes that write it run, and its earlier contents are loaded.
#[test]
fn import_kept() {
    let mut frame = Frame::new();
    let usage = TextureUsages::RENDER_ATTACHMENT;
    let window = TextureDesc::d2(1280, 720, Format::Bgra8UnormSrgb);
    let mut window = frame.declare_import_texture("window", window, usage, true);
    frame.render_pass("overlay").color(&mut window, Contents::Preserve);
    let plan = plan(frame);
    let why = explain_resource(&plan, window.id());
    check("import_kept", &format!("{}\n{why}", plan.to_text()));
}

/// A history is read with the contents from the previous frame and written for the next; its writer always runs.
#[test]
fn history() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let mut colour = frame.history("colour", TextureDesc::d2(1280, 720, Format::Rgba16Float), Resize::Reset);
    let mut pass = frame.render_pass("accumulate");
    pass.sample(&scene);
    pass.sample(&colour.previous);
    pass.color(&mut colour.current, Contents::Overwrite);
    let plan = plan(frame);
    let why = [colour.previous.id(), colour.current.id()].map(|id| explain_resource(&plan, id)).join("\n");
    check("history", &format!("{}\n{why}", plan.to_text()));
}

/// Copy passes upload bytes from the CPU; like other passes they run only if something reads the result.
#[test]
fn uploads() {
    let mut frame = Frame::new();
    let spheres = frame.upload_buffer("spheres", vec![0; 3_000]);
    frame.upload_buffer("unused", vec![0; 16]);
    let mut visible = frame.create_buffer("visible", BufferDesc::new(400));
    let mut image = hdr(&mut frame, "image");
    let mut cull = frame.compute_pass("cull spheres");
    cull.storage_buffer(&spheres);
    cull.storage_buffer_mut(&mut visible, Contents::Overwrite);
    let mut pass = frame.render_pass("draw spheres");
    pass.vertex_buffer(&spheres);
    pass.indirect_buffer(&visible);
    pass.color(&mut image, BLACK);
    frame.export_texture(&image);
    let plan = plan(frame);
    let why = explain_resource(&plan, spheres.id());
    check("uploads", &format!("{}\n{why}", plan.to_text()));
}

/// A resource that is read at the end occupies its slot until then.
#[test]
fn no_reuse_because_busy() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let across = filter(&mut frame, "blur across", &scene);
    let glow = filter(&mut frame, "blur down", &across);
    let mut image = hdr(&mut frame, "image");
    let mut add = frame.render_pass("add glow");
    add.sample(&scene);
    add.sample(&glow);
    add.color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);
    let plan = plan(frame);
    let why = explain_resource(&plan, glow.id());
    check("no_reuse_because_busy", &format!("{}\n{why}", plan.to_text()));
}

/// Samples that are resolved in the pass that draws them are transient: such attachments need no memory on tile-based
/// GPUs.
#[test]
fn multisampling() {
    let mut frame = Frame::new();
    let four = |format| TextureDesc { samples: 4, ..TextureDesc::d2(1280, 720, format) };
    let mut samples = frame.create_texture("samples", four(Format::Rgba8UnormSrgb));
    let mut depth = frame.create_texture("depth", four(Format::Depth32Float));
    let mut image = frame.create_texture("image", TextureDesc::d2(1280, 720, Format::Rgba8UnormSrgb));
    let mut pass = frame.render_pass("draw");
    pass.color(&mut samples, BLACK);
    pass.resolve(&mut image);
    pass.depth(&mut depth, FAR);
    let pass = pass.id();
    frame.export_texture(&image);
    let plan = plan(frame);
    check("multisampling", &format!("{}\n{}", plan.to_text(), explain_pass(&plan, pass)));
}

/// Adjacent passes with the same attachments become one render pass: one load, one store.
#[test]
fn merge() {
    let mut frame = Frame::new();
    let (mut scene, mut depth) = (hdr(&mut frame, "scene"), depth(&mut frame, "depth"));
    frame.node("scene", |frame| {
        for (name, first) in [("sky", true), ("opaque", false), ("glass", false)] {
            let mut pass = frame.render_pass(name);
            pass.color(&mut scene, if first { BLACK } else { Contents::Preserve });
            pass.depth(&mut depth, if first { FAR } else { Contents::Preserve });
        }
    });
    let image = frame.node("post", |frame| filter(frame, "tonemap", &scene));
    frame.export_texture(&image);
    let plan = plan(frame);
    let why = explain_pass(&plan, plan.find_pass("opaque").unwrap());
    check("merge", &format!("{}\n{why}", plan.to_text()));
}

/// The frame can disable merging, for instance to time each pass alone.
#[test]
fn merging_off() {
    let mut frame = Frame::new();
    frame.set_options(Options { merge: false, transient_attachments: false, ..Options::default() });
    let mut scene = hdr(&mut frame, "scene");
    frame.render_pass("sky").color(&mut scene, BLACK);
    frame.render_pass("ground").color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    let plan = plan(frame);
    let why = explain_pass(&plan, plan.find_pass("ground").unwrap());
    check("merging_off", &format!("{}\n{why}", plan.to_text()));
}

/// Effects that the graph cannot see are kept by `keep` and ordered by `after`.
#[test]
fn explicit_after() {
    let mut frame = Frame::new();
    let mut start = frame.encoder_pass("start the video encoder");
    start.keep();
    let start = start.id();
    let scene = draw(&mut frame, "scene");
    let mut submit = frame.encoder_pass("hand over the image");
    submit.copy_source(&scene);
    submit.after(start);
    submit.keep();
    let submit = submit.id();
    let plan = plan(frame);
    let why = explain_why_before(&plan, start, submit);
    check("explicit_after", &format!("{}\n{why}", plan.to_text()));
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
    let why = explain_why_before(&plan, plan.find_pass("draw shadow").unwrap(), ground);
    check("fixed_order", &format!("{}\n{why}", plan.to_text()));
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
        explain_why_before(&plan, plan.find_pass(before).unwrap(), plan.find_pass(after).unwrap())
    };
    let questions = [
        why("draw scene", "add glow"),
        why("draw scene", "quarter"),
        why("half", "draw scene"),
        why("half", "unread"),
    ];
    check("why_before", &questions.join("\n"));
}

/// Tiles of an atlas whose other tiles have contents from earlier frames: the graph loads all, and draws the clears of the
/// tiles, since a load operation would clear the others too.
#[test]
fn atlas_kept() {
    let mut frame = Frame::new();
    let atlas = TextureDesc::d2(ATLAS.0, ATLAS.1, ATLAS.2);
    let mut atlas = frame.declare_import_texture("atlas", atlas, TextureUsages::RENDER_ATTACHMENT, true);
    for light in [1, 2] {
        frame.render_pass(format_args!("light {light}")).subresource(tile(light)).depth(&mut atlas, FAR);
    }
    let plan = plan(frame);
    let why = explain_pass(&plan, plan.find_pass("light 2").unwrap());
    check("atlas_kept", &format!("{}\n{why}", plan.to_text()));
}

/// A pass that reads one tile waits only for the pass that draws it.
#[test]
fn disjoint_regions() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(ATLAS.0, ATLAS.1, ATLAS.2));
    let mut results = frame.create_buffer("results", BufferDesc::new(512));
    for light in 0..2 {
        frame.render_pass(format_args!("draw {light}")).subresource(tile(light)).depth(&mut atlas, FAR);
    }
    for light in 0..2u64 {
        let mut pass = frame.compute_pass(format_args!("measure {light}"));
        pass.subresource(tile(light as u32)).sample(&atlas);
        let bytes = Subresource::FULL.bytes(light * 256..light * 256 + 256);
        pass.subresource(bytes).storage_buffer_mut(&mut results, Contents::Overwrite);
    }
    frame.export_buffer(&results);
    let plan = plan(frame);
    let why = |before: &str, after: &str| {
        explain_why_before(&plan, plan.find_pass(before).unwrap(), plan.find_pass(after).unwrap())
    };
    let (own, other) = (why("draw 1", "measure 1"), why("draw 0", "measure 1"));
    check("disjoint_regions", &format!("{}\n{own}\n{other}", plan.to_text()));
}

/// The faces of a cube do not order each other, and each is a separate attachment.
#[test]
fn cube_layers() {
    let mut frame = Frame::new();
    let mut cube = frame.create_texture("cube", TextureDesc::d2(512, 512, Format::Depth32Float).layers(6));
    for (face, name) in ["+x", "-x", "+y"].into_iter().enumerate() {
        frame.render_pass(name).subresource(Subresource::FULL.layer(face as u32)).depth(&mut cube, FAR);
    }
    let mut scene = hdr(&mut frame, "scene");
    let mut pass = frame.render_pass("light");
    pass.subresource(Subresource::FULL.layers(0..3)).sample(&cube);
    pass.color(&mut scene, BLACK);
    frame.export_texture(&scene);
    let plan = plan(frame);
    let why = explain_resource(&plan, cube.id());
    check("cube_layers", &format!("{}\n{why}", plan.to_text()));
}
