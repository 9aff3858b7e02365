//! Tiles, layers, mips and byte ranges.

use super::{BLACK, FAR, check, hdr, plan};
use shadowgraph_core::{Contents, Format, Frame, Rect, Subresource, TextureDesc};

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
