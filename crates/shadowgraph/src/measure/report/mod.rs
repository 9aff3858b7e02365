//! What a measurement found: data, a table, a page, and bounds that it is checked against.

mod data;
mod metric;

pub use data::{CaseReport, Cost, Flicker, Motion, PictureFiles, Report};
pub use metric::{METRICS, Metric, metric};
