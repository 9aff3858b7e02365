//! Changes that make a frame invalid.

use crate::{
    BufferDesc, ClearValue, Contents, Format, Frame, Rect, Resize, Subresource, Texture, TextureDesc,
    TextureUsages,
};

/// Makes a valid frame invalid.
type InvalidChange = fn(&mut Frame<'static>);

const BLACK: Contents = Contents::Clear(ClearValue::Color([0.0; 4]));

/// Invalid changes, with the code of the error for each.
pub(in super::super) const INVALID_CHANGES: [(&str, InvalidChange); 26] = [
    ("SG0101", |frame| {
        let mut texture = written(frame);
        let stale = texture.clone();
        frame.render_pass("again").color(&mut texture, BLACK);
        frame.compute_pass("bad").sample(&stale);
    }),
    ("SG0101", |frame| {
        let mut texture = written(frame);
        frame.export_texture(&texture);
        frame.render_pass("bad").color(&mut texture, BLACK);
    }),
    ("SG0102", |frame| {
        let mut texture = color(frame);
        let mut clone = texture.clone();
        frame.render_pass("first").color(&mut texture, BLACK);
        frame.render_pass("bad").color(&mut clone, BLACK);
    }),
    ("SG0103", |frame| {
        let other = color(&mut Frame::new());
        frame.compute_pass("bad").sample(&other);
    }),
    ("SG0201", |frame| {
        let texture = color(frame);
        frame.compute_pass("bad").sample(&texture);
    }),
    ("SG0201", |frame| {
        let texture = color(frame);
        frame.export_texture(&texture);
    }),
    ("SG0201", |frame| {
        frame.history("bad", TextureDesc::d2(8, 8, Format::Rgba8Unorm), Resize::Reset);
    }),
    ("SG0201", |frame| {
        let mut texture = color(frame);
        let part = Subresource::FULL.rect(Rect::new(0, 0, 8, 7));
        frame.render_pass("most of it").subresource(part).color(&mut texture, BLACK);
        frame.compute_pass("bad").sample(&texture);
    }),
    ("SG0202", |frame| {
        let mut texture = color(frame);
        frame.render_pass("bad").color(&mut texture, Contents::Preserve);
    }),
    ("SG0203", |frame| {
        let mut texture = written(frame);
        let mut pass = frame.render_pass("bad");
        pass.sample(&texture);
        pass.color(&mut texture, Contents::Preserve);
    }),
    ("SG0204", |frame| {
        let mut history = frame.history("kept", TextureDesc::d2(8, 8, Format::Rgba8Unorm), Resize::Reset);
        frame.render_pass("good").color(&mut history.current, BLACK);
        frame.render_pass("bad").color(&mut history.previous, BLACK);
    }),
    ("SG0301", |frame| {
        frame.render_pass("bad");
    }),
    ("SG0302", |frame| {
        let mut texture = color(frame);
        let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 4, Format::Depth32Float));
        let mut pass = frame.render_pass("bad");
        pass.color(&mut texture, BLACK);
        pass.depth(&mut depth, Contents::clear_depth(0.0));
    }),
    ("SG0303", |frame| {
        let mut layers = frame.create_texture("layers", TextureDesc::d2(8, 8, Format::Rgba8Unorm).layers(2));
        frame.render_pass("bad").color(&mut layers, BLACK);
    }),
    ("SG0304", |frame| {
        let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth32Float));
        frame.render_pass("bad").color(&mut depth, BLACK);
    }),
    ("SG0305", |frame| {
        let mut texture = color(frame);
        frame.render_pass("bad").color(&mut texture, Contents::clear_depth(0.0));
    }),
    ("SG0305", |frame| {
        let mut texture = color(frame);
        frame.compute_pass("bad").storage_texture_mut(&mut texture, BLACK);
    }),
    ("SG0306", |frame| {
        let (mut texture, mut target) = (color(frame), color(frame));
        let mut pass = frame.render_pass("bad");
        pass.color(&mut texture, BLACK);
        pass.resolve(&mut target);
    }),
    ("SG0306", |frame| {
        let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
        let mut texture = frame.create_texture("samples", TextureDesc { samples: 4, ..desc });
        let mut target = written(frame);
        let mut pass = frame.render_pass("bad");
        pass.color(&mut texture, BLACK);
        pass.subresource(Subresource::FULL.rect(Rect::new(0, 0, 4, 4))).resolve(&mut target);
    }),
    ("SG0307", |frame| {
        let mut depth = || frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth32Float));
        let (mut first, mut second) = (depth(), depth());
        let mut pass = frame.render_pass("bad");
        pass.depth(&mut first, Contents::clear_depth(0.0));
        pass.depth(&mut second, Contents::clear_depth(0.0));
    }),
    ("SG0308", |frame| {
        let texture = written(frame);
        let mut other = frame.create_texture("other", TextureDesc::d2(8, 4, Format::Rgba8Unorm));
        frame.copy_pass("bad").texture(&texture, &mut other);
    }),
    ("SG0401", |frame| {
        frame.create_texture("bad", TextureDesc::d2(0, 8, Format::Rgba8Unorm));
    }),
    ("SG0402", |frame| {
        let mut texture = color(frame);
        frame.render_pass("bad").subresource(Subresource::FULL.mip(1)).color(&mut texture, BLACK);
    }),
    ("SG0402", |frame| {
        let mut buffer = frame.create_buffer("short", BufferDesc::new(16));
        frame
            .compute_pass("bad")
            .subresource(Subresource::FULL.bytes(8..24))
            .storage_buffer_mut(&mut buffer, Contents::Overwrite);
    }),
    ("SG0403", |frame| {
        let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
        let mut surface = frame.declare_import_texture("surface", desc, TextureUsages::TEXTURE_BINDING, true);
        frame.render_pass("bad").color(&mut surface, BLACK);
    }),
    ("SG0501", |frame| {
        let mut pass = frame.encoder_pass("bad");
        let own = pass.id();
        pass.after(own);
    }),
];

fn color(frame: &mut Frame<'_>) -> Texture {
    frame.create_texture("color", TextureDesc::d2(8, 8, Format::Rgba8Unorm))
}

fn written(frame: &mut Frame<'_>) -> Texture {
    let mut texture = color(frame);
    frame.render_pass("write").color(&mut texture, BLACK);
    texture
}
