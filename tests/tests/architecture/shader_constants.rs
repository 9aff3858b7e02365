//! Checks that constants which Rust and WGSL share are equal. They are found by their documentation, such as `` `GROUP` of `cull.wgsl` ``.

use crate::sources;
use regex::Regex;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;

/// The least number of constants that are expected to be found.
const LEAST: usize = 20;

static NUMBER: LazyLock<Regex> = LazyLock::new(|| {
    Regex::new(r"\b(?:0x([0-9a-f]+)|([0-9][0-9_]*(?:\.[0-9]+)?))(?:u|f|u32|f32)?\b").unwrap()
});

/// Returns the numbers in an expression of Rust or WGSL.
fn numbers(expression: &str) -> Vec<f64> {
    let expression = expression.replace("u32::MAX - 1", "0xfffffffe").replace("u32::MAX", "0xffffffff");
    let value = |found: regex::Captures<'_>| match (found.get(1), found.get(2)) {
        (Some(hexadecimal), _) => u32::from_str_radix(hexadecimal.as_str(), 16).unwrap().into(),
        (_, decimal) => decimal.unwrap().as_str().replace('_', "").parse().unwrap(),
    };
    NUMBER.captures_iter(&expression).map(value).collect()
}

/// Returns the values of the constants of each file of WGSL, by its name and theirs.
fn constants_of_shaders() -> BTreeMap<(String, String), Vec<f64>> {
    let constant = Regex::new(r"(?m)^const ([A-Z][A-Z0-9_]*)(?:: \w+)? = (.+);").unwrap();
    let of_file = |path: &Path| {
        let file = path.file_name().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(path).unwrap();
        let pairs = constant.captures_iter(&text).map(|found| (found[1].to_owned(), numbers(&found[2])));
        pairs.map(|(name, value)| ((file.clone(), name), value)).collect::<Vec<_>>()
    };
    let files = ["shaders/wgsl", "crates"].map(|dir| sources(dir, &["wgsl"])).concat();
    files.iter().flat_map(|path| of_file(path)).collect()
}

#[test]
fn constants_that_rust_and_wgsl_share_are_equal() {
    let shaders = constants_of_shaders();
    let mention =
        Regex::new(r"^\s*///.*?((?:`[A-Z][A-Z0-9_]*` and )?`[A-Z][A-Z0-9_]*`) of `([a-z_/]+\.wgsl)`")
            .unwrap();
    let constant = Regex::new(r"^\s*(?:pub(?:\([a-z]+\))? )?const \w+: .+? = (.+);").unwrap();
    let mut compared = 0;
    for path in sources("crates", &["rs"]) {
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (number, line) in lines.iter().enumerate() {
            let Some(found) = mention.captures(line) else { continue };
            let file = found[2].rsplit('/').next().unwrap();
            let mut following =
                lines[number + 1..].iter().filter(|line| !line.trim_start().starts_with("///"));
            for name in found[1].split(" and ").map(|name| name.trim_matches('`')) {
                let place = format!("{}:{}: `{name}` of `{file}`", path.display(), number + 1);
                let declared = following.next().and_then(|line| constant.captures(line));
                let declared = declared.unwrap_or_else(|| panic!("{place}: no constant follows"));
                let key = (file.to_owned(), name.to_owned());
                let shader = shaders.get(&key).unwrap_or_else(|| panic!("{place}: there is none"));
                assert!(
                    !shader.is_empty() && numbers(&declared[1]) == *shader,
                    "{place}: {} is not {shader:?}",
                    &declared[1]
                );
                compared += 1;
            }
        }
    }
    assert!(compared >= LEAST, "only {compared} constants were found");
}

#[test]
fn numbers_are_read_in_the_forms_of_both_languages() {
    assert_eq!(numbers("vec3u(16u, 9u, 24u)"), [16.0, 9.0, 24.0]);
    assert_eq!(numbers("[16, 9, 24]"), [16.0, 9.0, 24.0]);
    assert_eq!(numbers("u32::MAX - 1"), numbers("0xfffffffeu"));
    assert_eq!(numbers("1_024"), numbers("1024.0"));
    assert!(numbers("vec3u(zero)").is_empty());
}
