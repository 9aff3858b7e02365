#![allow(clippy::unwrap_used, reason = "tests")]
use super::*;

#[test]
fn a_field_is_found_by_its_path_through_structs_variants_and_maps() {
    let text = "(\n  first: 1,\n  cascades: ( count: 9, split: Practical(lambda: 2.0)),\n  techniques: {\"evsm\": (blur_px: 99)},\n)";
    let at = |path: &str| field_error("a.ron", text, path, "").location;
    assert_eq!(at("first"), "a.ron:2:10");
    assert_eq!(at("cascades.count"), "a.ron:3:22");
    assert_eq!(at("cascades.split.lambda"), "a.ron:3:50");
    assert_eq!(at("techniques.evsm.blur_px"), "a.ron:4:34");
    assert_eq!(at("cascades.depth_bias"), "a.ron:3:13", "the struct without the field");
    assert_eq!(at("filter"), "a.ron");
    assert_eq!(field_error("a.ron", "[(x: 1), (x: 2)]", "1.x", "odd").to_string(), "a.ron:1:14: odd");
}

#[test]
fn characters_are_counted_and_not_bytes() {
    let error = parse_file::<(String, f32)>("a.ron", "(\"äöü\", x)").unwrap_err();
    assert_eq!(error.location, "a.ron:1:9");
    assert_eq!(location("a.ron", "äö\nüx", 7), "a.ron:2:2");
}
