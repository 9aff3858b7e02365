//! What a measurement found: data, a table, a page, and bounds that it is checked against.

mod bounds;
mod data;
#[cfg(test)]
mod fixture;
mod metric;
mod page;
mod summary;
mod table;

pub use bounds::{Bound, Bounds};
pub use data::{CaseReport, Cost, Flicker, ImageFiles, Motion, Report};
pub use metric::{METRICS, Metric, metric};
pub use page::page;
pub use summary::{Compared, compared, mean, measured, off, techniques, worst};
pub use table::table;
