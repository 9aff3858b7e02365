//! `render --frames`: every frame is the image at its time.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::json;
use shadowgraph_tests::animated::{File, RIGID, add_floor_and_camera};
use shadowgraph_tests::program;

use crate::stage::gpu;

/// Runs `render` on a file with these options, and returns the exit code and what it wrote to standard error.
fn render(file: &Path, options: &str, output: &Path) -> (Option<i32>, String) {
    let mut command = Command::new(program().unwrap());
    command.arg("render").arg(file).args(["--size", "64x36", "--shadow-distance", "20"]);
    let output = command.args(options.split_whitespace()).arg("-o").arg(output).output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Renders frames, and returns the bytes of each file.
fn frames(file: &Path, options: &str, count: usize) -> Vec<Vec<u8>> {
    let directory = tempfile::tempdir().unwrap();
    let (code, errors) = render(file, options, &directory.path().join("%d.png"));
    assert_eq!(code, Some(0), "{options}: {errors}");
    (0..count).map(|number| std::fs::read(directory.path().join(format!("{number}.png"))).unwrap()).collect()
}

/// Writes the file of the rigid kind, with a camera that stands or that moves with the column.
fn written(directory: &Path, camera_moves: bool) -> PathBuf {
    let mut file: File = (RIGID.file)();
    // The floor: what shadows are fitted to does not change as the column moves.
    add_floor_and_camera(&mut file);
    if camera_moves {
        file.json["nodes"][0]["children"] = json!([1, 3]);
        file.json["scenes"][0]["nodes"] = json!([0, 2]);
    }
    file.write(directory)
}

#[test]
fn each_frame_of_a_sequence_is_the_image_of_its_time() {
    let Some(_gpu) = gpu() else { return };
    let directory = tempfile::tempdir().unwrap();
    for (camera_moves, times_s) in [(false, [0.25, 0.5, 0.75]), (true, [0.2, 0.45, 0.7])] {
        let file = written(directory.path(), camera_moves);
        let options = format!("--technique none --time {} --fps 4 --frames 3", times_s[0]);
        let sequence = frames(&file, &options, 3);
        assert_eq!(sequence, frames(&file, &options, 3), "the same every time");
        assert!(sequence[0] != sequence[1] && sequence[1] != sequence[2], "they play");
        for (frame, time_s) in sequence.iter().zip(times_s) {
            let [alone] = &*frames(&file, &format!("--technique none --time {time_s}"), 1) else { panic!() };
            assert!(frame == alone, "at {time_s} s, the camera moves: {camera_moves}");
        }
    }
    // With shadows, of which some are kept from frame to frame.
    let file = written(directory.path(), false);
    let sequence = frames(&file, "--time -1 --fps 2 --frames 5", 5);
    let [last] = &*frames(&file, "--time 1", 1) else { panic!() };
    assert!(sequence[0] == sequence[2] && sequence[2] != sequence[3], "they begin at 0 s");
    assert!(&sequence[4] == last, "a frame of a sequence has the shadows of its time");
    // After the end, however long ago.
    for options in ["--time 1.5 --fps 0.01 --frames 2", "--time 1e9 --fps 10000 --frames 2"] {
        assert!(frames(&file, options, 2).iter().all(|frame| frame == last), "{options}");
    }
    let alone = frames(&file, "--animation none --time 0.5 --frames 2", 2);
    assert!(alone[0] == alone[1], "nothing plays");
}

#[test]
fn row_46_tracks_play_with_the_frames_of_a_sequence() {
    let Some(_gpu) = gpu() else { return };
    let directory = tempfile::tempdir().unwrap();
    let file = written(directory.path(), false);
    let tracks = directory.path().join("tracks.ron");
    std::fs::write(&tracks, r#"(tracks: [(setting: "distance_m", keys: [(0.0, 2.0), (1.0, 20.0)])])"#)
        .unwrap();
    let with = |options: &str, count| {
        frames(&file, &format!("--animation none --tracks {} {options}", tracks.display()), count)
    };
    let sequence = with("--fps 2 --frames 3", 3);
    assert!(sequence[0] != sequence[2], "shadows reach farther");
    for (frame, time_s) in sequence.iter().zip([0.0, 0.5, 1.0]) {
        assert!(*frame == with(&format!("--time {time_s}"), 1)[0], "at {time_s} s");
    }
    assert!(
        sequence[2] == frames(&file, "--animation none", 1)[0],
        "the last key frame is that of the option"
    );
}

#[test]
fn a_sequence_without_frames_or_with_a_wrong_time_is_refused_in_one_line() {
    let directory = tempfile::tempdir().unwrap();
    let file = written(directory.path(), false);
    let fps = "expected frames per second, 0.01 to 10000";
    let time = "expected -1000000000 to 1000000000 seconds";
    for (options, expected) in [
        ("--frames 2 --fps 0", fps),
        ("--frames 2 --fps -24", fps),
        ("--frames 2 --fps NaN", fps),
        ("--frames 2 --fps inf", fps),
        ("--frames 0 --fps 24", "0 is not in 1..=100000"),
        ("--frames 2 --time 1e10", time),
        ("--frames 2 --time soon", time),
        ("--frames 2 --animation walk", "unknown animation `walk`; expected all, none, or one of: 0"),
    ] {
        let (found, errors) = render(&file, options, &directory.path().join("%d.png"));
        assert_eq!((found, errors.lines().count()), (Some(1), 1), "{options}: {errors}");
        assert!(errors.contains(expected), "{options}: {errors}");
    }
    assert!(!directory.path().join("0.png").exists(), "nothing is written");
}
