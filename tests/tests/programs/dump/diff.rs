//! Differences between the frames of two techniques.

use serde_json::Value;
use std::process::Command;

/// Lists every fact of a dump, independently of the program's own comparison.
fn facts(dump: &Value) -> Vec<(&'static str, String, String)> {
    let plan = &dump["plan"];
    let nodes = plan["nodes"].as_array().unwrap();
    let path = |node: &Value| {
        let mut names: Vec<&str> = Vec::new();
        let mut at = node.as_u64();
        while let Some(node) = at {
            names.push(nodes[node as usize]["name"].as_str().unwrap());
            at = nodes[node as usize]["parent"].as_u64();
        }
        names.reverse();
        names.join("/")
    };
    let of_nodes = (0..nodes.len()).map(|node| ("node", path(&serde_json::json!(node)), String::new()));
    let of_passes = plan["passes"].as_array().unwrap().iter().map(|pass| {
        let node = path(&pass["node"]);
        let name = pass["name"].as_str().unwrap();
        let name = if node.is_empty() { name.to_owned() } else { format!("{node}/{name}") };
        ("pass", name, format!("{}{}", pass["kind"], pass["keep"]))
    });
    let of_resources = plan["resources"].as_array().unwrap().iter().map(|resource| {
        let shape: Vec<String> = ["desc", "origin", "exported", "texture_usage", "buffer_usage"]
            .iter()
            .map(|field| match (*field, &resource[*field]) {
                // The number of a history depends on the order of declaration.
                ("origin", Value::Object(origin)) => origin.keys().next().unwrap().clone(),
                (_, value) => value.to_string(),
            })
            .collect();
        let (node, name) = (path(&resource["node"]), resource["name"].as_str().unwrap());
        let name = if node.is_empty() { name.to_owned() } else { format!("{node}/{name}") };
        ("resource", name, shape.join(" "))
    });
    let of_decisions = dump["reasons"].as_array().unwrap().iter().map(|reason| {
        let text = |field: &str| reason[field].as_str().map(str::to_owned);
        let who: Vec<String> =
            ["pass", "resource", "part", "decision"].into_iter().filter_map(text).collect();
        let what = format!("{}: {}", text("action").unwrap(), text("because").unwrap());
        ("decision", who.join(" · "), what)
    });
    of_nodes.chain(of_passes).chain(of_resources).chain(of_decisions).collect()
}

#[test]
fn the_difference_between_two_techniques_is_the_set_difference_of_their_dumps() {
    let dir = tempfile::tempdir().unwrap();
    let file = |technique: &str| {
        let file = dir.path().join(format!("{technique}.json"));
        let program = shadowgraph_tests::program().unwrap();
        let args = ["dump", "--technique", technique, "--format", "json", "-o"];
        assert!(Command::new(program).args(args).arg(&file).status().unwrap().success());
        file
    };
    let [pcf, evsm] = ["pcf", "evsm"].map(file);
    let read = |file| -> Value { serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap() };
    let (mut gone, mut came) = (facts(&read(&pcf)), facts(&read(&evsm)));
    gone.retain(|fact| came.iter().position(|other| other == fact).map(|at| came.remove(at)).is_none());

    let program = shadowgraph_tests::program().unwrap();
    let diff = |format: &str| {
        let command = ["dump", "--format", format, "--diff"];
        let output = Command::new(program).args(command).args([&pcf, &evsm]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let differences: Value = serde_json::from_str(&diff("json")).unwrap();
    let differences = differences["differences"].as_array().unwrap();
    let names = |side: &str, subject: &str| {
        let own = differences.iter().filter(|d| d["subject"] == subject && !d[side].is_null());
        let mut names: Vec<&str> = own.map(|d| d["name"].as_str().unwrap()).collect();
        names.sort_unstable();
        names
    };
    for subject in ["node", "pass", "resource", "decision"] {
        for (side, facts) in [("before", &gone), ("after", &came)] {
            let own = facts.iter().filter(|(kind, ..)| *kind == subject);
            let mut expected: Vec<&str> = own.map(|(_, name, _)| name.as_str()).collect();
            expected.sort_unstable();
            assert_eq!(names(side, subject), expected, "{subject}, {side}");
        }
    }
    let decisions = |side: &str| {
        let own = differences.iter().filter(|d| d["subject"] == "decision");
        let mut words: Vec<&str> = own.filter_map(|d| d[side].as_str()).collect();
        words.sort_unstable();
        words
    };
    for (side, facts) in [("before", &gone), ("after", &came)] {
        let mut expected: Vec<&str> = facts.iter().filter(|f| f.0 == "decision").map(|f| &*f.2).collect();
        expected.sort_unstable();
        assert_eq!(decisions(side), expected);
    }
    assert!(came.iter().any(|(kind, name, _)| *kind == "node" && name.contains("moments")), "{came:?}");
    assert!(diff("text").contains("+ shadows/cascade moments\n"));
    assert!(diff("html").contains(&format!("to {}</h1>", evsm.display())));
    let schema = std::fs::read_to_string(shadowgraph_tests::repository().join("docs/dump/diff.schema.json"));
    let schema: Value = serde_json::from_str(&schema.unwrap()).unwrap();
    let faults =
        super::schema::faults(&schema, &schema, &serde_json::json!({ "differences": differences }), "");
    assert_eq!(faults, Vec::<String>::new());
    let slots = differences.iter().find(|d| d["subject"] == "summary" && d["name"] == "slot memory").unwrap();
    assert!(slots["after"].as_str().unwrap().ends_with("MiB"), "memory is reported: {slots}");
    let sampled = "lighting/forward · shadows/cascade moments/moments";
    assert!(
        differences.iter().any(|d| d["subject"] == "access" && d["name"] == sampled),
        "reads are reported"
    );
}

#[test]
fn a_file_that_is_not_a_dump_is_an_error_of_one_line() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("bad.json");
    std::fs::write(&file, "{}").unwrap();
    let diff = |files: [&std::path::Path; 2]| {
        let program = shadowgraph_tests::program().unwrap();
        let output = Command::new(program).args(["dump", "--diff"]).args(files).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, error) = diff([&file, &file]);
    assert_eq!((code, error.lines().count()), (Some(1), 1), "{error}");
    assert!(error.contains("bad.json: SG0702: not a valid dump: missing field `schema`"), "{error}");
    let (code, error) = diff([&dir.path().join("none.json"), &file]);
    assert_eq!((code, error.lines().count()), (Some(1), 1), "{error}");
    assert!(error.contains("none.json: cannot be read"), "{error}");
}
