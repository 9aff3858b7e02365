//! How many instances the views draw that the GPU culls.

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;
use shadowgraph_tests::copies::copies;
use std::process::Command;

#[test]
fn with_times_a_dump_says_how_many_instances_each_culled_view_draws() {
    if let Err(reason) = Gpu::open(&AdapterChoice::Auto) {
        return shadowgraph_tests::skip("dump_culled", &reason.to_string());
    }
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("copies.glb");
    std::fs::write(&file, copies(5000).glb()).unwrap();
    let dump = |format: &str| {
        let output = Command::new(shadowgraph_tests::program().unwrap())
            .args(["dump", "--timings", "--pipeline", "minimal_lit", "--size", "64x36", "--format", format])
            .arg(&file)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let text = dump("text");
    assert!(text.contains("culled on the GPU    instances\n"), "{text}");
    let json: serde_json::Value = serde_json::from_str(&dump("json")).unwrap();
    let culled = json["culled"].as_array().unwrap();
    let camera = culled.iter().find(|view| view["view"] == "camera").unwrap();
    assert!((1..=5000).contains(&camera["instances"].as_u64().unwrap()), "{camera}");
}
