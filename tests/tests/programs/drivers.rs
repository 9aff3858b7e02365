//! The same frame drawn by two drivers.

use image::{Rgb, RgbImage};
use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;
use shadowgraph_tests::{images, program, skip};
use std::path::{Path, PathBuf};
use std::process::Command;

/// SwiftShader, which Debian's Chromium brings along.
pub(crate) const SWIFTSHADER: &str = "/usr/lib/chromium/libvk_swiftshader.so";

/// Channels of pixels that differ by more are marked.
const DIFFERENCE: u8 = 8;

/// Writes the manifest of a driver for the Vulkan loader.
pub(crate) fn manifest(folder: &Path) -> PathBuf {
    let file = folder.join("driver.json");
    let text = format!(
        r#"{{"file_format_version": "1.0.0", "ICD": {{"library_path": "{SWIFTSHADER}", "api_version": "1.3.0"}}}}"#
    );
    std::fs::write(&file, text).unwrap();
    file
}

/// Runs the program with a software driver, and returns what it prints.
fn run(arguments: &[&str], driver: Option<&Path>) -> String {
    let mut command = Command::new(program().unwrap());
    command.args(arguments);
    if let Some(driver) = driver {
        command.env("VK_DRIVER_FILES", driver);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_first_pass_that_two_drivers_draw_differently_is_named() {
    match Gpu::open(&AdapterChoice::Cpu) {
        Ok(gpu) if gpu.adapter.name.contains("llvmpipe") => {}
        Ok(gpu) => return skip("drivers", &format!("the first driver is {}", gpu.adapter.name)),
        Err(reason) => return skip("drivers", &reason.to_string()),
    }
    if !Path::new(SWIFTSHADER).exists() {
        return skip("drivers", "SwiftShader is not installed");
    }
    let folder = tempfile::tempdir().unwrap();
    let swiftshader = manifest(folder.path());
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let draw = ["--size", "320x180", "--adapter", "cpu"];
    for (driver, name) in [(None, "a"), (Some(swiftshader.as_path()), "b")] {
        run(&[&["dump", "--hashes", "-o", &file(&format!("{name}.json"))], &draw[..]].concat(), driver);
        run(&[&["render", "-o", &file(&format!("{name}.png"))], &draw[..]].concat(), driver);
    }
    // Rounded depth in shadow maps does not count, nor do single texels of their edges.
    let (a, b) = (file("a.json"), file("b.json"));
    let found = run(&["dump", "--diff", &a, &b, "--tolerance", "1e-4", "--outliers", "1e-3"], None);
    println!("{found}");
    assert!(
        found.starts_with("contents: `geometry/depth prepass` writes `geometry/depth` v1 differently"),
        "{found}"
    );
    keep_differences(&file("a.png"), &file("b.png"));
}

/// Saves the first of two images, and at its side the pixels that differ, for the documents.
fn keep_differences(first: &str, second: &str) {
    let [a, b] = [first, second].map(|file| image::open(file).unwrap().to_rgb8());
    let (width, height) = a.dimensions();
    let mut both = RgbImage::new(2 * width, height);
    let mut marked = 0;
    for (x, y, &pixel) in a.enumerate_pixels() {
        let other = b.get_pixel(x, y);
        let differs =
            pixel.0.iter().zip(other.0).any(|(&channel, other)| channel.abs_diff(other) > DIFFERENCE);
        marked += u32::from(differs);
        let gray = pixel.0.iter().map(|&channel| u16::from(channel)).sum::<u16>() / 6;
        both.put_pixel(x, y, pixel);
        both.put_pixel(width + x, y, if differs { Rgb([255, 0, 255]) } else { Rgb([gray as u8; 3]) });
    }
    assert!((1..width * height / 50).contains(&marked), "{marked} pixels differ");
    if let Some(folder) = images() {
        both.save(folder.join("drivers.png")).unwrap();
    }
}
