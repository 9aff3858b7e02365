#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use super::*;
use shadowgraph_core::{Contents, Format, Frame, TextureDesc};

fn plan(blur: bool) -> Plan {
    let mut frame = Frame::new();
    let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    let mut image = frame.create_texture("image", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    if blur {
        frame.node("post", |frame| {
            let mut blurred = frame.create_texture("blurred", TextureDesc::d2(64, 64, Format::Rgba16Float));
            let mut pass = frame.render_pass("blur");
            pass.sample(&scene);
            pass.color(&mut blurred, Contents::Overwrite);
            scene = blurred;
        });
    }
    let mut tonemap = frame.render_pass("tonemap");
    tonemap.sample(&scene);
    tonemap.color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);
    frame.compile().unwrap().into_plan()
}

#[test]
fn added_removed_and_changed_things_are_listed_by_name() {
    let diff = diff(&plan(false), &plan(true)).unwrap();
    let names = |subject| diff.about(subject).map(|d| &*d.name).collect::<Vec<_>>();
    assert_eq!(names(Subject::Node), ["post"]);
    assert_eq!(names(Subject::Pass), ["post/blur"]);
    assert_eq!(names(Subject::Resource), ["post/blurred"]);
    assert!(names(Subject::Summary).contains(&"steps") && names(Subject::Summary).contains(&"slot memory"));
    let store = diff.about(Subject::Decision).find(|d| d.name == "draw · scene · store").unwrap();
    assert_eq!(store.before.as_deref(), Some("store: `tonemap` needs it"));
    assert_eq!(store.after.as_deref(), Some("store: `post/blur` needs it"));
    let text = diff.to_text();
    assert!(text.contains("nodes\n  + post\npasses\n  + post/blur: render\n"), "{text}");
    assert!(text.contains("  ~ draw · scene · store\n      - store: `tonemap`"), "{text}");
}

#[test]
fn the_reverse_diff_swaps_before_and_after() {
    let (there, back) = (diff(&plan(false), &plan(true)).unwrap(), diff(&plan(true), &plan(false)).unwrap());
    let turned = |diff: Diff| {
        let turn = |d: Difference| Difference { before: d.after, after: d.before, ..d };
        diff.differences.into_iter().map(turn).collect::<Vec<_>>()
    };
    assert_eq!(turned(there), back.differences);
}

#[test]
fn a_frame_does_not_differ_from_itself() {
    let diff = diff(&plan(true), &plan(true)).unwrap();
    assert!(diff.is_empty() && diff.to_text().contains("do not differ"));
}

#[test]
fn things_of_the_same_name_differ_only_if_they_are_not_in_both_frames() {
    let two = |second: u32| {
        let mut frame = Frame::new();
        for width in [64, second] {
            let mut texture = frame.create_texture("half", TextureDesc::d2(width, 64, Format::Rgba8Unorm));
            frame.render_pass("draw").color(&mut texture, Contents::clear_color([0.0; 4]));
            frame.export_texture(&texture);
        }
        frame.compile().unwrap().into_plan()
    };
    let diff = diff(&two(64), &two(32)).unwrap();
    let [half] = diff.about(Subject::Resource).collect::<Vec<_>>()[..] else { panic!("{diff:?}") };
    assert!(half.before.as_ref().is_some_and(|shape| shape.starts_with("64x64")), "{half:?}");
    assert!(half.after.as_ref().is_some_and(|shape| shape.starts_with("32x64")), "{half:?}");
}

#[test]
fn names_are_escaped_in_the_page() {
    let named = |name: &str| {
        let mut frame = Frame::new();
        frame.compute_pass(name).keep();
        frame.compile().unwrap().into_plan()
    };
    let page = diff(&named("<b>&"), &named("c")).unwrap().to_html("a < b", "c");
    assert!(page.contains("&lt;b&gt;&amp;") && page.contains("a &lt; b") && !page.contains("<b>&"), "{page}");
}

#[test]
fn accesses_of_a_pass_are_compared() {
    let diff = diff(&plan(false), &plan(true)).unwrap();
    let access = |name: &str| diff.about(Subject::Access).find(|d| d.name == name).unwrap();
    assert_eq!(access("tonemap · scene").before.as_deref(), Some("sampled, version 1"));
    assert_eq!(access("tonemap · post/blurred").after.as_deref(), Some("sampled, version 1"));
    assert_eq!(
        access("post/blur · post/blurred").after.as_deref(),
        Some("color 0, overwrites, makes version 1")
    );
}

#[test]
fn differences_only_in_numbers_are_counted_and_not_listed() {
    let diff = diff(&plan(false), &plan(true)).unwrap();
    let moved = diff.differences.iter().find(|d| d.name == "tonemap · placed").unwrap();
    assert!(moved.only_numbers && moved.before != moved.after, "{moved:?}");
    let text = diff.to_text();
    assert!(!text.contains("tonemap · placed") && text.contains("only in the number"), "{text}");
    assert!(diff.to_html("a", "b").contains("<details><summary>"), "{text}");
    assert_eq!(without_numbers("step 12: in slot 3, 4 bytes"), "step : in slot , 4 bytes");
    assert_ne!(without_numbers("2 passes"), without_numbers("3 passes"));
}

#[test]
fn a_text_that_is_not_a_dump_is_an_error_with_a_hint() {
    for (bad, why) in [
        ("", "not JSON"),
        ("{}", "missing field `schema`"),
        (r#"{"schema": 1}"#, "schema version 1, expected 3; write the dump again"),
        (r#"{"schema": 3, "plan": {}}"#, "a field is missing"),
    ] {
        let error = Dump::from_json(bad).unwrap_err().to_string();
        assert!(error.contains(why) && error.lines().count() == 1, "{error}");
    }
}
