#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "tests")]
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

/// Numbers that are the same in every run (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }
}

/// Returns a text with some errors: parts removed, duplicated or moved, and odd characters inserted.
fn broken(text: &str, random: &mut Random) -> String {
    const ODD: [&str; 16] =
        ["(", ")", "[", "]", "{", "}", ",", ":", "\"", "-", "1e999", "NaN", "Some(", "//", "\u{0}", "é"];
    let mut chars: Vec<char> = text.chars().collect();
    for _ in 0..1 + random.below(4) {
        let from = random.below(chars.len());
        let to = (from + random.below(12)).min(chars.len());
        let at = random.below(chars.len() + 1);
        match random.below(3) {
            0 => drop(chars.drain(from..to)),
            1 => drop(chars.splice(at..at, ODD[random.below(ODD.len())].chars())),
            _ => {
                let part = chars[from..to].to_vec();
                drop(chars.splice(at..at, part));
            }
        }
    }
    chars.into_iter().collect()
}

/// Checks files of each kind with random errors: `SHADOWGRAPH_FUZZ` of each kind, 2000 by default. `cargo xtask soak` tries many more.
#[test]
fn damaged_files_are_refused_in_one_line_with_the_location_or_accepted() {
    use crate::measure::report::Bounds;
    use crate::measure::{CaseSet, VariantSet};
    use crate::pipelines::{BUILT_IN, Parameters, Pipeline};
    use std::path::Path;

    let techniques = shadowgraph_shadows::Techniques::built_in();
    let settings = include_str!("../../../../docs/shadows.md").split("```ron\n").skip(1);
    let mut files: Vec<(&str, &str)> =
        settings.map(|rest| ("settings", rest.split("```").next().unwrap())).collect();
    files.extend(BUILT_IN.iter().map(|name| ("pipeline", Pipeline::built_in_text(name).unwrap())));
    files.push(("variants", include_str!("../../../../docs/variants.ron")));
    files.push(("cases", include_str!("../measure/cases.ron")));
    files.push(("bounds", include_str!("../../../../tests/bounds/quick.ron")));

    let many = std::env::var("SHADOWGRAPH_FUZZ").map_or(2000, |many| many.parse().unwrap());
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ron");
    let name = path.display().to_string();
    for kind in ["settings", "pipeline", "variants", "cases", "bounds"] {
        let files: Vec<&str> = files.iter().filter(|(of, _)| *of == kind).map(|(_, text)| *text).collect();
        let mut refused = 0;
        for _ in 0..many {
            let text = broken(files[random.below(files.len())], &mut random);
            let error = match kind {
                "settings" => {
                    std::fs::write(&path, &text).unwrap();
                    let result = crate::options::SettingsFile::load(&path, &techniques);
                    result.err().map(|error| error.to_string().replacen("settings: ", "", 1))
                }
                "pipeline" => {
                    std::fs::write(&path, &text).unwrap();
                    let nodes = crate::nodes::Nodes::built_in();
                    let result = Pipeline::load(&path, &nodes, &techniques, &Parameters::default());
                    result.err().map(|error| error.to_string())
                }
                "variants" => {
                    VariantSet::parse(&text, &path, &techniques).err().map(|error| error.to_string())
                }
                "cases" => CaseSet::parse(&text, &path).err().map(|error| error.to_string()),
                _ => Bounds::parse(&text, Path::new(&path)).err().map(|error| error.to_string()),
            };
            let Some(error) = error else { continue };
            refused += 1;
            assert!(error.lines().count() == 1 && error.starts_with(&name), "{kind}: {error}\n{text}");
        }
        assert!(refused * 10 > many * 5, "{kind}: {refused} of {many}");
        println!("{kind}: {refused} of {many} are refused");
    }
}
