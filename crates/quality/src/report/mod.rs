//! Results of a measurement: data, a table, a page, and bounds to check them.

mod bounds;
mod data;
#[cfg(test)]
mod fixture;
mod metric;
mod motion_table;
mod page;
mod summary;
mod table;

pub use bounds::{Bound, Bounds};
pub use data::{CaseReport, Cost, Flicker, ImageFiles, Motion, MotionCase, MotionReport, Moving, Report};
pub use metric::{METRICS, Metric, metric};
pub use motion_table::{motion_markdown, motion_table};
pub use page::page;
pub use summary::{CaseComparison, compare_cases, deviation, mean, metrics_with_values, techniques, worst};
pub use table::table;
