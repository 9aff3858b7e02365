//! HTML pages of frames, tested in headless Chromium by `driver.js`.

mod frames;

use serde_json::Value;
use shadowgraph::inspect::to_html;
use shadowgraph_tests::program;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::browser::{Page, installed};

const FLAGS: [&str; 14] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--hide-scrollbars",
    "--window-size=1600,1000",
    "--virtual-time-budget=60000",
    "--enable-logging=stderr",
    "--dump-dom",
];

/// The largest size of a page without images.
const MOST_BYTES: usize = 1 << 20;

/// Opens a page with the driver appended, and returns the driver's results; `None` without a browser.
fn used(page: &str) -> Option<Value> {
    let browser = installed()?;
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("page.html");
    let driver = format!("<script>\n{}</script>\n</body>", include_str!("driver.js"));
    fs::write(&file, page.replacen("</body>", &driver, 1)).unwrap();
    let data = format!("--user-data-dir={}", dir.path().join("browser").display());
    let output = Command::new(browser)
        .args(FLAGS)
        .arg(data)
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let (dom, log) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    let said: Vec<_> = log.lines().filter(|line| line.contains("CONSOLE")).collect();
    assert!(said.is_empty(), "the page has errors: {said:#?}");
    let (_, result) = dom.split_once(r#"<pre id="result">"#).unwrap_or_else(|| panic!("no result: {log}"));
    let (result, _) = result.split_once("</pre>").unwrap();
    Some(
        serde_json::from_str(&result.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))
            .unwrap(),
    )
}

fn assert_sound(found: &Value) {
    assert_eq!(found["faults"], Value::Array(Vec::new()), "{found:#}");
}

#[test]
fn the_page_of_the_demo_frame_shows_every_view_and_its_images() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("demo.html");
    let output = Command::new(program().unwrap())
        .args(["dump", "--size", "320x180", "--format", "html", "-o"])
        .arg(&file)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = fs::read_to_string(&file).unwrap();
    keep(&page, "demo");
    let Some(found) = used(&page) else { return };
    assert_sound(&found);
    // Maps, depth and colours have more than one color.
    let colors: Vec<u64> =
        found["facts"]["colors"].as_array().unwrap().iter().filter_map(Value::as_u64).collect();
    assert!(colors.iter().filter(|&&colors| colors > 50).count() >= 4, "{found}");
}

#[test]
fn the_page_of_a_frame_of_65_passes_opens_with_its_nodes_collapsed() {
    let page = to_html(&frames::real().unwrap());
    assert!(page.len() < MOST_BYTES, "{} bytes", page.len());
    keep(&page, "real");
    let Some(found) = used(&page) else { return };
    assert_sound(&found);
    assert!(found["facts"]["boxes"].as_u64() < Some(30), "{found}");
}

#[test]
fn the_page_of_a_frame_of_500_passes_is_readable() {
    let plan = frames::large().unwrap();
    assert!(plan.pass_count() > 500 && plan.culled_count() > 50, "{}", plan.culled_count());
    let page = to_html(&plan);
    assert!(page.len() < MOST_BYTES, "{} bytes", page.len());
    keep(&page, "large");
    let Some(found) = used(&page) else { return };
    assert_sound(&found);
    assert!(found["facts"]["boxes"].as_u64() < Some(60), "{found}");
}

#[test]
fn every_action_on_a_page_of_500_passes_is_answered_quickly() {
    let file = keep(&to_html(&frames::large().unwrap()), "quick");
    let Some(mut page) = Page::open(&format!("file://{}", file.display())) else { return };
    page.until("typeof graphView === 'object' && graphView.content");
    let times = page.value(include_str!("times.js"));
    println!("worst times in ms: {times}");
    let times = times.as_object().unwrap();
    assert!(times.len() > 10, "{times:?}");
    // 100 on an idle machine.
    assert!(times.values().all(|ms| ms.as_f64().unwrap() < 1000.0), "{times:?}");
    page.close();
}

/// Saves a page for a person to look at.
fn keep(page: &str, name: &str) -> PathBuf {
    let dir = shadowgraph_tests::repository().join("target/tmp/pages");
    fs::create_dir_all(&dir).unwrap();
    let file = dir.join(format!("{name}.html"));
    fs::write(&file, page).unwrap();
    file
}
