//! Every kind of RON file that the program reads, damaged in random ways.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "tests")]

use std::path::Path;

use shadowgraph::nodes::Nodes;
use shadowgraph::options::SettingsFile;
use shadowgraph::pipelines::{BUILT_IN, Parameters, Pipeline};
use shadowgraph::shadows::Techniques;
use shadowgraph_quality::report::Bounds;
use shadowgraph_quality::{CaseSet, VariantSet};

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
    let techniques = Techniques::built_in();
    let settings = include_str!("../../../docs/shadows.md").split("```ron\n").skip(1);
    let mut files: Vec<(&str, &str)> =
        settings.map(|rest| ("settings", rest.split("```").next().unwrap())).collect();
    files.extend(BUILT_IN.iter().map(|name| ("pipeline", Pipeline::built_in_text(name).unwrap())));
    files.push(("variants", include_str!("../../../docs/variants.ron")));
    files.push(("cases", include_str!("../src/cases.ron")));
    files.push(("bounds", include_str!("../../../tests/bounds/quick.ron")));

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
                    let result = SettingsFile::load(&path, &techniques);
                    result.err().map(|error| error.to_string().replacen("settings: ", "", 1))
                }
                "pipeline" => {
                    std::fs::write(&path, &text).unwrap();
                    let nodes = Nodes::built_in();
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
        // Others change a comment, or a value within its range.
        assert!(refused * 10 > many * 4, "{kind}: {refused} of {many}");
        println!("{kind}: {refused} of {many} are refused");
    }
}
