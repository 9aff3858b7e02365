//! Tiles, layers, mips and byte ranges.

use super::{BLACK, FAR, check, hdr, plan};
use shadowgraph_core::{BufferDesc, Contents, Format, Frame, Rect, Subresource, TextureDesc, TextureUsages};

fn tile(index: u32) -> Subresource {
    Subresource::FULL.rect(Rect::new(index % 2 * 1024, index / 2 * 1024, 1024, 1024))
}

const ATLAS: (u32, u32, Format) = (2048, 2048, Format::Depth32Float);

/// Tiles of an atlas without other contents: one clear when the render pass begins clears all of them.
#[test]
fn atlas_tiles() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(ATLAS.0, ATLAS.1, ATLAS.2));
    for light in 0..4 {
        frame.node(format_args!("light {light}"), |frame| {
            frame.render_pass("casters").subresource(tile(light)).depth(&mut atlas, FAR);
        });
    }
    let mut scene = hdr(&mut frame, "scene");
    let mut pass = frame.render_pass("light");
    pass.sample(&atlas);
    pass.color(&mut scene, BLACK);
    frame.export_texture(&scene);
    check("atlas_tiles", &plan(frame).to_text());
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
    let why = plan.explain_pass(plan.find_pass("light 2").unwrap());
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
        plan.explain_why_before(plan.find_pass(before).unwrap(), plan.find_pass(after).unwrap())
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
    let why = plan.explain_resource(cube.id());
    check("cube_layers", &format!("{}\n{why}", plan.to_text()));
}

/// Each mip is made of the one above it, in one texture: reading one mip while writing another is allowed.
#[test]
fn mip_chain() {
    let mut frame = Frame::new();
    let desc = TextureDesc { mip_levels: 3, ..TextureDesc::d2(1024, 1024, Format::R32Float) };
    let mut pyramid = frame.create_texture("pyramid", desc);
    frame.render_pass("mip 0").subresource(Subresource::FULL.mip(0)).color(&mut pyramid, Contents::Overwrite);
    for mip in 1..3 {
        let above = pyramid.clone();
        let mut pass = frame.render_pass(format_args!("mip {mip}"));
        pass.subresource(Subresource::FULL.mip(mip - 1)).sample(&above);
        pass.subresource(Subresource::FULL.mip(mip)).color(&mut pyramid, Contents::Overwrite);
    }
    frame.export_texture(&pyramid);
    check("mip_chain", &plan(frame).to_text());
}
