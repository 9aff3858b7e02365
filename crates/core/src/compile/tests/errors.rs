//! Errors of a frame: each names the pass, the resource and a fix.

use super::helpers::{BLACK, color, filter, plan};
use crate::test_text::without_places;
use crate::{Contents, Error, Format, Frame, PassName, TextureDesc, TextureUsages};

fn message(frame: Frame<'_>) -> String {
    without_places(&frame.compile().err().expect("an error"))
}

#[test]
fn a_read_through_a_stale_handle_names_the_writer() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("first").color(&mut a, BLACK);
    let stale = a.clone();
    frame.render_pass("second").color(&mut a, Contents::Preserve);
    filter(&mut frame, "third", &stale);
    let text = message(frame);
    assert!(text.contains("`third` reads version 1 of `a`"), "{text}");
    assert!(text.contains("`second` has since written version 2"), "{text}");
    assert!(text.contains("use the handle that was passed to it by `&mut`"), "{text}");
}

#[test]
fn each_pass_of_an_error_has_the_place_of_its_declaration() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    let mut clone = a.clone();
    frame.render_pass("first").color(&mut a, BLACK);
    let line = line!() - 1;
    frame.node("node", |frame| frame.render_pass("second").color(&mut clone, BLACK));
    let error = frame.compile().err().unwrap();
    let Error::TwoWriters { pass, writer, .. } = &error else { panic!("{error}") };
    let place = |name: &PassName| name.declared_at().map(|place| (place.file(), place.line()));
    assert_eq!((writer.path(), pass.path()), ("first", "node/second"));
    assert_eq!([place(writer), place(pass)], [line, line + 2].map(|line| Some((file!(), line))));
    let named = format!("pass `node/second` ({}:{}:", file!(), line + 2);
    assert!(error.to_string().contains(&named), "{error}");
}

#[test]
fn two_writers_of_one_version_are_refused() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    let mut clone = a.clone();
    frame.render_pass("first").color(&mut a, BLACK);
    frame.render_pass("second").color(&mut clone, BLACK);
    let text = message(frame);
    assert!(
        text.contains("`second` writes version 0 of `a`, which `first` has already overwritten"),
        "{text}"
    );
    assert!(text.contains("same handle by `&mut`"), "{text}");
}

#[test]
fn a_read_of_undefined_contents_is_refused() {
    let mut frame = Frame::new();
    let a = color(&mut frame, "a");
    filter(&mut frame, "blur", &a);
    let text = message(frame);
    assert!(text.contains("`blur` reads all of `a`, which is not fully defined"), "{text}");
    assert!(text.contains("write all of it in earlier passes"), "{text}");
}

#[test]
fn preserving_undefined_contents_is_refused() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, Contents::Preserve);
    assert!(matches!(frame.compile().err(), Some(Error::UndefinedPreserve { .. })));
}

#[test]
fn exporting_undefined_contents_is_refused() {
    let mut frame = Frame::new();
    let a = color(&mut frame, "a");
    frame.export_texture(&a);
    assert!(matches!(frame.compile().err(), Some(Error::UndefinedRead { .. })));
}

#[test]
fn writing_after_an_export_is_refused() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("first").color(&mut a, BLACK);
    frame.export_texture(&a);
    frame.render_pass("second").color(&mut a, BLACK);
    let text = message(frame);
    assert!(
        text.contains("the export reads version 1 of `a`, but `second` has since written version 2"),
        "{text}"
    );
}

#[test]
fn a_token_of_another_pass_does_not_resolve() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    let mut first = frame.render_pass("first");
    let token = first.color(&mut a, BLACK);
    let first = first.id();
    let mut second = frame.compute_pass("second");
    second.keep();
    let second = second.id();
    frame.export_texture(&a);
    let id = frame.id();
    let plan = plan(frame);
    let places = &plan.decl.places;
    assert!(plan.resolve((id, places), first, token.0).is_ok());
    let text = without_places(&plan.resolve((id, places), second, token.0).unwrap_err());
    assert!(text.contains("`second` uses `a` without declaring the access"), "{text}");
    assert!(text.contains("belongs to `first`"), "{text}");
    assert!(text.contains("declare the access on the pass that uses it"), "{text}");
    assert!(matches!(plan.resolve((id + 1, places), first, token.0), Err(Error::ForeignHandle { .. })));
}

#[test]
fn a_handle_of_another_frame_is_refused() {
    let a = color(&mut Frame::new(), "a");
    let mut frame = Frame::new();
    color(&mut frame, "own");
    filter(&mut frame, "blur", &a);
    assert!(message(frame).contains("`blur` uses a handle of another frame"));
}

#[test]
fn reading_and_writing_one_texture_in_one_pass_is_refused() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("clear").color(&mut a, BLACK);
    let mut pass = frame.render_pass("feedback");
    pass.sample(&a);
    pass.color(&mut a, Contents::Preserve);
    let text = message(frame);
    assert!(text.contains("`feedback` uses `a` as sampled and as color"), "{text}");
}

#[test]
fn read_only_depth_may_be_sampled_in_the_same_pass() {
    let mut frame = Frame::new();
    let mut depth = frame.create_texture("depth", TextureDesc::d2(64, 64, Format::Depth32Float));
    frame.render_pass("prepass").depth(&mut depth, Contents::clear_depth(0.0));
    let mut out = color(&mut frame, "out");
    let mut pass = frame.render_pass("main");
    pass.depth_read(&depth);
    pass.sample(&depth);
    pass.color(&mut out, BLACK);
    frame.export_texture(&out);
    assert!(frame.compile().is_ok());
}

#[test]
fn attachments_of_different_sizes_are_refused_with_both_sizes() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    let mut depth = frame.create_texture("depth", TextureDesc::d2(32, 64, Format::Depth32Float));
    let mut pass = frame.render_pass("draw");
    pass.color(&mut a, BLACK);
    pass.depth(&mut depth, Contents::clear_depth(0.0));
    let text = message(frame);
    assert!(text.contains("`a` is 64x64, `depth` is 32x64"), "{text}");
}

#[test]
fn a_render_pass_needs_an_attachment() {
    let mut frame = Frame::new();
    frame.render_pass("empty");
    assert!(matches!(frame.compile().err(), Some(Error::NoAttachment { .. })));
}

#[test]
fn formats_and_clear_values_must_match_the_attachment() {
    let mut frame = Frame::new();
    let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth32Float));
    frame.render_pass("draw").color(&mut depth, BLACK);
    assert!(message(frame).contains("is a depth format; use `depth`"));

    let mut frame = Frame::new();
    let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth32Float));
    frame.render_pass("draw").depth(&mut depth, Contents::clear_depth(2.0));
    assert!(message(frame).contains("a depth outside 0 to 1"));
}

#[test]
fn an_import_without_the_needed_usage_is_refused() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
    let mut out = frame.declare_import_texture("surface", desc, TextureUsages::TEXTURE_BINDING, false);
    frame.render_pass("draw").color(&mut out, BLACK);
    let text = message(frame);
    assert!(text.contains("imported `surface`") && text.contains("RENDER_ATTACHMENT"), "{text}");
}

#[test]
fn a_texture_without_extent_is_refused() {
    let mut frame = Frame::new();
    frame.create_texture("nothing", TextureDesc::d2(0, 8, Format::Rgba8Unorm));
    let text = message(frame);
    assert!(text.contains("`nothing`") && text.contains("a side is 0"), "{text}");
}

#[test]
fn errors_name_the_nodes_around_a_pass_and_a_resource() {
    let mut frame = Frame::new();
    let a = frame.node("tone", |frame| color(frame, "value"));
    frame.node("post", |frame| frame.node("bloom", |frame| filter(frame, "down", &a)));
    let text = message(frame);
    assert!(text.contains("`post/bloom/down`") && text.contains("`tone/value`"), "{text}");
}
