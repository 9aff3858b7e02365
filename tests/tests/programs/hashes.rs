//! `dump --hashes` and `dump --diff` of what passes have written.

use std::path::Path;
use std::process::{Command, Output};

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;

fn run(arguments: &[&str], shaders: Option<&Path>) -> (Output, String, String) {
    let mut command = Command::new(shadowgraph_tests::program().unwrap());
    command.args(arguments);
    if let Some(shaders) = shaders {
        command.arg("--shaders").arg(shaders);
    }
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    (output, out, err)
}

#[test]
fn the_pass_of_a_changed_shader_is_named_and_damaged_values_are_refused() {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        return shadowgraph_tests::skip("check_values", &reason.to_string());
    }
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let dump = |name: &str, shaders: Option<&Path>| {
        let path = file(name);
        let scene = ["dump", "--scene", "cornell", "--size", "96x54", "--hashes", "-o", &path];
        let (output, _, err) = run(&scene, shaders);
        assert!(output.status.success(), "{err}");
        path
    };
    let first = dump("first.json", None);
    let (output, out, err) = run(&["dump", "--diff", &first, &dump("second.json", None)], None);
    assert!(output.status.success(), "{err}");
    assert!(out.starts_with("contents: all ") && out.ends_with("the plans do not differ\n"), "{out}");

    let source = shadowgraph_tests::repository().join("shaders/wgsl/forward.wgsl");
    let good = std::fs::read_to_string(source).unwrap();
    let end = "return vec4f(radiance * alpha, alpha);";
    let changed = good.replace(end, "return vec4f(radiance * alpha * 1.25, alpha);");
    std::fs::write(folder.path().join("forward.wgsl"), changed).unwrap();
    let third = dump("third.json", Some(folder.path()));
    let (_, out, err) = run(&["dump", "--diff", &first, &third], None);
    let start = "contents: `lighting/forward` writes `lighting/lit` v1 differently, from equal inputs: ";
    assert!(out.starts_with(start), "{out}{err}");
    // Counts of the histogram are not numbers with a tolerance.
    let (_, out, _) = run(&["dump", "--diff", &first, &third, "--tolerance", "1"], None);
    assert!(!out.contains("lighting/forward"), "{out}");

    let (_, out, _) = run(&["dump", "--diff", &first, &third, "--outliers", "0.01"], None);
    assert!(out.contains("`lighting/forward`"), "{out}");
    let (_, out, _) = run(&["dump", "--diff", &first, &third, "--outliers", "1"], None);
    assert!(out.starts_with("contents: all "), "{out}");

    std::fs::write(file("third.values"), "not values").unwrap();
    let (output, _, err) = run(&["dump", "--diff", &first, &third], None);
    assert_eq!(output.status.code(), Some(1));
    assert!(err.contains("the file next to it is not one of values") && err.lines().count() == 1, "{err}");
    let mut values = std::fs::read(file("first.values")).unwrap();
    let middle = values.len() / 2;
    values[middle..].fill(7);
    std::fs::write(file("third.values"), values).unwrap();
    let (output, _, err) = run(&["dump", "--diff", &first, &third], None);
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert_eq!(err.lines().count(), 1, "{err}");
}
