//! Contents of parts: mips, layers, aspects, ranges of bytes, rectangles.

use super::helpers::{BLACK, FAR, accesses, depends, draw, look, ops, order, pass, plan, quarter};
use crate::{
    Aspect, BufferDesc, ClearValue, Contents, Error, Format, Frame, LoadAction, LoadReason, Rect,
    StoreAction, StoreReason, Subresource, TextureDesc, TextureUsages,
};
use wgpu_types::TextureDimension;

fn layered() -> TextureDesc {
    TextureDesc { mip_levels: 3, ..TextureDesc::d2(64, 64, Format::Rgba8Unorm).layers(2) }
}

#[test]
fn mips_and_layers_have_separate_contents() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", layered());
    frame.render_pass("draw").subresource(Subresource::FULL.mip(1).layer(0)).color(&mut a, BLACK);
    let mut fine = frame.compute_pass("fine");
    fine.subresource(Subresource::FULL.mip(1).layer(0)).sample(&a);
    fine.keep();
    frame.compute_pass("bad").subresource(Subresource::FULL.mip(1)).sample(&a);
    let error = frame.compile().err().unwrap();
    assert!(matches!(&error, Error::UndefinedRead { subresource, .. } if subresource == "mip 1"), "{error}");
}

#[test]
fn all_mips_and_layers_together_are_the_full_resource() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", layered());
    for (mip, layer) in (0..3).flat_map(|mip| [(mip, 0), (mip, 1)]) {
        let mut pass = frame.render_pass(format_args!("{mip} {layer}"));
        pass.subresource(Subresource::FULL.mip(mip).layer(layer)).color(&mut a, BLACK);
    }
    frame.export_texture(&a);
    let plan = plan(frame);
    assert_eq!(plan.order().len(), 6);
    assert!(plan.dependencies().is_empty(), "they do not order each other");
}

#[test]
fn aspects_of_a_depth_stencil_texture_have_separate_contents() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(64, 64, Format::Depth24PlusStencil8);
    let mut texture = frame.create_texture("depth", desc);
    frame.render_pass("depth").subresource(Subresource::FULL.aspect(Aspect::Depth)).depth(&mut texture, FAR);
    frame
        .render_pass("stencil")
        .subresource(Subresource::FULL.aspect(Aspect::Stencil))
        .depth(&mut texture, FAR);
    let mut read = frame.compute_pass("read");
    read.subresource(Subresource::FULL.aspect(Aspect::Stencil)).sample(&texture);
    read.keep();
    let plan = plan(frame);
    assert_eq!(order(&plan), ["stencil", "read"], "nothing needs the depth");
    assert!(!plan.resource(texture.id()).texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT));
}

#[test]
fn a_single_aspect_is_not_a_transient_attachment() {
    // The other aspect would be read-only, which wgpu forbids for transient attachments.
    let mut frame = Frame::new();
    let mut texture = frame.create_texture("depth", TextureDesc::d2(64, 64, Format::Depth24PlusStencil8));
    let mut out = frame.create_texture("out", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    let mut draw = frame.render_pass("draw");
    draw.subresource(Subresource::FULL.aspect(Aspect::Depth)).depth(&mut texture, FAR);
    draw.color(&mut out, BLACK);
    frame.export_texture(&out);
    let plan = plan(frame);
    assert_eq!(plan.resource(texture.id()).texture_usage, TextureUsages::RENDER_ATTACHMENT);
}

#[test]
fn ranges_of_a_buffer_have_separate_contents() {
    let mut frame = Frame::new();
    let mut buffer = frame.create_buffer("buffer", BufferDesc::new(64));
    let halves = [0..32, 32..64].map(|bytes| Subresource::FULL.bytes(bytes));
    frame.compute_pass("low").subresource(halves[0]).storage_buffer_mut(&mut buffer, Contents::Overwrite);
    frame.compute_pass("high").subresource(halves[1]).storage_buffer_mut(&mut buffer, Contents::Overwrite);
    let mut read = frame.compute_pass("read");
    read.subresource(halves[1]).storage_buffer(&buffer);
    read.keep();
    let plan = plan(frame);
    assert_eq!(order(&plan), ["high", "read"], "nothing needs the lower half");
}

#[test]
fn the_number_of_slices_of_a_volume_halves_from_mip_to_mip() {
    let volume = TextureDesc {
        mip_levels: 2,
        dimension: TextureDimension::D3,
        ..TextureDesc::d2(8, 8, Format::Rgba8Unorm).layers(4)
    };
    let mut frame = Frame::new();
    let mut texture = frame.create_texture("volume", volume);
    for (mip, slice) in [(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (1, 1)] {
        let subresource = Subresource::FULL.mip(mip).layer(slice);
        frame.render_pass("slice").subresource(subresource).color(&mut texture, BLACK);
    }
    frame.export_texture(&texture);
    assert_eq!(plan(frame).order().len(), 6, "these are all slices there are");

    let mut frame = Frame::new();
    let mut texture = frame.create_texture("volume", volume);
    frame.render_pass("bad").subresource(Subresource::FULL.mip(1).layer(2)).color(&mut texture, BLACK);
    assert_eq!(frame.compile().err().unwrap().code(), "SG0402");
}

#[test]
fn tiles_do_not_order_each_other_and_a_reader_waits_only_for_its_tile() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(64, 64, Format::Depth32Float));
    for index in 0..4 {
        frame.render_pass(format_args!("tile {index}")).subresource(quarter(index)).depth(&mut atlas, FAR);
    }
    let mut read = frame.compute_pass("read");
    read.subresource(quarter(2)).sample(&atlas);
    read.keep();
    let plan = plan(frame);
    assert_eq!(order(&plan), ["tile 2", "read"], "the other tiles are not needed");
    assert!(depends(&plan, "read", "tile 2"));
}

#[test]
fn a_single_tile_is_cleared_by_the_load_operation() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(64, 64, Format::Depth32Float));
    frame.render_pass("tile").subresource(quarter(0)).depth(&mut atlas, FAR);
    let mut read = frame.compute_pass("read");
    read.subresource(quarter(0)).sample(&atlas);
    read.keep();
    let plan = plan(frame);
    let ops = ops(&plan, "tile", 0);
    assert_eq!((ops.load, ops.clear_drawn), (LoadAction::Clear(ClearValue::Depth(0.0)), false));
}

#[test]
fn a_tile_next_to_live_ones_is_cleared_by_a_draw() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(64, 64, Format::Depth32Float);
    let mut atlas = frame.declare_import_texture("atlas", desc, TextureUsages::all(), true);
    frame.render_pass("tile").subresource(quarter(1)).depth(&mut atlas, FAR);
    let plan = plan(frame);
    let ops = ops(&plan, "tile", 0);
    assert_eq!((ops.load, ops.load_reason), (LoadAction::Load, LoadReason::RestOutlives));
    assert!(ops.clear_drawn);
}

#[test]
fn the_rest_is_loaded_for_the_pass_that_needs_it() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    draw(&mut frame, "all", &mut a, BLACK);
    look(&mut frame, "between", &a);
    frame.render_pass("tile").subresource(quarter(3)).color(&mut a, Contents::Overwrite);
    let reader = look(&mut frame, "reader", &a);
    let plan = plan(frame);
    let ops = ops(&plan, "tile", 0);
    assert_eq!((ops.load, ops.load_reason), (LoadAction::Load, LoadReason::RestNeededBy(reader)));
    assert_eq!((ops.store, ops.store_reason), (StoreAction::Store, StoreReason::NeededBy(reader)));
}

#[test]
fn the_rest_is_not_loaded_if_nothing_needs_it() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    draw(&mut frame, "all", &mut a, BLACK);
    look(&mut frame, "between", &a);
    frame.render_pass("tile").subresource(quarter(3)).color(&mut a, Contents::Overwrite);
    let mut read = frame.compute_pass("read");
    read.subresource(quarter(3)).sample(&a);
    read.keep();
    let plan = plan(frame);
    let ops = ops(&plan, "tile", 0);
    assert_eq!(ops.load_reason, LoadReason::RestUnneeded);
    assert!(matches!(ops.load, LoadAction::Clear(_)));
}

#[test]
fn a_subresource_that_covers_the_resource_is_the_full_resource() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    let all = Subresource::FULL.mips(0..1).layers(0..1).rect(Rect::new(0, 0, 64, 64));
    frame.render_pass("draw").subresource(all).color(&mut a, BLACK);
    frame.export_texture(&a);
    let plan = plan(frame);
    assert_eq!(accesses(&plan, "draw")[0].subresource, Subresource::FULL);
}

#[test]
fn a_tile_may_not_be_sampled_while_another_is_drawn_in_one_pass() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    draw(&mut frame, "all", &mut a, BLACK);
    let mut bad = frame.render_pass("bad");
    bad.subresource(quarter(0)).sample(&a);
    bad.subresource(quarter(1)).color(&mut a, Contents::Overwrite);
    assert_eq!(frame.compile().err().unwrap().code(), "SG0203", "wgpu tracks mips and layers, not tiles");
}

#[test]
fn a_mip_may_be_sampled_while_another_is_drawn_in_one_pass() {
    let mut frame = Frame::new();
    let mut a = frame
        .create_texture("a", TextureDesc { mip_levels: 2, ..TextureDesc::d2(64, 64, Format::Rgba8Unorm) });
    frame.render_pass("mip 0").subresource(Subresource::FULL.mip(0)).color(&mut a, BLACK);
    let mut down = frame.render_pass("mip 1");
    down.subresource(Subresource::FULL.mip(0)).sample(&a);
    down.subresource(Subresource::FULL.mip(1)).color(&mut a, Contents::Overwrite);
    frame.export_texture(&a);
    let plan = plan(frame);
    assert_eq!(order(&plan), ["mip 0", "mip 1"]);
    assert_eq!(plan.dependencies()[0].before, pass(&plan, "mip 0"));
}

#[test]
fn a_resolve_target_cannot_be_a_rectangle() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(64, 64, Format::Rgba8Unorm);
    let mut samples = frame.create_texture("samples", TextureDesc { samples: 4, ..desc });
    let mut target = frame.create_texture("target", desc);
    let mut bad = frame.render_pass("bad");
    bad.color(&mut samples, BLACK);
    bad.subresource(quarter(0)).resolve(&mut target);
    assert_eq!(frame.compile().err().unwrap().code(), "SG0306", "wgpu resolves all of a mip");
}

#[test]
fn an_encoder_pass_may_read_a_texture_outside_of_what_it_draws() {
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    draw(&mut frame, "all", &mut a, BLACK);
    let mut encoder = frame.encoder_pass("encoder");
    encoder.subresource(quarter(0)).copy_source(&a);
    encoder.subresource(quarter(1)).attachment(&mut a, Contents::Overwrite);
    encoder.keep();
    let plan = plan(frame);
    assert_eq!(accesses(&plan, "encoder")[1].ops.unwrap().load, LoadAction::Load);
}
