//! The command `bench --fly`: the cost of a frame with a camera that moves, and of many instances.

use shadowgraph_tests::copies::copies;
use std::process::Command;

#[test]
fn a_file_of_many_copies_is_loaded_and_culled_on_the_gpu() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("copies.glb");
    std::fs::write(&file, copies(5000).glb()).unwrap();
    let program = shadowgraph_tests::program().unwrap();
    let output = Command::new(program)
        .args(["bench", "--fly", "--frames", "3", "--size", "64x36"])
        .arg(&file)
        .output()
        .unwrap();
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{err}");
    let lines = [
        r"5000 instances culled by the GPU, 3 frames: median [\d.]+ ms, .*",
        r"read in [\d.]+ s, uploaded in [\d.]+ s.*",
        r"instances on the GPU: [\d.]+ MiB, (\d+) bytes each; lists of the culled views: ([\d.]+) MiB",
    ];
    let pattern = regex::Regex::new(&lines.join("\n"));
    let found = pattern.unwrap().captures(&out).unwrap_or_else(|| panic!("{out}\n{err}"));
    let number = |index: usize| found[index].parse::<f64>().unwrap();
    assert!(number(1) <= 128.0 && number(2) > 0.0, "{out}");
}
