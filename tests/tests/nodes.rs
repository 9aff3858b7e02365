//! `shadowgraph nodes`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

use std::process::Command;

#[test]
fn row_36_nodes_prints_the_numbers_of_shader_permutations() {
    let output = Command::new(shadowgraph_tests::program().unwrap()).arg("nodes").output().unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let (_, permutations) = text.split_once("permutations").unwrap();
    let pcf = permutations.lines().find(|line| line.trim_start().starts_with("pcf")).unwrap();
    let counts: Vec<u32> = pcf.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect();
    // With and without collecting.
    assert_eq!(counts, [6, 1, 6], "{text}");
    for name in ["forward", "screen_shadows", "minimal", "raytraced", "none", "+contact", "filter_taps: 24"] {
        assert!(text.contains(name), "{text}");
    }
}
