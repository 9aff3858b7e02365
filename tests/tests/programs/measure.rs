//! The command `measure`: shadows are within the stored bounds, and the errors if they are not.

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;
use shadowgraph_quality::report::{CaseReport, MotionReport, Moving, Report};
use shadowgraph_tests::animated::RIGID;
use std::path::Path;
use std::process::{Command, Output};

/// Runs `measure`, or reports a skip where there is no driver.
fn measure(arguments: &[&str]) -> Option<Output> {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        shadowgraph_tests::skip("measure", &reason.to_string());
        return None;
    }
    Some(run(arguments))
}

fn run(arguments: &[&str]) -> Output {
    let program = shadowgraph_tests::program().unwrap();
    Command::new(program).arg("measure").args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// One small case, for tests that do not depend on the results.
const SMALL: &str = r#"(cases: [(
    scene: TestScene("cube"), sun_elevations_deg: [40], sun_heading_deg: 55,
    views: [(name: "a <view>", eye: (3, 2, 5), target: (0, 0.5, 0))],
)])"#;

fn small_case(dir: &Path) -> String {
    let file = dir.join("cases.ron");
    std::fs::write(&file, SMALL).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn the_quick_set_is_within_the_stored_bounds() {
    let bounds = shadowgraph_tests::repository().join("tests/bounds/quick.ron");
    let Some(output) = measure(&["--quick", "--check", bounds.to_str().unwrap()]) else { return };
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{err}\n{out}");
    assert!(out.contains("within all"), "{out}");
}

#[test]
fn motion_is_measured_against_the_truth_for_each_technique_on_each_path() {
    let dir = tempfile::tempdir().unwrap();
    let (cases, out) = (small_case(dir.path()), dir.path().join("out"));
    let arguments =
        ["--motion", "all", "--size", "96x54", "--techniques", "pcf,raytraced", "--cases", &cases, "-o"];
    let Some(output) = measure(&[&arguments[..], &[out.to_str().unwrap()]].concat()) else { return };
    assert!(output.status.success(), "{}", text(&output.stderr));
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    let report: MotionReport = serde_json::from_str(&read("motion.json")).unwrap();
    let names: Vec<_> = report.cases.iter().map(|case| (case.moving, case.technique.as_str())).collect();
    let expected = Moving::ALL.map(|moving| [(moving, "pcf"), (moving, "raytraced")]);
    assert_eq!(names, expected.concat());
    for case in &report.cases {
        let stability = &case.stability;
        assert!(stability.excess.count > 1_000, "{case:?}");
        let [soft, hard] = [stability.truth_changed, stability.hard_changed];
        assert_eq!([soft > 0.0, hard > 0.0], [case.moving != Moving::Camera; 2], "{case:?}");
        if case.moving == Moving::Sun {
            // The sun's diameter is 10.7 steps wide.
            assert!(soft > 5.0 * hard && soft < 11.0 * hard && stability.changed < 3.0 * soft, "{case:?}");
        }
        if case.moving == Moving::Camera {
            // The maps move by whole texels; weights of filters are rounded, and pixels get wider with the distance.
            assert!(stability.excess.p99 < 1e-6 && stability.changed < 0.5, "{case:?}");
        }
    }
    assert_eq!(read("motion.md").lines().count(), 2 + 6);
    assert_eq!(std::fs::read_dir(out.join("images")).unwrap().count(), 6);
}

#[test]
fn the_output_directory_gets_a_page_with_images_and_a_report() {
    let dir = tempfile::tempdir().unwrap();
    let (cases, out) = (small_case(dir.path()), dir.path().join("new/out"));
    let arguments = ["--quick", "--size", "160x90", "--techniques", "pcf,none", "--cases", &cases, "-o"];
    let Some(output) = measure(&[&arguments[..], &[out.to_str().unwrap()]].concat()) else { return };
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report: Report =
        serde_json::from_str(&std::fs::read_to_string(out.join("report.json")).unwrap()).unwrap();
    assert_eq!((report.version, report.size_px), (Report::VERSION, [160, 90]));
    let names: Vec<_> = report.cases.iter().map(|case| case.technique.as_str()).collect();
    assert_eq!(names, ["pcf", "none"]);
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("a &lt;view&gt;") && !page.contains("a <view>"));
    for case in &report.cases {
        let files = case.images.as_ref().unwrap();
        for file in [&files.color, &files.truth, &files.visibility, &files.difference] {
            assert_eq!(image::image_dimensions(out.join(file)).unwrap(), (160, 90), "{file}");
            assert!(page.contains(file.as_str()), "{file}");
        }
    }
    let left: Vec<_> = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 3, "{left:?}");
    // `none` lights everything: all shadowed pixels are misclassified.
    assert!(report.cases[1].errors.missing_contacts.missing_percent > 99.0);
}

#[test]
fn variants_of_settings_are_measured_next_to_the_base_settings() {
    let dir = tempfile::tempdir().unwrap();
    let (cases, variants) = (small_case(dir.path()), dir.path().join("variants.ron"));
    let text_of_variants = r#"(variants: [
        (name: "same", settings: ()),
        (name: "coarse", settings: (cascades: (count: 1, map_size_px: 256))),
    ])"#;
    std::fs::write(&variants, text_of_variants).unwrap();
    let (variants, out) = (variants.to_str().unwrap(), dir.path().join("out"));
    let arguments = ["--quick", "--size", "160x90", "--cases", &cases, "--variants", variants, "-o"];
    let Some(output) = measure(&[&arguments[..], &[out.to_str().unwrap()]].concat()) else { return };
    assert!(output.status.success(), "{}", text(&output.stderr));
    let json = std::fs::read_to_string(out.join("report.json")).unwrap();
    let report: Report = serde_json::from_str(&json).unwrap();
    let names: Vec<_> = report.cases.iter().map(|case| case.technique.as_str()).collect();
    assert_eq!(names, ["pcf", "pcf: same", "pcf: coarse"]);
    assert_eq!(report.variants.len(), 2);
    let [own, same, coarse] = [0, 1, 2].map(|i| &report.cases[i]);
    assert_eq!((&own.errors, &own.seam, &own.edges), (&same.errors, &same.seam, &same.edges));
    let bytes = |case: &CaseReport| case.cost.as_ref().unwrap().texture_bytes;
    assert!(bytes(coarse) * 100 < bytes(own));
    assert!(coarse.errors.mean_error.total_percent > 2.0 * own.errors.mean_error.total_percent);
    assert!(coarse.seam.is_none() && own.seam.is_some());
}

#[test]
fn a_result_beyond_its_bound_is_named_and_the_exit_code_is_1() {
    let dir = tempfile::tempdir().unwrap();
    let (cases, bounds) = (small_case(dir.path()), dir.path().join("bounds.ron"));
    let lines =
        r#"(technique: "pcf", metric: "texture_mib", worst: 1), (technique: "pcf", metric: "seam", mean: 1)"#;
    std::fs::write(&bounds, format!("(bounds: [{lines}])")).unwrap();
    let bounds = bounds.to_str().unwrap();
    let arguments = ["--quick", "--size", "160x90", "--cases", &cases, "--check", bounds];
    let Some(output) = measure(&arguments) else { return };
    assert_eq!(output.status.code(), Some(1));
    let error = text(&output.stderr);
    let expected = "bounds.ron: pcf texture_mib: worst 64.0 (cube, sun 40°, a <view>) exceeds the bound 1";
    assert!(error.trim_end().ends_with(expected) && error.trim_end().lines().count() == 1, "{error}");
}

#[test]
fn invalid_input_is_an_error_of_one_line_before_anything_renders() {
    let dir = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let file = dir.path().join(name);
        std::fs::write(&file, text).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let bounds = file("bounds.ron", r#"(bounds: [(technique: "pcf", metric: "blur")])"#);
    let other = file("other.ron", r#"(bounds: [(technique: "evsm", metric: "seam", mean: 1)])"#);
    let two = file("two.ron", r#"(bounds: [(technique: "pcf: two", metric: "seam", mean: 1)])"#);
    let variants = r#"(variants: [(name: "a", settings: ()), (name: "b", settings: ())])"#;
    let twice = file("twice.ron", &variants.replace("\"b\"", "\"a\""));
    let variants = file("variants.ron", variants);
    let cases = file("cases.ron", r#"(cases: [(scene: TestScene("castle"))])"#);
    for (arguments, code, expected) in [
        (vec!["--techniques", "pcf,soft"], 1, "--techniques: unknown technique `soft`"),
        (vec!["--check", &bounds], 1, "unknown metric `blur`"),
        (vec!["--check", &other], 1, "`evsm` is not among --techniques: pcf"),
        (
            vec!["--check", &two, "--variants", &variants],
            1,
            "`pcf: two` is not among --techniques: pcf; --variants: a, b",
        ),
        (vec!["--variants", &twice], 1, "duplicate variant name `a`"),
        (vec!["--cases", &cases], 1, "unknown test scene `castle`"),
        (vec!["--cases", &cases, "--sun", "none"], 2, "--sun"),
        (vec!["--cases", "no/such.ron"], 1, "no/such.ron: cannot be read"),
        (vec!["no/such.glb"], 1, "no/such.glb"),
        (vec!["-o", &cases], 1, "is a file; expected a directory"),
        (vec!["--views", "0", "x.glb"], 1, "--views"),
        (vec!["--quick", "--full"], 2, "--full"),
    ] {
        let output = run(&arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
        assert!(code == 2 || error.trim_end().lines().count() == 1, "{error}");
    }
}

#[test]
fn motion_of_objects_in_a_scene_without_small_ones_is_refused_in_one_line() {
    let dir = tempfile::tempdir().unwrap();
    let file = (RIGID.file)().write(dir.path());
    let arguments = ["--motion", "objects", "--size", "32x18", file.to_str().unwrap()];
    let Some(output) = measure(&arguments) else { return };
    let error = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(
        error.contains("error: --motion: nothing moves; objects are instances smaller than half"),
        "{error}"
    );
}
