//! Errors that `compile` returns, without a device.

use super::{Failure, square};
use shadowgraph_core::{
    BufferDesc, ClearValue, Contents, Error, Format, Frame, Rect, Resize, Subresource, Texture,
};
use shadowgraph_core::{TextureDesc, TextureUsages};

const BLACK: Contents = Contents::Clear(ClearValue::Color([0.0; 4]));

fn error(declare: impl FnOnce(&mut Frame<'_>)) -> Error {
    let mut frame = Frame::new();
    declare(&mut frame);
    frame.compile().err().expect("a failure")
}

fn failure(
    code: &'static str,
    words: &'static [&'static str],
    declare: impl FnOnce(&mut Frame<'_>),
) -> Failure {
    Failure { code, error: error(declare), words }
}

fn depth(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(64, 64, Format::Depth32Float))
}

pub(crate) fn failures() -> Vec<Failure> {
    [handles(), contents(), attachments(), formats(), copies(), resources(), order()]
        .into_iter()
        .flatten()
        .collect()
}

fn handles() -> Vec<Failure> {
    vec![
        failure(
            "SG0101",
            &["pass `late` reads version 1 of `a`", "`again` has since written version 2", "read before"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                frame.render_pass("first").color(&mut a, BLACK);
                let stale = a.clone();
                frame.render_pass("again").color(&mut a, Contents::Preserve);
                frame.compute_pass("late").sample(&stale);
            },
        ),
        failure("SG0101", &["the export reads version 1 of `a`", "`again` has since"], |frame| {
            let mut a = frame.create_texture("a", square());
            frame.render_pass("first").color(&mut a, BLACK);
            frame.export_texture(&a);
            frame.render_pass("again").color(&mut a, BLACK);
        }),
        failure(
            "SG0102",
            &["pass `second` writes version 0 of `a`", "`first` has already", "same handle by `&mut`"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                let mut clone = a.clone();
                frame.render_pass("first").color(&mut a, BLACK);
                frame.render_pass("second").color(&mut clone, BLACK);
            },
        ),
        failure("SG0103", &["pass `node/read` uses a handle of another frame", "import"], |frame| {
            let other = Frame::new().create_texture("a", square());
            frame.node("node", |frame| frame.compute_pass("read").sample(&other));
        }),
    ]
}

fn contents() -> Vec<Failure> {
    vec![
        failure(
            "SG0201",
            &["pass `read` reads mip 1 of `a`", "not fully defined", "earlier pass"],
            |frame| {
                let desc = TextureDesc { mip_levels: 2, ..square() };
                let mut a = frame.create_texture("a", desc);
                frame.render_pass("first").subresource(Subresource::FULL.mip(0)).color(&mut a, BLACK);
                frame.compute_pass("read").subresource(Subresource::FULL.mip(1)).sample(&a);
            },
        ),
        failure("SG0201", &["the next frame reads all of `h`"], |frame| {
            frame.history("h", square(), Resize::Reset);
        }),
        failure(
            "SG0202",
            &["pass `draw` preserves all of `a`", "not fully defined", "`Contents::Clear`"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                frame.render_pass("draw").color(&mut a, Contents::Preserve);
            },
        ),
        failure(
            "SG0203",
            &["pass `blur` uses `a` as sampled and as color", "split the pass", "another texture"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                frame.render_pass("first").color(&mut a, BLACK);
                let before = a.clone();
                let mut blur = frame.render_pass("blur");
                blur.sample(&before);
                blur.color(&mut a, Contents::Overwrite);
            },
        ),
        failure("SG0203", &["as storage write (bytes 0..4) and as storage write (bytes 4..8)"], |frame| {
            let mut b = frame.create_buffer("b", BufferDesc::new(8));
            let mut pass = frame.compute_pass("pass");
            pass.subresource(Subresource::FULL.bytes(0..4)).storage_buffer_mut(&mut b, Contents::Overwrite);
            pass.subresource(Subresource::FULL.bytes(4..8)).storage_buffer_mut(&mut b, Contents::Overwrite);
        }),
        failure("SG0204", &["pass `draw` writes `h before`", "`current`"], |frame| {
            let mut h = frame.history("h", square(), Resize::Reset);
            frame.render_pass("draw").color(&mut h.previous, BLACK);
        }),
    ]
}

fn attachments() -> Vec<Failure> {
    vec![
        failure("SG0301", &["render pass `draw` has no attachment", "or make it a compute pass"], |frame| {
            frame.render_pass("draw");
        }),
        failure(
            "SG0302",
            &["pass `draw`", "`a` is 64x64", "`small` is 32x32 with 4 samples", "same size and sample count"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                let desc = TextureDesc { samples: 4, ..TextureDesc::d2(32, 32, Format::Depth32Float) };
                let mut small = frame.create_texture("small", desc);
                let mut draw = frame.render_pass("draw");
                draw.color(&mut a, BLACK);
                draw.depth(&mut small, Contents::clear_depth(0.0));
            },
        ),
        failure(
            "SG0303",
            &["pass `draw` attaches all of `cube`", "one mip of one layer", "`subresource("],
            |frame| {
                let mut cube = frame.create_texture("cube", square().layers(6));
                frame.render_pass("draw").color(&mut cube, BLACK);
            },
        ),
        failure("SG0306", &["pass `draw` resolves into `b`", "`a` has one sample"], |frame| {
            let mut a = frame.create_texture("a", square());
            let mut b = frame.create_texture("b", square());
            let mut draw = frame.render_pass("draw");
            draw.color(&mut a, BLACK);
            draw.resolve(&mut b);
        }),
        failure("SG0307", &["pass `draw`", "`near` and `far`", "split the pass in two"], |frame| {
            let (mut near, mut far) = (depth(frame, "near"), depth(frame, "far"));
            let mut draw = frame.render_pass("draw");
            draw.depth(&mut near, Contents::clear_depth(0.0));
            draw.depth(&mut far, Contents::clear_depth(0.0));
        }),
    ]
}

fn formats() -> Vec<Failure> {
    vec![
        failure("SG0304", &["pass `draw` uses `d` as color", "Depth32Float", "use `depth`"], |frame| {
            let mut d = depth(frame, "d");
            frame.render_pass("draw").color(&mut d, BLACK);
        }),
        failure("SG0304", &["pass `write` uses `d` as storage write", "sample it"], |frame| {
            let mut d = depth(frame, "d");
            frame.compute_pass("write").storage_texture_mut(&mut d, Contents::Overwrite);
        }),
        failure(
            "SG0305",
            &["pass `draw` clears `d` with a colour", "use `Contents::clear_depth`"],
            |frame| {
                let mut d = depth(frame, "d");
                frame.render_pass("draw").depth(&mut d, BLACK);
            },
        ),
        failure("SG0305", &["pass `write` clears `b`", "use `Contents::Overwrite`"], |frame| {
            let mut b = frame.create_buffer("b", BufferDesc::new(4));
            frame.compute_pass("write").storage_buffer_mut(&mut b, BLACK);
        }),
    ]
}

fn copies() -> Vec<Failure> {
    vec![
        failure(
            "SG0308",
            &["pass `copy` cannot copy `a` (64x64 Rgba8Unorm) to `b` (32x32 Rgba8Unorm)", "`texture_region`"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                let mut b = frame.create_texture("b", TextureDesc::d2(32, 32, Format::Rgba8Unorm));
                frame.render_pass("draw").color(&mut a, BLACK);
                frame.copy_pass("copy").texture(&a, &mut b);
            },
        ),
        failure("SG0308", &["`a`", "it needs 16384 bytes; make the buffer that large"], |frame| {
            let mut a = frame.create_texture("a", square());
            let mut b = frame.create_buffer("b", BufferDesc::new(4));
            frame.render_pass("draw").color(&mut a, BLACK);
            frame.copy_pass("copy").texture_to_buffer(&a, &mut b);
        }),
        failure("SG0308", &["bytes 0..6 of `a`", "multiples of 4", "`buffer_range`"], |frame| {
            let a = frame.upload_buffer("a", vec![0; 8]);
            let mut b = frame.create_buffer("b", BufferDesc::new(8));
            let subresource = Subresource::FULL.bytes(0..6);
            frame.copy_pass("copy").buffer_range(&a, subresource, &mut b, subresource);
        }),
    ]
}

fn resources() -> Vec<Failure> {
    vec![
        failure("SG0401", &["`nothing` is invalid", "every side must be at least 1"], |frame| {
            frame.create_texture("nothing", TextureDesc::d2(0, 8, Format::Rgba8Unorm));
        }),
        failure("SG0402", &["pass `draw` uses 8x8 at 60,0 of `a`", "extends past the mip"], |frame| {
            let mut a = frame.create_texture("a", square());
            frame
                .render_pass("draw")
                .subresource(Subresource::FULL.rect(Rect::new(60, 0, 8, 8)))
                .color(&mut a, BLACK);
        }),
        failure("SG0402", &["pass `draw` uses mip 3 of `a`", "past the last mip"], |frame| {
            let mut a = frame.create_texture("a", square());
            frame.render_pass("draw").subresource(Subresource::FULL.mip(3)).color(&mut a, BLACK);
        }),
        failure(
            "SG0403",
            &[
                "pass `draw` uses imported `window` as color",
                "without `RENDER_ATTACHMENT`",
                "where you create it",
            ],
            |frame| {
                let usage = TextureUsages::TEXTURE_BINDING;
                let mut window = frame.declare_import_texture("window", square(), usage, false);
                frame.render_pass("draw").color(&mut window, BLACK);
            },
        ),
    ]
}

fn order() -> Vec<Failure> {
    let mut unpublished = Frame::new();
    let published =
        unpublished.node("fog", |frame| frame.published::<Subresource>().err()).expect("nothing was");
    vec![
        failure("SG0501", &["pass `show` must run after pass 0", "the id of an earlier pass"], |frame| {
            let mut show = frame.encoder_pass("show");
            let id = show.id();
            show.after(id);
        }),
        Failure {
            code: "SG0502",
            error: published,
            words: &["node `fog` looks up", "Subresource`", "add the node that publishes it"],
        },
    ]
}
