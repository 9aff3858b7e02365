#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use super::*;
use crate::{Contents, Format, Frame, TextureDesc};

fn plan(blur: bool) -> Plan {
    let mut frame = Frame::new();
    let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    let mut picture = frame.create_texture("picture", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    if blur {
        frame.node("post", |frame| {
            let mut blurred = frame.create_texture("blurred", TextureDesc::d2(64, 64, Format::Rgba16Float));
            let mut pass = frame.render_pass("blur");
            pass.sample(&scene);
            pass.color(&mut blurred, Contents::Cover);
            scene = blurred;
        });
    }
    let mut tonemap = frame.render_pass("tonemap");
    tonemap.sample(&scene);
    tonemap.color(&mut picture, Contents::Cover);
    frame.export_texture(&picture);
    frame.compile().unwrap().into_plan()
}

#[test]
fn what_came_went_and_changed_is_told_by_name() {
    let diff = plan(false).diff(&plan(true)).unwrap();
    let names = |subject| diff.about(subject).map(|d| &*d.name).collect::<Vec<_>>();
    assert_eq!(names(Subject::Node), ["post"]);
    assert_eq!(names(Subject::Pass), ["post/blur"]);
    assert_eq!(names(Subject::Resource), ["blurred"]);
    let store = diff.about(Subject::Decision).find(|d| d.name == "draw · scene · store").unwrap();
    assert_eq!(store.before.as_deref(), Some("store: `tonemap` needs it"));
    assert_eq!(store.after.as_deref(), Some("store: `post/blur` needs it"));
    let text = diff.to_text();
    assert!(text.contains("nodes\n  + post\npasses\n  + post/blur: render\n"), "{text}");
    assert!(text.contains("  ~ draw · scene · store\n      - store: `tonemap`"), "{text}");
}

#[test]
fn the_way_back_tells_the_same_the_other_way_round() {
    let (there, back) = (plan(false).diff(&plan(true)).unwrap(), plan(true).diff(&plan(false)).unwrap());
    let turned = |diff: Diff| {
        let turn = |d: Difference| Difference { before: d.after, after: d.before, ..d };
        diff.differences.into_iter().map(turn).collect::<Vec<_>>()
    };
    assert_eq!(turned(there), back.differences);
}

#[test]
fn a_frame_does_not_differ_from_itself() {
    let diff = plan(true).diff(&plan(true)).unwrap();
    assert!(diff.is_empty() && diff.to_text().contains("do not differ"));
}

#[test]
fn of_things_of_one_name_only_those_that_are_not_in_both_frames_differ() {
    let two = |second: u32| {
        let mut frame = Frame::new();
        for width in [64, second] {
            let mut texture = frame.create_texture("half", TextureDesc::d2(width, 64, Format::Rgba8Unorm));
            frame.render_pass("draw").color(&mut texture, Contents::clear_color([0.0; 4]));
            frame.export_texture(&texture);
        }
        frame.compile().unwrap().into_plan()
    };
    let diff = two(64).diff(&two(32)).unwrap();
    let [half] = diff.about(Subject::Resource).collect::<Vec<_>>()[..] else { panic!("{diff:?}") };
    assert!(half.before.as_ref().is_some_and(|shape| shape.starts_with("64x64")), "{half:?}");
    assert!(half.after.as_ref().is_some_and(|shape| shape.starts_with("32x64")), "{half:?}");
}

#[test]
fn a_page_shows_names_as_they_are() {
    let named = |name: &str| {
        let mut frame = Frame::new();
        frame.compute_pass(name).keep();
        frame.compile().unwrap().into_plan()
    };
    let page = named("<b>&").diff(&named("c")).unwrap().to_html("a < b", "c");
    assert!(page.contains("&lt;b&gt;&amp;") && page.contains("a &lt; b") && !page.contains("<b>&"), "{page}");
}

#[test]
fn what_is_no_dump_is_refused_with_the_way_out() {
    let good = plan(false).to_json().unwrap();
    for (bad, why) in [
        ("", "it is not JSON"),
        ("{}", "no `schema`"),
        (r#"{"schema": 1}"#, "schema 1, and 2 is read: write it anew"),
        (r#"{"schema": 2, "plan": {}}"#, "a part of it is missing"),
    ] {
        let error = Diff::of_json(&good, bad).unwrap_err().to_string();
        assert!(
            error.contains("the second: ") && error.contains(why) && error.lines().count() == 1,
            "{error}"
        );
        assert!(Diff::of_json(bad, &good).unwrap_err().to_string().contains("the first: "));
    }
}
