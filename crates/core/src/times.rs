//! How long passes took, as plain data.

use serde::Serialize;

/// The time of one pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassTime {
    /// The pass, with its nodes before its name.
    pub pass: String,
    /// The node it belongs to; empty for none.
    pub node: String,
    /// Milliseconds that the pass's body took on the CPU; 0 for a pass without one.
    pub cpu_ms: f64,
    /// Milliseconds on the GPU; `None` where the device cannot tell, see `Timer`.
    pub gpu_ms: Option<f64>,
    /// How many passes `gpu_ms` is the time of: 1, or more where passes were merged and the device cannot tell them
    /// apart. Each of them then shows the same time.
    pub shared_by: u32,
}
