//! Times in Chrome's trace format.

use serde::Serialize;
use shadowgraph_core::PassTime;

#[derive(Serialize)]
struct Trace<'t> {
    #[serde(rename = "traceEvents")]
    events: Vec<Event<'t>>,
    #[serde(rename = "displayTimeUnit")]
    unit: &'static str,
}

/// An event of Chrome's trace format.
#[derive(Serialize)]
struct Event<'t> {
    name: &'t str,
    #[serde(skip_serializing_if = "str::is_empty")]
    cat: &'t str,
    ph: &'static str,
    pid: u32,
    tid: u32,
    /// Microseconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    ts: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    dur: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    args: Option<Arguments<'t>>,
}

#[derive(Serialize)]
struct Arguments<'t> {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'t str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    draws: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    triangles: Option<u64>,
    /// The passes that share a GPU time, if there are several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    passes: Vec<&'t str>,
}

const CPU: u32 = 1;
const GPU: u32 = 2;

/// Returns the times of a frame in Chrome's trace format, which chrome://tracing and Perfetto open: one row for the CPU and
/// one for the GPU. Passes that share a GPU time are one event with all of their names.
///
/// ```
/// use shadowgraph_core::PassTime;
/// use shadowgraph_inspect::trace_json;
/// let time = PassTime { pass: "post/blur".into(), cpu_ms: 0.5, ..PassTime::default() };
/// assert!(trace_json(&[time])?.contains("post/blur"));
/// # Ok::<(), serde_json::Error>(())
/// ```
///
/// # Errors
/// Errors of serde_json; times cause none.
pub fn trace_json(times: &[PassTime]) -> Result<String, serde_json::Error> {
    let row = |tid, name| Event {
        name: "thread_name",
        cat: "",
        ph: "M",
        pid: 1,
        tid,
        ts: None,
        dur: None,
        args: Some(Arguments { name: Some(name), draws: None, triangles: None, passes: Vec::new() }),
    };
    let mut events = vec![row(CPU, "CPU: recording"), row(GPU, "GPU")];
    let mut shared: Option<f64> = None;
    for time in times {
        let args = |passes| Arguments { name: None, draws: time.draws, triangles: time.triangles, passes };
        let event = |tid, begin_ms: f64, ms: f64, passes| Event {
            name: &time.pass,
            cat: &time.node,
            ph: "X",
            pid: 1,
            tid,
            ts: Some(begin_ms * 1e3),
            dur: Some(ms * 1e3),
            args: Some(args(passes)),
        };
        events.push(event(CPU, time.cpu_begin_ms, time.cpu_ms, Vec::new()));
        let (Some(begin_ms), Some(ms)) = (time.gpu_begin_ms, time.gpu_ms) else { continue };
        // Passes that share a time have the same start.
        if time.shared_by > 1 && shared == Some(begin_ms) {
            continue;
        }
        shared = Some(begin_ms);
        let together = |other: &&PassTime| time.shared_by > 1 && other.gpu_begin_ms == Some(begin_ms);
        let passes = times.iter().filter(together).map(|other| &*other.pass).collect();
        events.push(event(GPU, begin_ms, ms, passes));
    }
    serde_json::to_string(&Trace { events, unit: "ms" })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn passes_have_an_event_on_each_row_and_merged_ones_share_their_gpu_event() {
        let time = |pass: &str, shared_by| PassTime {
            pass: pass.into(),
            gpu_begin_ms: Some(if shared_by > 1 { 1.0 } else { 3.0 }),
            gpu_ms: Some(2.0),
            shared_by,
            ..PassTime::default()
        };
        let json = trace_json(&[time("clear", 2), time("tile", 2), time("lit", 1)]).unwrap();
        let trace: serde_json::Value = serde_json::from_str(&json).unwrap();
        let events = trace["traceEvents"].as_array().unwrap();
        let row = |tid| events.iter().filter(move |e| e["tid"] == tid && e["ph"] == "X");
        let names = |tid| row(tid).map(|e| e["name"].as_str().unwrap()).collect::<Vec<_>>();
        assert_eq!((names(CPU), names(GPU)), (vec!["clear", "tile", "lit"], vec!["clear", "lit"]));
        assert_eq!(row(GPU).next().unwrap()["args"]["passes"], serde_json::json!(["clear", "tile"]));
        let lit = row(GPU).next_back().unwrap();
        assert_eq!((lit["ts"].as_f64(), lit["dur"].as_f64()), (Some(3000.0), Some(2000.0)));
    }
}
