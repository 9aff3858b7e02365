//! Text of a scene, a plan and its times.

use std::sync::Arc;

use super::failure::Failure;
use serde_json::{Value, json};
use shadowgraph::core::{PassTime, Plan};
use shadowgraph::inspect::lights::{kind, shadows, unit};
use shadowgraph::scene::Light;
use shadowgraph::shadows::Unshadowed;
use shadowgraph::wgpu::AdapterInfo;
use shadowgraph::{CulledView, FrameCounts};
use shadowgraph_quality::TextTable;

/// Maximum length of the lines of tables.
pub(crate) const COLUMNS: usize = 110;

/// A planned frame.
pub(crate) struct Planned {
    pub(crate) plan: Arc<Plan>,
    /// Empty unless requested.
    pub(crate) times: Vec<PassTime>,
    pub(crate) unshadowed: Vec<Unshadowed>,
    /// Empty unless times are requested.
    pub(crate) counts: FrameCounts,
}

/// Formats the plan as text, with the scene's lights.
pub(crate) fn text(lights: &[Light], planned: &Planned) -> String {
    let mut out = planned.plan.to_text();
    out.push_str("\nlights\n");
    if lights.is_empty() {
        out.push_str("  none\n");
    }
    let row = |(index, light): (usize, &Light)| {
        let name = light.name.as_deref().unwrap_or("-").chars().take(28).collect();
        let strength = format!("{:.1} {}", light.intensity, unit(light));
        let shadows = shadows(light, index, &planned.unshadowed);
        [index.to_string(), kind(light).into(), name, strength, shadows]
    };
    let rows = lights.iter().enumerate().map(row);
    out + &TextTable { alignment: "rllrl", indent: 2, width: COLUMNS }.format(rows)
}

/// Formats the plan as JSON, with the scene's lights.
pub(crate) fn json(lights: &[Light], planned: &Planned, contents: Option<Value>) -> Result<String, Failure> {
    let mut document: Value = serde_json::from_str(&planned.plan.to_json()?)?;
    let lights = lights.iter().enumerate().map(|(index, light)| {
        json!({
            "index": index,
            "kind": kind(light),
            "name": light.name,
            "intensity": light.intensity,
            "unit": unit(light),
            "shadows": shadows(light, index, &planned.unshadowed),
        })
    });
    document["lights"] = lights.collect();
    if !planned.times.is_empty() {
        document["times"] = serde_json::to_value(&planned.times)?;
    }
    if !planned.counts.culled.is_empty() {
        let culled = planned.counts.culled.iter();
        document["culled"] =
            culled.map(|view| json!({"view": view.view, "instances": view.instances})).collect();
    }
    if !planned.counts.shadows.is_empty() {
        let shadows = planned.counts.shadows.iter();
        document["shadow_counts"] = shadows.map(|(name, count)| (*name, *count)).collect();
    }
    if let Some(contents) = contents {
        document["contents"] = contents;
    }
    let mut text = serde_json::to_string_pretty(&document)?;
    text.push('\n');
    Ok(text)
}

/// Returns tables of what the GPU has counted.
pub(crate) fn counts(counts: &FrameCounts) -> String {
    let culled = if counts.culled.is_empty() { String::new() } else { culled(&counts.culled) };
    let rows = counts.shadows.iter().map(|(name, count)| [(*name).to_owned(), count.to_string()]);
    let shadows = TextTable { alignment: "lr", indent: 2, width: COLUMNS }.format(rows);
    culled + &shadows
}

fn culled(culled: &[CulledView]) -> String {
    let heading = ["culled on the GPU", "instances"].map(str::to_owned);
    let rows = culled.iter().map(|CulledView { view, instances }| [view.clone(), instances.to_string()]);
    let rows: Vec<_> = [heading].into_iter().chain(rows).collect();
    TextTable { alignment: "lr", indent: 2, width: COLUMNS }.format(rows)
}

/// Returns the lights without shadows, a sentence for each reason.
pub(crate) fn unshadowed(unshadowed: &[Unshadowed]) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for light in unshadowed {
        let (reason, index) = (light.reason.describe(), light.light.to_string());
        match reasons.iter_mut().find(|(other, _)| *other == reason) {
            Some((_, lights)) => lights.push(index),
            None => reasons.push((reason, vec![index])),
        }
    }
    let sentence = |(reason, lights): (&str, Vec<String>)| match &lights[..] {
        [light] => format!("light {light} has no shadows: {reason}"),
        lights => format!("lights {} have no shadows: {reason}", lights.join(", ")),
    };
    reasons.into_iter().map(sentence).collect()
}

/// Returns a table of times per pass, grouped by node.
pub(crate) fn times(times: &[PassTime], adapter: &AdapterInfo) -> String {
    let mut rows = vec![["pass", "CPU ms", "GPU ms", "draws", "triangles", ""].map(str::to_owned)];
    let mut nodes: Vec<&str> = Vec::new();
    for time in times {
        if !nodes.contains(&time.node.as_str()) {
            nodes.push(&time.node);
        }
    }
    for node in nodes {
        let heading = if node.is_empty() { "(no node)" } else { node };
        rows.push([heading, "", "", "", "", ""].map(str::to_owned));
        for time in times.iter().filter(|time| time.node == node) {
            let name = format!("  {}", time.pass.rsplit('/').next().unwrap_or_default());
            let count = |number: Option<u64>| number.map_or("-".into(), |number| number.to_string());
            let [cpu, gpu] = milliseconds(time.cpu_ms, time.gpu_ms);
            let (draws, triangles) = (count(time.draws.map(u64::from)), count(time.triangles));
            rows.push([name, cpu, gpu, draws, triangles, sharing(time.gpu_ms.is_some(), time.shared_by)]);
        }
    }
    let cpu_ms = times.iter().map(|time| time.cpu_ms).sum();
    let gpu_ms = times.iter().filter_map(PassTime::gpu_share_ms).reduce(|a, b| a + b);
    let [cpu, gpu] = milliseconds(cpu_ms, gpu_ms);
    rows.push(["sum".into(), cpu, gpu, String::new(), String::new(), String::new()]);
    let table = TextTable { alignment: "lrrrrl", indent: 2, width: COLUMNS }.format(rows);
    format!("times on {}\n{table}", adapter.name)
}

/// Returns a note if a GPU time is that of several merged passes.
pub(crate) fn sharing(measured: bool, shared_by: u32) -> String {
    if measured && shared_by > 1 { format!("all {shared_by} merged") } else { String::new() }
}

fn milliseconds(cpu_ms: f64, gpu_ms: Option<f64>) -> [String; 2] {
    [format!("{cpu_ms:.3}"), gpu_ms.map_or("-".into(), |ms| format!("{ms:.3}"))]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn times_are_grouped_by_node_and_summed() {
        let time = |pass: &str, node: &str, gpu_ms| PassTime {
            pass: pass.into(),
            node: node.into(),
            cpu_ms: 1.0,
            gpu_ms,
            shared_by: 1,
            ..PassTime::default()
        };
        let list = [time("a/x", "a", Some(2.0)), time("y", "", None), time("a/z", "a", Some(0.5))];
        let adapter = shadowgraph::Gpu::noop().unwrap().adapter;
        let text = times(&list, &adapter);
        assert!(text.ends_with("\n  sum         3.000   2.500\n"), "{text}");
        let (a, z, none) = (text.find("  a\n"), text.find("    z"), text.find("(no node)"));
        assert!(a < z && z < none, "{text}");
    }

    #[test]
    fn a_time_that_merged_passes_share_has_a_note_and_counts_once() {
        let time = |pass: &str, gpu_ms, shared_by| PassTime {
            pass: format!("map/{pass}"),
            node: "map".into(),
            cpu_ms: 1.0,
            gpu_ms,
            shared_by,
            ..PassTime::default()
        };
        let merged = ["clear", "first", "second"].map(|pass| time(pass, Some(6.0), 3));
        let list = [merged.as_slice(), &[time("alone", Some(0.5), 1), time("unknown", None, 3)]].concat();
        let text = times(&list, &shadowgraph::Gpu::noop().unwrap().adapter);
        assert_eq!(text.matches("6.000      -          -  all 3 merged").count(), 3, "{text}");
        assert_eq!(text.matches("merged").count(), 3, "{text}");
        assert!(text.ends_with("\n  sum         5.000   6.500\n"), "{text}");
        assert!(text.lines().all(|line| line.len() <= 110), "{text}");
    }
}
