//! `render --check-values`: values that no texture should have.

use std::path::Path;
use std::process::{Command, Output};

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;

/// Renders the scene `cornell` with a folder of shaders; `None` without a GPU.
fn render(option: &str, shaders: Option<&Path>) -> Option<(Output, String, String)> {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        shadowgraph_tests::skip("check_values", &reason.to_string());
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("image.png");
    let mut command = Command::new(shadowgraph_tests::program().unwrap());
    command.args(["render", "--scene", "cornell", "--size", "96x54", option, "-o"]).arg(&image);
    if let Some(shaders) = shaders {
        command.arg("--shaders").arg(shaders);
    }
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    Some((output, out, err))
}

#[test]
fn a_sound_frame_has_only_finite_values() {
    let Some((output, out, err)) = render("--check-values", None) else { return };
    assert!(output.status.success(), "{err}");
    assert!(out.ends_with("all values are finite and within their ranges\n"), "{out}");
}

#[test]
fn the_pass_and_the_pixel_of_a_nan_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let shader = shadowgraph_tests::repository().join("shaders/wgsl/forward.wgsl");
    let good = std::fs::read_to_string(shader).unwrap();
    let end = "return vec4f(radiance * alpha, alpha);";
    let planted = format!(
        "if u32(in.position.x) == 41u && u32(in.position.y) == 30u {{
            return vec4f(bitcast<f32>(0x7fc00000u + u32(in.position.x * 0.0)), 0.0, 0.0, 1.0);
        }}
        {end}"
    );
    std::fs::write(folder.path().join("forward.wgsl"), good.replace(end, &planted)).unwrap();
    let Some((output, out, err)) = render("--check-values", Some(folder.path())) else { return };
    assert_eq!(output.status.code(), Some(1), "{out}");
    assert!(out.contains("`lighting/forward` wrote `lit` v1: 1 texel NaN\n"), "{out}");
    assert!(out.contains("\n  there: `lit` v1 at 41,30: NaN 0 0 1\n"), "{out}");
    assert!(out.contains("\n  read:  `depth` v1 at 41,30: 0."), "{out}");
    assert!(err.ends_with("error: the frame has values that it should not have\n"), "{err}");
}

#[test]
fn values_outside_of_a_range_are_reported_and_other_names_refused() {
    let Some((output, out, _)) = render("--check-values=lit=0..0", None) else { return };
    assert_eq!(output.status.code(), Some(1));
    assert!(
        out.contains("`lighting/forward` wrote `lit` v1: ") && out.contains(" outside of 0 to 0\n"),
        "{out}"
    );
    let Some((output, _, err)) = render("--check-values=lid=0..1", None) else { return };
    assert_eq!(output.status.code(), Some(1));
    assert!(
        err.contains("error: --check-values: no texture has the name `lid`; did you mean `lit`?"),
        "{err}"
    );
}

#[test]
fn a_version_of_a_texture_is_written_as_an_image() {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        return shadowgraph_tests::skip("check_values", &reason.to_string());
    }
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("depth.png");
    let stop_at = |version: &str| {
        let mut command = Command::new(shadowgraph_tests::program().unwrap());
        command.args(["render", "--scene", "cornell", "--size", "96x54", "--stop-at", version, "-o"]);
        let output = command.arg(&image).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.success(), text(&output.stdout), text(&output.stderr))
    };
    let (success, _, err) = stop_at("depth@2");
    let expected = "error: --stop-at: `depth@2`: expected a version from 1 to 1\n";
    assert!(!success && err.ends_with(expected), "{err}");
    assert!(!image.exists());
    let (success, out, err) = stop_at("depth@1");
    assert!(success && out.contains("written by geometry/depth prepass, black 0, white 0."), "{out}{err}");
    let image = image::open(&image).unwrap().to_rgb8();
    assert_eq!(image.dimensions(), (96, 54));
    let range = |end: fn(u8, u8) -> u8| image.pixels().map(|pixel| pixel.0[0]).reduce(end).unwrap();
    assert!(range(u8::min) < 20 && range(u8::max) == 255);
}
