//! `render --record` and `render --replay`.

use std::path::Path;
use std::process::{Command, Output};

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;
use shadowgraph_tests::repository;

/// Runs `render` in a directory.
fn render(dir: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(shadowgraph_tests::program().unwrap());
    command.arg("render").args(arguments).current_dir(dir).output().unwrap()
}

fn error(output: &Output) -> String {
    assert!(!output.status.success());
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.starts_with("error: ") && error.lines().count() == 1, "{error}");
    error
}

/// Records moving frames of the demo scene; returns false without a GPU.
fn record(dir: &Path) -> bool {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        shadowgraph_tests::skip("recordings", &reason.to_string());
        return false;
    }
    let frames = std::env::var("SHADOWGRAPH_SOAK").unwrap_or("6".into());
    let arguments = ["--size", "96x54", "--frames", &frames, "--fps", "20", "--technique", "virtual"];
    let files = ["--record", "demo.frames", "-o", "recorded-%03d.png"];
    let output = render(dir, &[&arguments[..], &files].concat());
    assert!(output.status.success(), "{}", error(&output));
    true
}

#[test]
fn moving_frames_are_drawn_again_by_another_process_to_the_bit() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    if !record(dir) {
        return;
    }
    let replay = |arguments: &[&str]| {
        let output = render(dir, &[&["--replay", "demo.frames"], arguments].concat());
        assert!(output.status.success(), "{}", error(&output));
    };
    replay(&["-o", "again-%03d.png"]);
    replay(&["--frame", "3", "-o", "one.png"]);
    let read = |name: &str| std::fs::read(dir.join(name)).unwrap();
    let names =
        std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let recorded: Vec<_> = names.filter(|name| name.starts_with("recorded")).collect();
    assert!(recorded.len() >= 6);
    for name in &recorded {
        assert!(read(name) == read(&name.replace("recorded", "again")), "{name}");
    }
    assert!(read("one.png") == read("recorded-003.png"));
    assert!(read("recorded-000.png") != read("recorded-005.png"), "nothing moves");
    println!("soak: {} frames in {} KiB", recorded.len(), read("demo.frames").len() >> 10);
}

#[test]
fn what_cannot_be_drawn_again_is_an_error_of_one_line() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    if !record(dir) {
        return;
    }
    let text = std::fs::read_to_string(dir.join("demo.frames")).unwrap();
    let with = |arguments: &[&str], text: &str| {
        std::fs::write(dir.join("other.frames"), text).unwrap();
        error(&render(dir, &[&["--replay", "other.frames", "-o", "no.png"], arguments].concat()))
    };
    let last_line = format!("other.frames:{}: ", text.lines().count());
    let first_lines = |count: usize| text.lines().take(count).collect::<Vec<_>>().join("\n") + "\n";
    for (text, expected) in [
        (String::new(), "other.frames:1: not a recording of Shadowgraph"),
        ("()".to_owned(), "other.frames:1: not a recording of Shadowgraph"),
        (text.replace("version:1", "version:7"), "other.frames:1: version 7 of recordings; expected 1"),
        (first_lines(1), "other.frames:2: the recording has no frame"),
        (text[..text.len() - 9].to_owned(), last_line.as_str()),
        (text.replacen("technique:\"virtual", "technique:\"virtua", 1), "did you mean `virtual`?"),
        (
            text.replacen("size_px:Some((96", "size_px:Some((0", 1),
            "other.frames:2: view 0: size_px out of range",
        ),
        (
            text.replacen("\"procedural\":()", "\"procedural\":\"cornell\"", 1),
            "is not the one of the recording",
        ),
        (text.replacen("\"file\":()", "\"file\":\"/no/such.glb\"", 1), "/no/such.glb"),
        (
            text.replacen("\"file\":()", &format!("\"file\":{:?}", repository().join("Cargo.toml")), 1),
            "Cargo.toml has changed since it was recorded",
        ),
    ] {
        let error = with(&[], &text);
        assert!(error.starts_with("error: --replay: ") && error.contains(expected), "{error}");
    }
    let error = with(&["--frame", "100000"], &text);
    assert!(error.contains("the recording has no frame 100000; expected 0 to "), "{error}");
    assert!(with(&["--technique", "pcf"], &text).contains("--technique"));
    assert!(!dir.join("no.png").exists());
}
