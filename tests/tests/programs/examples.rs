//! The examples run and render what they promise.

use serde_json::Value;
use shadowgraph_tests::animated::SKINNED;
use shadowgraph_tests::watch::{self, Limits, Outcome};
use shadowgraph_tests::{on_path, repository, skip};
use std::path::PathBuf;
use std::process::Command;
use std::sync::OnceLock;
use std::time::Duration;

/// A software driver takes seconds for a frame of the window.
const LIMITS: Limits = Limits { time: Duration::from_secs(180), memory_bytes: 4 << 30 };

/// Returns the path of a built example.
pub(super) fn example(name: &str) -> PathBuf {
    static BUILT: OnceLock<Vec<PathBuf>> = OnceLock::new();
    let built = BUILT.get_or_init(build);
    let is_named = |path: &&PathBuf| path.file_stem().is_some_and(|stem| stem == name);
    built.iter().find(is_named).unwrap_or_else(|| panic!("no example {name}: {built:?}")).clone()
}

/// Builds nothing new in a run of all tests: naming the whole workspace gives the same features.
fn build() -> Vec<PathBuf> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["build", "--quiet", "--workspace", "--examples", "--bins"]);
    command.arg("--message-format=json-render-diagnostics").current_dir(repository());
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let messages = String::from_utf8_lossy(&output.stdout);
    let executable = |line: &str| {
        let message: Value = serde_json::from_str(line).ok()?;
        message["executable"].as_str().map(PathBuf::from)
    };
    messages.lines().filter_map(executable).collect()
}

fn run(command: &mut Command) -> Outcome {
    let outcome = watch::run(command, LIMITS).unwrap();
    assert_eq!(outcome.stopped, None, "{outcome:?}");
    outcome
}

/// The examples that can render into a window.
const IN_WINDOWS: [&str; 11] = [
    "minimal_graph",
    "post_chain",
    "compute_only",
    "split_screen",
    "many_lights",
    "day_cycle",
    "edit_scene",
    "animate",
    "temporal",
    "custom_pipeline",
    "custom_engine",
];

fn pixel(image: &image::RgbaImage, x: u32, y: u32) -> [u8; 4] {
    image.get_pixel(x, y).0
}

#[test]
fn every_small_example_runs_and_writes_its_image() {
    if shadowgraph::Gpu::open(&shadowgraph::options::AdapterChoice::Cpu).is_err() {
        return skip("examples", "no graphics driver is installed");
    }
    let dir = tempfile::tempdir().unwrap();
    let read = |file: &str| image::open(dir.path().join("out").join(file)).unwrap().into_rgba8();
    let output_of = |name: &str, arguments: &[&str]| {
        let outcome = run(Command::new(example(name)).args(arguments).current_dir(dir.path()));
        assert_eq!(outcome.code, Some(0), "{name}: {}", outcome.stderr);
        outcome.stdout
    };
    output_of("minimal_graph", &[]);
    let disc = read("minimal_graph.png");
    assert!(pixel(&disc, 160, 90)[0] > 200 && pixel(&disc, 5, 5)[0] < 100);

    output_of("post_chain", &[]);
    let lights = read("post_chain.png");
    // In a light, in its bloom, between lights.
    let brightness = |x, y| pixel(&lights, x, y)[..3].iter().map(|&c| u32::from(c)).sum::<u32>();
    assert!(brightness(20, 20) > brightness(30, 20) && brightness(30, 20) > brightness(40, 40));

    let plan = output_of("compute_only", &[]);
    assert!(plan.contains("103 passes") && plan.contains(" slots"), "{plan}");
    let alive = read("compute_only.png").pixels().filter(|pixel| pixel.0[0] == 255).count();
    assert!((100..8_000).contains(&alive), "{alive} cells are alive");

    output_of("split_screen", &[]);
    assert_eq!(read("split_screen.png").dimensions(), (640, 360));

    let lights = ["minimal_lit", "forward_plus"].map(|pipeline| {
        let output = output_of("many_lights", &[pipeline, "--size", "160x90"]);
        assert!(output.starts_with(&format!("{pipeline}: ")), "{output}");
        read("many_lights.png")
    });
    assert!(lights[0] == lights[1], "both pipelines render the same image");

    output_of("day_cycle", &["--frames", "12"]);
    let day = [0, 11].map(|number| read(&format!("day_cycle/{number:02}.png")));
    assert!(pixel(&day[1], 160, 150) != pixel(&day[0], 160, 150), "noon is not morning");

    output_of("edit_scene", &["--size", "160x90"]);
    let edited = [0, 35, 71].map(|number| read(&format!("edit_scene/{number:02}.png")));
    assert!(edited[0] != edited[1] && edited[1] != edited[2], "every frame is edited");

    output_of("animate", &["--frames", "25"]);
    let played = [0, 12, 24].map(|number| read(&format!("animate/{number:02}.png")));
    assert!(played[0] != played[1] && played[1] != played[2], "the stalks sway");
    let dir_of_file = tempfile::tempdir().unwrap();
    let file = (SKINNED.file)().write(dir_of_file.path());
    output_of("animate", &[file.to_str().unwrap(), "--frames", "13"]);
    // The file's animation lasts 1 s, and starts again.
    let played = [0, 6, 12].map(|number| read(&format!("animate/{number:02}.png")));
    assert!(played[0] != played[1] && played[0] == played[2], "the column bends");

    // In the penumbra one frame is black or white, and many are grey.
    let [one, many] = [&["--frames", "1"][..], &[]].map(|arguments| {
        output_of("temporal", arguments);
        read("temporal.png").pixels().filter(|pixel| (40..215).contains(&pixel.0[0])).count()
    });
    assert!(one == 0 && many > 2_000, "{one} and {many} grey pixels");

    let why = output_of("explain", &[]);
    assert!(why.contains("does not run: nothing reads `glow`"), "{why}");
    assert!(dir.path().join("out/explain.html").is_file());
}

#[test]
fn custom_pipeline_gives_equal_plans_and_images_from_a_file_and_from_a_script() {
    if shadowgraph::Gpu::open(&shadowgraph::options::AdapterChoice::Cpu).is_err() {
        return skip("pipelines", "no graphics driver is installed");
    }
    let dir = tempfile::tempdir().unwrap();
    let [of_file, of_script] = ["file", "script"].map(|seen| {
        let mut command = Command::new(example("custom_pipeline"));
        // From the second frame on, the pipeline has a history.
        let outcome = run(command.args([seen, "--frames", "2"]).current_dir(dir.path()));
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let equal = outcome.stdout.lines().filter(|line| line.ends_with("the plans are equal: true"));
        assert_eq!(equal.count(), 2, "{}", outcome.stdout);
        image::open(dir.path().join("out/custom_pipeline.png")).unwrap().into_rgba8()
    });
    assert!(of_file == of_script, "both render the same image");
    assert_eq!(of_file.dimensions(), (640, 360));
    // The vignette darkens the sky in a corner.
    let brightness = |x, y| pixel(&of_file, x, y)[..3].iter().map(|&c| u32::from(c)).sum::<u32>();
    assert!(
        brightness(2, 2) * 4 < brightness(250, 40) * 3,
        "{} and {}",
        brightness(2, 2),
        brightness(250, 40)
    );
}

#[test]
fn custom_renders_into_the_texture_of_the_application_and_prints_the_plan() {
    let dir = tempfile::tempdir().unwrap();
    let outcome = run(Command::new(example("custom")).current_dir(dir.path()));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for line in [
        "plan: 2 passes",
        "load: the pass preserves the contents from before the frame",
        "320x180 Rgba16Float",
    ] {
        assert!(outcome.stdout.contains(line), "`{line}` is missing in:\n{}", outcome.stdout);
    }
    let image = image::open(dir.path().join("out/custom.png")).unwrap().into_rgba8();
    assert_eq!(image.dimensions(), (320, 180));
    // The colours in the example's source as sRGB: the application's in the corners, rings under the lens.
    let (green, orange, blue) = ([0, 124, 63, 255], [255, 188, 0, 255], [0, 137, 255, 255]);
    for (x, y, expected) in [
        (2, 2, green),
        (317, 177, green),
        (160, 16, green),
        (160, 90, orange),
        (160, 110, blue),
        (195, 90, orange),
        (112, 90, blue),
        (160, 24, orange),
    ] {
        let near = pixel(&image, x, y).iter().zip(expected).all(|(is, to_be)| is.abs_diff(to_be) <= 2);
        assert!(near, "at {x}, {y}: {:?} instead of {expected:?}", pixel(&image, x, y));
    }
}

#[test]
fn every_example_that_renders_also_opens_a_window() {
    if !on_path("xvfb-run") {
        return skip("examples_window", "xvfb-run is not installed");
    }
    for name in IN_WINDOWS {
        let mut command = Command::new("xvfb-run");
        command.args(["--auto-servernum", "--server-args=-screen 0 1024x768x24"]);
        let outcome = run(command.arg(example(name)).args(["--window", "--frames", "2"]));
        assert_eq!(outcome.code, Some(0), "{name}: {}", outcome.stderr);
        // wgpu panics on validation errors by default.
        assert!(!outcome.stderr.contains("panicked"), "{name}: {}", outcome.stderr);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_window_without_a_display_ends_with_one_line() {
    let mut command = Command::new(example("minimal_graph"));
    command.arg("--window");
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let outcome = run(&mut command);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.stderr.starts_with("error: there is no display"), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
}

#[test]
fn examples_stay_short() {
    let lines = |file: &str| std::fs::read_to_string(repository().join(file)).unwrap().lines().count();
    let dir = repository().join("examples/examples");
    let inside = ["", "custom_engine", "custom_pipeline"].map(|inside| std::fs::read_dir(dir.join(inside)));
    let files = inside.into_iter().flat_map(Result::unwrap).map(|entry| entry.unwrap().path());
    let sources: Vec<_> = files.filter(|path| path.extension().is_some_and(|is| is == "rs")).collect();
    assert!(sources.len() >= 15, "{sources:?}");
    for path in sources {
        let count = lines(path.to_str().unwrap());
        assert!(count <= 150, "{} has {count} lines", path.display());
    }
    let of_technique =
        ["main.rs", "esm.rs", "esm.wgsl"].map(|file| lines(&format!("examples/custom_technique/src/{file}")));
    assert!(of_technique.iter().sum::<usize>() < 250, "{of_technique:?}");
}

#[test]
fn a_custom_engine_gets_shadows_on_its_boxes() {
    let dir = tempfile::tempdir().unwrap();
    let outcome = run(Command::new(example("custom_engine")).current_dir(dir.path()));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let image = image::open(dir.path().join("out/custom_engine.png")).unwrap().into_rgba8();
    // The lit ground, a step's shadow, and the sky.
    let [lit, dark, sky] = [(560, 300), (270, 245), (20, 20)].map(|(x, y)| pixel(&image, x, y));
    assert!(lit[0] > 190 && dark[0] < 110 && sky[2] > sky[0] + 40, "{lit:?} {dark:?} {sky:?}");
}

#[test]
fn stained_glass_colours_the_floor_by_maps_and_by_rays() {
    let dir = tempfile::tempdir().unwrap();
    for technique in ["pcf", "raytraced"] {
        let arguments = [technique, "--size", "480x270"];
        let outcome = run(Command::new(example("stained_glass")).args(arguments).current_dir(dir.path()));
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let file = dir.path().join("out/stained_glass.png");
        let image = image::open(file).unwrap().into_rgba8();
        // Behind the red, green and blue panes.
        for (channel, (x, y)) in [(185, 165), (200, 197), (260, 205)].into_iter().enumerate() {
            let [red, green, blue, _] = pixel(&image, x, y);
            let others = [red, green, blue].into_iter().enumerate().filter(|(other, _)| *other != channel);
            let most = others.map(|(_, value)| value).max().unwrap();
            assert!([red, green, blue][channel] > most + 15, "{technique}: {red} {green} {blue} at {x}, {y}");
        }
    }
}

#[test]
fn a_third_party_technique_is_rendered_measured_and_dumped() {
    let dir = tempfile::tempdir().unwrap();
    let program = |arguments: &[&str]| {
        run(Command::new(example("custom_technique")).args(arguments).current_dir(dir.path()))
    };
    let nodes = program(&["nodes"]);
    assert!(nodes.stdout.contains("\"esm\": (falloff_m: 0.05)"), "{}", nodes.stdout);
    let dump = program(&["dump", "--technique", "esm"]);
    assert!(dump.stdout.contains("esm/cascades"), "{}", dump.stdout);
    std::fs::write(dir.path().join("mine.ron"), "(techniques: {\"esm\": (falloff_m: 0.0)})").unwrap();
    let refused = program(&["render", "--settings", "mine.ron"]);
    let expected = "invalid value: `techniques.esm.falloff_m` is 0; allowed: 0.001 to 10 (metres)";
    assert!(refused.code == Some(1) && refused.stderr.contains(expected), "{}", refused.stderr);
    let drawn = program(&["render", "--technique", "esm+contact", "--size", "320x180", "-o", "esm.png"]);
    assert_eq!(drawn.code, Some(0), "{}", drawn.stderr);
    let pixel = program(&["pixel", "160,120", "--size", "320x180", "--technique", "esm"]);
    assert!(
        pixel.stdout.contains("    cascade: ") && pixel.stdout.contains("    stored depth: "),
        "{}",
        pixel.stdout
    );
    let case = r#"(cases: [(
        scene: TestScene("cube"), sun_elevations_deg: [40], sun_heading_deg: 55,
        views: [(name: "near", eye: (3, 2, 5), target: (0, 0.5, 0))],
    )])"#;
    std::fs::write(dir.path().join("case.ron"), case).unwrap();
    let arguments =
        ["measure", "--techniques", "pcf,esm", "--quick", "--size", "160x90", "--cases", "case.ron"];
    let measured = program(&arguments);
    assert_eq!(measured.code, Some(0), "{}", measured.stderr);
    assert!(
        measured.stdout.lines().any(|line| line.starts_with("mean") && line.contains(" esm ")),
        "{}",
        measured.stdout
    );
}
