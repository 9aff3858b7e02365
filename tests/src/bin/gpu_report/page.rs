//! The report as one page.

use std::fmt::Write as _;

use shadowgraph_quality::bench::Stats;

use crate::data::{GraphCost, PixelTests, Report, SceneData, TechniqueData};

const STYLE: &str = "\
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 72rem; padding: 0 1rem; }
table { border-collapse: collapse; margin: .5rem 0 1rem; }
th, td { padding: .2rem .8rem; text-align: right; border-bottom: 1px solid #8884; font-variant-numeric: tabular-nums; }
th:first-child, td:first-child { text-align: left; }
summary { cursor: pointer; }
";

/// Returns the report as an HTML page without references to other files.
pub(crate) fn page(report: &Report) -> String {
    let adapter = &report.adapter;
    let [width, height] = report.size_px;
    let mut body = String::new();
    report.scenes.iter().for_each(|data| body += &scene(data));
    body += &graph(&report.graph);
    body += &report.pixel_tests.as_ref().map_or("<p>The pixel tests were left out.</p>".into(), pixel_tests);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <title>GPU report: {name}</title><style>\n{STYLE}</style></head><body>\n\
         <h1>{name}</h1>\n<p>{backend}, {device_type}, {driver}; {processors} processors. Frames of {width} x {height} pixels. \
         Shadow maps are drawn in each frame.</p>\n{body}</body></html>\n",
        name = escape(&adapter.name),
        backend = escape(&adapter.backend),
        device_type = escape(&adapter.device_type),
        driver = escape(&adapter.driver),
        processors = adapter.processors,
    )
}

fn scene(scene: &SceneData) -> String {
    let mut rows = vec![
        ["technique, pipeline", "frame ms", "5 to 95 %", "thread ms", "GPU ms of passes"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for data in &scene.techniques {
        let Stats { median, p5, p95, .. } = data.frame_ms;
        rows.push(vec![
            format!("{}, {}", data.technique, data.pipeline),
            format!("{median:.2}"),
            format!("{p5:.2} to {p95:.2}"),
            format!("{:.3}", data.thread_ms.median),
            data.gpu_ms().map_or("-".into(), |ms| format!("{ms:.3}")),
        ]);
    }
    let passes: String = scene.techniques.iter().map(passes).collect();
    let left_out: String =
        scene.left_out.iter().map(|line| format!("<p>Not measured: {}</p>\n", escape(line))).collect();
    format!(
        "<h2>{}</h2>\n<p>{} instances, {} triangles, {} lights.</p>\n{}{left_out}{passes}",
        escape(&scene.name),
        scene.instances,
        scene.triangles,
        scene.lights,
        table(&rows)
    )
}

fn passes(data: &TechniqueData) -> String {
    let mut rows = vec![["pass", "GPU ms", "CPU us", "merged passes"].map(str::to_owned).to_vec()];
    for pass in &data.passes {
        rows.push(vec![
            pass.pass.clone(),
            pass.gpu_ms.map_or("-".into(), |ms| format!("{:.3}", ms.median)),
            format!("{:.1}", pass.cpu_ms.median * 1e3),
            if pass.shared_by > 1 { format!("time of all {}", pass.shared_by) } else { String::new() },
        ]);
    }
    let (technique, pipeline) = (escape(&data.technique), escape(&data.pipeline));
    format!("<details><summary>Passes: {technique}, {pipeline}</summary>\n{}</details>\n", table(&rows))
}

fn graph(costs: &[GraphCost]) -> String {
    let mut rows =
        vec![["passes", "by hand, us", "unchanged frame", "changed frame"].map(str::to_owned).to_vec()];
    for cost in costs {
        rows.push(vec![
            cost.passes.to_string(),
            format!("{:.1}", cost.by_hand_us),
            format!("{:.2} x", cost.unchanged),
            format!("{:.2} x", cost.changed),
        ]);
    }
    format!(
        "<h2>The graph</h2>\n<p>Processor time of declaring, compiling, recording and submitting a frame with this driver, as a multiple \
         of that of the same passes written by hand; medians.</p>\n{}",
        table(&rows)
    )
}

fn pixel_tests(tests: &PixelTests) -> String {
    let PixelTests { passed, failed, skipped } = tests;
    let mut text = format!(
        "<h2>Pixel tests</h2>\n<p>{passed} passed, {} failed, {} skipped.</p>\n<ul>\n",
        failed.len(),
        skipped.len()
    );
    for (name, reason) in failed {
        _ = writeln!(text, "<li>failed: {}: {}</li>", escape(name), escape(reason));
    }
    for skip in skipped {
        _ = writeln!(text, "<li>skipped: {}</li>", escape(skip));
    }
    text + "</ul>\n"
}

/// Formats rows, the first of which are headings.
fn table(rows: &[Vec<String>]) -> String {
    let mut text = "<table>\n".to_owned();
    for (index, row) in rows.iter().enumerate() {
        let tag = if index == 0 { "th" } else { "td" };
        let cells: String = row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escape(cell))).collect();
        _ = writeln!(text, "<tr>{cells}</tr>");
    }
    text + "</table>\n"
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::AdapterData;

    #[test]
    fn the_page_has_every_figure_and_escapes_names() {
        let quantiles = Stats { median: 12.345, p5: 11.0, p95: 13.5, ..Stats::default() };
        let technique = TechniqueData {
            technique: "pcf".into(),
            pipeline: "minimal_lit".into(),
            frame_ms: quantiles,
            thread_ms: quantiles,
            passes: Vec::new(),
        };
        let scene = SceneData {
            name: "a<b".into(),
            instances: 3,
            triangles: 99,
            lights: 1,
            techniques: vec![technique],
            left_out: vec![],
        };
        let report = Report {
            version: 1,
            adapter: AdapterData {
                name: "GPU & co".into(),
                backend: "Vulkan".into(),
                device_type: "Cpu".into(),
                driver: "driver".into(),
                processors: 2,
            },
            size_px: [64, 32],
            scenes: vec![scene],
            graph: vec![GraphCost { passes: 10, by_hand_us: 27.0, unchanged: 1.24, changed: 1.66 }],
            pixel_tests: Some(PixelTests {
                passed: 7,
                failed: vec![("t".into(), "1 > 2".into())],
                skipped: vec![],
            }),
        };
        let page = page(&report);
        for text in [
            "GPU &amp; co",
            "a&lt;b",
            "64 x 32",
            "12.35",
            "11.00 to 13.50",
            "1.24 x",
            "7 passed, 1 failed",
            "1 &gt; 2",
        ] {
            assert!(page.contains(text), "{text}: {page}");
        }
    }
}
