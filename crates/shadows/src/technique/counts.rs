//! Numbers that the GPU finds while it draws shadows.

use std::ops::Range;
use std::sync::Arc;

use shadowgraph_core::Buffer;

/// Numbers that a technique's passes write in a frame. A technique [publishes](shadowgraph_core::Frame::publish) them; they are read back
/// once the frame is submitted, for whoever wants to see them.
#[derive(Clone)]
pub struct ShadowCounts {
    /// What each number counts, in words for a table.
    pub names: &'static [&'static str],
    /// The buffer that has the numbers.
    pub buffer: Buffer,
    /// The bytes of the numbers: a `u32` for each name.
    pub bytes: Range<u64>,
    /// Returns what users should know about the numbers: that a limit of the settings makes shadows worse.
    pub warning: CountWarning,
}

impl ShadowCounts {
    /// The name of the number of pages that the frame needs.
    pub const PAGES: &str = "pages needed";
    /// The name of the number of casters drawn, each once for every page that it is drawn into.
    pub const CASTERS: &str = "casters drawn into pages";
}

/// A warning that depends on numbers.
pub type CountWarning = Arc<dyn Fn(&[u32]) -> Option<String> + Send + Sync>;
