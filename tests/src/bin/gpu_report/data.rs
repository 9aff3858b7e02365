//! The figures of a report.

use serde::Serialize;
use shadowgraph::core::TimeSummary;
use shadowgraph::wgpu::AdapterInfo;
use shadowgraph_quality::bench::Stats;

/// All that is measured on one adapter.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    /// The version of this format.
    pub(crate) version: u32,
    pub(crate) adapter: AdapterData,
    pub(crate) size_px: [u32; 2],
    pub(crate) scenes: Vec<SceneData>,
    pub(crate) graph: Vec<GraphCost>,
    /// `None` if they were left out.
    pub(crate) pixel_tests: Option<PixelTests>,
}

impl Report {
    /// Creates a report without figures.
    pub(crate) fn new(adapter: AdapterData, size_px: [u32; 2]) -> Self {
        Self { version: 1, adapter, size_px, scenes: Vec::new(), graph: Vec::new(), pixel_tests: None }
    }
}

/// What was measured on.
#[derive(Debug, Serialize)]
pub(crate) struct AdapterData {
    pub(crate) name: String,
    pub(crate) backend: String,
    pub(crate) device_type: String,
    pub(crate) driver: String,
    pub(crate) processors: usize,
}

impl AdapterData {
    pub(crate) fn new(adapter: &AdapterInfo) -> Self {
        Self {
            name: adapter.name.clone(),
            backend: adapter.backend.to_string(),
            device_type: format!("{:?}", adapter.device_type),
            driver: format!("{} {}", adapter.driver, adapter.driver_info).trim().to_owned(),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

/// A scene, drawn with each technique.
#[derive(Debug, Serialize)]
pub(crate) struct SceneData {
    pub(crate) name: String,
    pub(crate) instances: usize,
    /// Those of all instances.
    pub(crate) triangles: usize,
    pub(crate) lights: usize,
    pub(crate) techniques: Vec<TechniqueData>,
    /// What was not measured, and why.
    pub(crate) left_out: Vec<String>,
}

/// A technique in one scene.
#[derive(Debug, Serialize)]
pub(crate) struct TechniqueData {
    pub(crate) technique: String,
    pub(crate) pipeline: String,
    /// From the beginning of a frame until the GPU has finished it.
    pub(crate) frame_ms: Stats,
    /// Processor time of the thread that draws a frame.
    pub(crate) thread_ms: Stats,
    pub(crate) passes: Vec<TimeSummary>,
}

impl TechniqueData {
    /// Returns the GPU time of all passes, if the device can measure it.
    pub(crate) fn gpu_ms(&self) -> Option<f64> {
        self.passes.iter().filter_map(TimeSummary::gpu_share_ms).reduce(|a, b| a + b)
    }
}

/// The processor time of frames of the graph, relative to the same frames by hand, on this adapter's driver.
#[derive(Debug, Serialize)]
pub(crate) struct GraphCost {
    pub(crate) passes: usize,
    pub(crate) by_hand_us: f64,
    /// Multiples of the time by hand, medians of pairs.
    pub(crate) unchanged: f64,
    pub(crate) changed: f64,
}

/// Results of the pixel tests.
#[derive(Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct PixelTests {
    pub(crate) passed: usize,
    /// The names of those that failed, with the line that says why.
    pub(crate) failed: Vec<(String, String)>,
    /// The lines of those that could not run.
    pub(crate) skipped: Vec<String>,
}
