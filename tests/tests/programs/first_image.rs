//! The command `bench --first-image`: the time from a loaded scene to its first image.

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;
use std::process::Command;

#[test]
fn the_steps_to_the_first_image_add_up_and_the_second_takes_less() {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        return shadowgraph_tests::skip("first_image", &reason.to_string());
    }
    let program = shadowgraph_tests::program().unwrap();
    let output = Command::new(program)
        .args(["bench", "--first-image", "--adapter", "auto", "--size", "64x36", "--scene", "cornell"])
        .output()
        .unwrap();
    let (out, err) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{err}");
    let seconds = |step: &str| -> f64 {
        let line = out.lines().find(|line| line.trim_start().starts_with(step));
        let line = line.unwrap_or_else(|| panic!("{step}: {out}"));
        line.split_whitespace().last().unwrap().parse().unwrap()
    };
    let steps = seconds("open the GPU") + seconds("upload the scene") + seconds("compile shaders and draw");
    assert!((steps - seconds("first image")).abs() < 0.03, "{out}");
    assert!(seconds("second image") < seconds("compile shaders and draw"), "{out}");
}
