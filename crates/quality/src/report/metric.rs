//! The numbers of a case that tables show and bounds hold, by name.

use super::data::{CaseReport, Flicker, Motion};

/// A number of a case.
pub struct Metric {
    /// What bounds and tools call it.
    pub name: &'static str,
    /// Its column's heading, two short lines.
    pub heading: [&'static str; 2],
    /// What it is, in a sentence.
    pub about: &'static str,
    /// How many decimals tables give it.
    pub decimals: usize,
    /// Its value, if it was measured.
    pub of: fn(&CaseReport) -> Option<f64>,
}

/// All of them, in the order of tables. Of all, less is better, but of `edge_width_ratio`, where 1 is right.
pub const METRICS: &[Metric] = &[
    Metric {
        name: "misclassified_percent",
        heading: ["wrong", "%"],
        about: "Receivers outside the band whose visibility is on the wrong side of one half, percent.",
        decimals: 3,
        of: |case| Some(case.errors.misclassified.outside.misclassified_percent),
    },
    Metric {
        name: "leak_percent",
        heading: ["leak", "%"],
        about: "Receivers outside the band that are lit but truly dark, percent.",
        decimals: 3,
        of: |case| Some(case.errors.misclassified.outside.leak_percent),
    },
    Metric {
        name: "acne_pixels",
        heading: ["acne", "px"],
        about: "Receivers outside the band with N·L above 0.1 that are dark but truly lit.",
        decimals: 0,
        of: |case| Some(acne_pixels(case) as f64),
    },
    Metric {
        name: "misclassified_total_percent",
        heading: ["total", "%"],
        about: "Receivers on the wrong side of one half, those in the band too, percent.",
        decimals: 2,
        of: |case| Some(case.errors.misclassified.total.misclassified_percent),
    },
    Metric {
        name: "mean_error_percent",
        heading: ["mean", "err %"],
        about: "Mean difference of visibility and truth over receivers outside the band, percent.",
        decimals: 3,
        of: |case| Some(case.errors.mean_error.outside_percent),
    },
    Metric {
        name: "missing_contacts_percent",
        heading: ["missing", "cont %"],
        about: "Of truly dark receivers whose blocker is nearer than 25 cm, the lit ones, percent.",
        decimals: 1,
        of: |case| {
            let missing = &case.errors.missing_contacts;
            (missing.contacts > 0).then_some(missing.missing_percent)
        },
    },
    Metric {
        name: "peter_panning_texels",
        heading: ["detach", "texels"],
        about: "Mean way from contacts to the first shadowed pixel, shadow texels.",
        decimals: 2,
        of: |case| {
            let texels = &case.errors.peter_panning.texels;
            (texels.count > 0).then_some(texels.mean)
        },
    },
    Metric {
        name: "peter_panning_cm",
        heading: ["detach", "cm"],
        about: "Mean way from contacts to the first shadowed pixel, centimetres.",
        decimals: 2,
        of: |case| {
            let cm = &case.errors.peter_panning.cm;
            (cm.count > 0).then_some(cm.mean)
        },
    },
    Metric {
        name: "edge_rmse",
        heading: ["edge", "rmse"],
        about: "Root mean square difference of visibility and soft truth inside penumbras, 0 to 1.",
        decimals: 2,
        of: |case| case.edges.filter(|edges| edges.penumbra > 0).map(|edges| edges.rmse),
    },
    Metric {
        name: "edge_width_ratio",
        heading: ["edge", "width"],
        about: "10-90 % width of edges over that of soft truth: 1 is right, above 1 too soft.",
        decimals: 1,
        of: |case| case.edges.and_then(|edges| edges.width_ratio),
    },
    Metric {
        name: "seam",
        heading: ["seam", "mean"],
        about: "Mean difference of two cascades at points along their border, 0 to 1.",
        decimals: 3,
        of: |case| case.seam.map(|seam| seam.mean),
    },
    Metric {
        name: "flicker",
        heading: ["flicker", "p99"],
        about: "99th percentile of the change of visibility from frame to frame while the camera moves and turns, \
                0 to 1; the worst motion, at the origin and 10 km away.",
        decimals: 3,
        of: |case| worst(case.flicker.iter().filter(|flicker| flicker.motion != Motion::Zoom)),
    },
    Metric {
        name: "flicker_zoom",
        heading: ["zoom", "p99"],
        about: "The same while the camera zooms.",
        decimals: 3,
        of: |case| worst(case.flicker.iter().filter(|flicker| flicker.motion == Motion::Zoom)),
    },
    Metric {
        name: "gpu_ms",
        heading: ["GPU", "ms"],
        about: "The GPU's time for the shadow passes, milliseconds.",
        decimals: 2,
        of: |case| case.cost.and_then(|cost| cost.gpu_ms),
    },
    Metric {
        name: "texture_mib",
        heading: ["maps", "MiB"],
        about: "All textures that the technique's passes write, MiB.",
        decimals: 1,
        of: |case| case.cost.map(|cost| cost.texture_bytes as f64 / f64::from(1 << 20)),
    },
    Metric {
        name: "draws",
        heading: ["caster", "draws"],
        about: "Draws of casters in a frame.",
        decimals: 0,
        of: |case| case.cost.map(|cost| cost.draws as f64),
    },
    Metric {
        name: "triangles",
        heading: ["tri-", "angles"],
        about: "Triangles of casters drawn in a frame.",
        decimals: 0,
        of: |case| case.cost.map(|cost| cost.triangles as f64),
    },
];

/// Earlier names of metrics, which files of bounds may still use.
const OLD_NAMES: [(&str, &str); 5] = [
    ("wrong_percent", "misclassified_percent"),
    ("wrong_total_percent", "misclassified_total_percent"),
    ("lost_contacts_percent", "missing_contacts_percent"),
    ("detachment_texels", "peter_panning_texels"),
    ("detachment_cm", "peter_panning_cm"),
];

/// Returns a metric by its name.
#[must_use]
pub fn metric(name: &str) -> Option<&'static Metric> {
    let name = OLD_NAMES.iter().find(|(old, _)| *old == name).map_or(name, |(_, name)| name);
    METRICS.iter().find(|metric| metric.name == name)
}

fn acne_pixels(case: &CaseReport) -> usize {
    let bins = &case.errors.misclassified.outside.acne_by_n_dot_l;
    bins.iter().filter(|bin| bin.n_dot_l_above >= 0.1).map(|bin| bin.acne).sum()
}

fn worst<'a>(flickers: impl Iterator<Item = &'a Flicker>) -> Option<f64> {
    flickers
        .filter(|flicker| flicker.change.count > 0)
        .map(|flicker| flicker.change.p99)
        .max_by(f64::total_cmp)
}
