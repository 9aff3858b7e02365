//! The files of the built-in pipelines.

/// Names and files, the default first.
const FILES: &[(&str, &str)] = &[
    ("forward", include_str!("../../pipelines/forward.ron")),
    ("forward_plus", include_str!("../../pipelines/forward_plus.ron")),
    ("deferred", include_str!("../../pipelines/deferred.ron")),
    ("screen_shadows", include_str!("../../pipelines/screen_shadows.ron")),
    ("minimal", include_str!("../../pipelines/minimal.ron")),
    ("debug_cascades", include_str!("../../pipelines/debug_cascades.ron")),
];

/// The names of the built-in pipelines, the default first.
pub const BUILT_IN: &[&str] =
    &["forward", "forward_plus", "deferred", "screen_shadows", "minimal", "debug_cascades"];

/// Returns the name and the text of a built-in pipeline.
pub(super) fn find(name: &str) -> Option<(&'static str, &'static str)> {
    FILES.iter().find(|(known, _)| *known == name).copied()
}
