//! Mistakes that `compile` finds, without a device.

use super::{Mistake, square};
use shadowgraph_core::{
    BufferDesc, ClearValue, Contents, Dump, Error, Format, Frame, Rect, Resize, Subresource, Texture,
};
use shadowgraph_core::{TextureDesc, TextureUsages};

const BLACK: Contents = Contents::Clear(ClearValue::Color([0.0; 4]));

fn error(declare: impl FnOnce(&mut Frame<'_>)) -> Error {
    let mut frame = Frame::new();
    declare(&mut frame);
    frame.compile().err().expect("a mistake")
}

fn report_error(
    code: &'static str,
    words: &'static [&'static str],
    declare: impl FnOnce(&mut Frame<'_>),
) -> Mistake {
    Mistake { code, error: error(declare), words }
}

fn depth(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(64, 64, Format::Depth32Float))
}

pub(crate) fn mistakes() -> Vec<Mistake> {
    [handles(), contents(), attachments(), formats(), copies(), resources(), order(), dumps()]
        .into_iter()
        .flatten()
        .collect()
}

/// What is asked of a plan and of its dump.
fn dumps() -> Vec<Mistake> {
    let plan = Frame::new().compile().expect("an empty frame").into_plan();
    let words = &["`draw`", "`dump` lists them"];
    let unknown = Mistake { code: "SG0701", error: plan.explain("draw").expect_err("no pass"), words };
    let old = Dump::from_json(r#"{"schema": 1}"#).expect_err("an old dump");
    vec![unknown, Mistake { code: "SG0702", error: old, words: &["schema 1", "write it anew"] }]
}

fn handles() -> Vec<Mistake> {
    vec![
        report_error(
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
        report_error("SG0101", &["the export reads version 1 of `a`", "`again` has since"], |frame| {
            let mut a = frame.create_texture("a", square());
            frame.render_pass("first").color(&mut a, BLACK);
            frame.export_texture(&a);
            frame.render_pass("again").color(&mut a, BLACK);
        }),
        report_error(
            "SG0102",
            &["pass `second` writes version 0 of `a`", "`first` has already", "same handle by `&mut`"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                let mut twin = a.clone();
                frame.render_pass("first").color(&mut a, BLACK);
                frame.render_pass("second").color(&mut twin, BLACK);
            },
        ),
        report_error("SG0103", &["pass `node/read` uses a handle of another frame", "import"], |frame| {
            let other = Frame::new().create_texture("a", square());
            frame.node("node", |frame| frame.compute_pass("read").sample(&other));
        }),
    ]
}

fn contents() -> Vec<Mistake> {
    vec![
        report_error("SG0201", &["pass `read` reads mip 1 of `a`", "undefined", "earlier pass"], |frame| {
            let desc = TextureDesc { mip_levels: 2, ..square() };
            let mut a = frame.create_texture("a", desc);
            frame.render_pass("first").subresource(Subresource::FULL.mip(0)).color(&mut a, BLACK);
            frame.compute_pass("read").subresource(Subresource::FULL.mip(1)).sample(&a);
        }),
        report_error("SG0201", &["the next frame reads all of `h`"], |frame| {
            frame.history("h", square(), Resize::Reset);
        }),
        report_error(
            "SG0202",
            &["pass `draw` preserves all of `a`", "undefined", "`Contents::Clear`"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                frame.render_pass("draw").color(&mut a, Contents::Preserve);
            },
        ),
        report_error(
            "SG0203",
            &["pass `blur` touches `a` as sampled and as color", "split it", "another texture"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                frame.render_pass("first").color(&mut a, BLACK);
                let before = a.clone();
                let mut blur = frame.render_pass("blur");
                blur.sample(&before);
                blur.color(&mut a, Contents::Overwrite);
            },
        ),
        report_error(
            "SG0203",
            &["as storage write (bytes 0..4) and as storage write (bytes 4..8)"],
            |frame| {
                let mut b = frame.create_buffer("b", BufferDesc::new(8));
                let mut pass = frame.compute_pass("pass");
                pass.subresource(Subresource::FULL.bytes(0..4))
                    .storage_buffer_mut(&mut b, Contents::Overwrite);
                pass.subresource(Subresource::FULL.bytes(4..8))
                    .storage_buffer_mut(&mut b, Contents::Overwrite);
            },
        ),
        report_error("SG0204", &["pass `draw` writes `h before`", "`current`"], |frame| {
            let mut h = frame.history("h", square(), Resize::Reset);
            frame.render_pass("draw").color(&mut h.previous, BLACK);
        }),
    ]
}

fn attachments() -> Vec<Mistake> {
    vec![
        report_error(
            "SG0301",
            &["render pass `draw` has no attachment", "or make it a compute pass"],
            |frame| {
                frame.render_pass("draw");
            },
        ),
        report_error(
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
        report_error(
            "SG0303",
            &["pass `draw` attaches all of `cube`", "one mip of one layer", "`on("],
            |frame| {
                let mut cube = frame.create_texture("cube", square().layers(6));
                frame.render_pass("draw").color(&mut cube, BLACK);
            },
        ),
        report_error("SG0306", &["pass `draw` resolves into `b`", "`a` has one sample"], |frame| {
            let mut a = frame.create_texture("a", square());
            let mut b = frame.create_texture("b", square());
            let mut draw = frame.render_pass("draw");
            draw.color(&mut a, BLACK);
            draw.resolve(&mut b);
        }),
        report_error("SG0307", &["pass `draw`", "`near` and `far`", "split it in two"], |frame| {
            let (mut near, mut far) = (depth(frame, "near"), depth(frame, "far"));
            let mut draw = frame.render_pass("draw");
            draw.depth(&mut near, Contents::clear_depth(0.0));
            draw.depth(&mut far, Contents::clear_depth(0.0));
        }),
    ]
}

fn formats() -> Vec<Mistake> {
    vec![
        report_error("SG0304", &["pass `draw` uses `d` as color", "Depth32Float", "use `depth`"], |frame| {
            let mut d = depth(frame, "d");
            frame.render_pass("draw").color(&mut d, BLACK);
        }),
        report_error("SG0304", &["pass `write` uses `d` as storage write", "sample it"], |frame| {
            let mut d = depth(frame, "d");
            frame.compute_pass("write").storage_texture_mut(&mut d, Contents::Overwrite);
        }),
        report_error(
            "SG0305",
            &["pass `draw` clears `d` with a colour", "use `Contents::clear_depth`"],
            |frame| {
                let mut d = depth(frame, "d");
                frame.render_pass("draw").depth(&mut d, BLACK);
            },
        ),
        report_error("SG0305", &["pass `write` clears `b`", "use `Contents::Overwrite`"], |frame| {
            let mut b = frame.create_buffer("b", BufferDesc::new(4));
            frame.compute_pass("write").storage_buffer_mut(&mut b, BLACK);
        }),
    ]
}

fn copies() -> Vec<Mistake> {
    vec![
        report_error(
            "SG0308",
            &["pass `copy` cannot copy `a` (64x64 Rgba8Unorm) to `b` (32x32 Rgba8Unorm)", "`texture_region`"],
            |frame| {
                let mut a = frame.create_texture("a", square());
                let mut b = frame.create_texture("b", TextureDesc::d2(32, 32, Format::Rgba8Unorm));
                frame.render_pass("draw").color(&mut a, BLACK);
                frame.copy_pass("copy").texture(&a, &mut b);
            },
        ),
        report_error("SG0308", &["`a`", "it needs 16384 bytes: give the buffer as many"], |frame| {
            let mut a = frame.create_texture("a", square());
            let mut b = frame.create_buffer("b", BufferDesc::new(4));
            frame.render_pass("draw").color(&mut a, BLACK);
            frame.copy_pass("copy").texture_to_buffer(&a, &mut b);
        }),
        report_error("SG0308", &["bytes 0..6 of `a`", "multiples of 4", "`buffer_range`"], |frame| {
            let a = frame.upload_buffer("a", vec![0; 8]);
            let mut b = frame.create_buffer("b", BufferDesc::new(8));
            let subresource = Subresource::FULL.bytes(0..6);
            frame.copy_pass("copy").buffer_range(&a, subresource, &mut b, subresource);
        }),
    ]
}

fn resources() -> Vec<Mistake> {
    vec![
        report_error("SG0401", &["`nothing` cannot be", "every side must be 1 or more"], |frame| {
            frame.create_texture("nothing", TextureDesc::d2(0, 8, Format::Rgba8Unorm));
        }),
        report_error("SG0402", &["pass `draw` touches 8x8 at 60,0 of `a`", "keep it inside"], |frame| {
            let mut a = frame.create_texture("a", square());
            frame
                .render_pass("draw")
                .subresource(Subresource::FULL.rect(Rect::new(60, 0, 8, 8)))
                .color(&mut a, BLACK);
        }),
        report_error("SG0402", &["pass `draw` touches mip 3 of `a`", "mips that it has"], |frame| {
            let mut a = frame.create_texture("a", square());
            frame.render_pass("draw").subresource(Subresource::FULL.mip(3)).color(&mut a, BLACK);
        }),
        report_error(
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

fn order() -> Vec<Mistake> {
    let mut unpublished = Frame::new();
    let published =
        unpublished.node("fog", |frame| frame.published::<Subresource>().err()).expect("nothing was");
    vec![
        report_error(
            "SG0501",
            &["pass `show` is to run after pass 0", "the id of an earlier pass"],
            |frame| {
                let mut show = frame.encoder_pass("show");
                let id = show.id();
                show.after(id);
            },
        ),
        Mistake {
            code: "SG0502",
            error: published,
            words: &["node `fog` looks up", "Subresource`", "add the node that does"],
        },
    ]
}
