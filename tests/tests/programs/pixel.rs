//! `pixel`: the history of a pixel, and its shadows.

use std::process::{Command, Output};

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;

/// Runs `pixel` for the scene `cornell` with some arguments; `None` without a GPU.
fn pixel(place: &str, arguments: &[&str]) -> Option<(Output, String, String)> {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        shadowgraph_tests::skip("pixel", &reason.to_string());
        return None;
    }
    let mut command = Command::new(shadowgraph_tests::program().unwrap());
    let scene = ["--scene", "cornell", "--size", "96x54", "--pipeline", "minimal_lit"];
    let output = command.arg("pixel").arg(place).args(scene).args(arguments).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    Some((output, out, err))
}

#[test]
fn the_passes_and_the_shadows_of_a_pixel_are_printed() {
    let Some((output, out, err)) = pixel("48,40", &[]) else { return };
    assert!(output.status.success(), "{err}");
    assert!(
        out.starts_with(
            "pixel 48,40 of `tonemap/image`, 96 x 54\n\ntonemap/tonemap\n  wrote tonemap/image v1: "
        ),
        "{out}"
    );
    assert!(out.contains("\nlighting/forward\n  wrote lighting/lit v1: "), "{out}");
    assert!(out.contains("\nshadows of `pcf`\n  surface"), "{out}");
    assert!(out.contains("\n  light 0"), "{out}");
}

#[test]
fn the_json_file_has_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("new/pixel.json");
    let Some((output, _, err)) = pixel("48,40", &["-o", file.to_str().unwrap()]) else { return };
    assert!(output.status.success(), "{err}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap();
    assert_eq!(json["history"]["pixel"], serde_json::json!([48, 40]));
    assert_eq!(json["history"]["passes"][0]["pass"], "tonemap/tonemap");
    assert_eq!(json["history"]["passes"][0]["writes"][0]["after"][0]["at"], serde_json::json!([48, 40]));
    assert!(json["shadows"]["surface"]["view_depth_m"].as_f64().unwrap() > 0.0);
    assert_eq!(json["shadows"]["lights"][0]["light"], 0);
}

#[test]
fn a_place_outside_of_the_image_or_of_no_pixel_is_an_error_of_one_line() {
    let Some((output, out, err)) = pixel("96,0", &[]) else { return };
    assert_eq!((output.status.code(), out.as_str()), (Some(1), ""));
    assert!(err.ends_with("error: pixel 96,0 is outside of the image; expected 0,0 to 95,53\n"), "{err}");
    let Some((output, _, err)) = pixel("4,4", &["-o", "pixel.png"]) else { return };
    assert_eq!(output.status.code(), Some(1));
    assert!(
        err.ends_with("error: --output: unknown extension `.png`; expected one of: txt, json\n"),
        "{err}"
    );
    for place in ["48", "a,b", "-1,3", "1,2,3"] {
        let Some((output, _, err)) = pixel(place, &[]) else { return };
        assert_eq!(output.status.code(), Some(1));
        assert!(err.contains("expected X,Y, column and row from the top left"), "{err}");
        assert_eq!(err.lines().count(), 1, "{err}");
    }
}
