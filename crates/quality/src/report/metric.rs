//! The metrics of a case that tables show and bounds limit.

use super::data::{CaseReport, Flicker, Motion};

/// A number of a case.
pub struct Metric {
    /// Name in bounds files.
    pub name: &'static str,
    /// Heading of the column, two short lines.
    pub heading: [&'static str; 2],
    /// Description in one sentence.
    pub description: &'static str,
    /// Number of decimals in tables.
    pub decimals: usize,
    /// Returns the value of a case, if measured.
    pub value: fn(&CaseReport) -> Option<f64>,
}

/// All metrics, in the order of tables. Lower is better, except for `edge_width_ratio`, whose best value is 1.
pub const METRICS: &[Metric] = &[
    Metric {
        name: "misclassified_percent",
        heading: ["misclas-", "sified %"],
        description: "Misclassified receivers outside the band, percent.",
        decimals: 3,
        value: |case| Some(case.errors.misclassified.outside.misclassified_percent),
    },
    Metric {
        name: "leak_percent",
        heading: ["leak", "%"],
        description: "Receivers outside the band that are lit but should be dark, percent.",
        decimals: 3,
        value: |case| Some(case.errors.misclassified.outside.leak_percent),
    },
    Metric {
        name: "acne_pixels",
        heading: ["acne", "px"],
        description: "Receivers outside the band with N·L above 0.1 that are dark but should be lit.",
        decimals: 0,
        value: |case| Some(acne_pixels(case) as f64),
    },
    Metric {
        name: "misclassified_total_percent",
        heading: ["misclas.", "total %"],
        description: "Misclassified receivers including the band, percent.",
        decimals: 2,
        value: |case| Some(case.errors.misclassified.total.misclassified_percent),
    },
    Metric {
        name: "mean_error_percent",
        heading: ["mean", "error %"],
        description: "Mean difference of visibility and reference over receivers outside the band, percent.",
        decimals: 3,
        value: |case| Some(case.errors.mean_error.outside_percent),
    },
    Metric {
        name: "missing_contacts_percent",
        heading: ["missing", "cont. %"],
        description: "Lit receivers among those that should be dark and whose blocker is nearer than 25 cm, percent.",
        decimals: 1,
        value: |case| {
            let missing = &case.errors.missing_contacts;
            (missing.contacts > 0).then_some(missing.missing_percent)
        },
    },
    Metric {
        name: "peter_panning_texels",
        heading: ["peter-p.", "texels"],
        description: "Mean distance from contacts to the first shadowed pixel, shadow texels.",
        decimals: 2,
        value: |case| {
            let texels = &case.errors.peter_panning.texels;
            (texels.count > 0).then_some(texels.mean)
        },
    },
    Metric {
        name: "peter_panning_cm",
        heading: ["peter-p.", "cm"],
        description: "Mean distance from contacts to the first shadowed pixel, centimetres.",
        decimals: 2,
        value: |case| {
            let cm = &case.errors.peter_panning.cm;
            (cm.count > 0).then_some(cm.mean)
        },
    },
    Metric {
        name: "edge_rmse",
        heading: ["edge", "RMSE"],
        description: "Root mean square difference of visibility and soft reference in penumbras, 0 to 1.",
        decimals: 2,
        value: |case| case.edges.filter(|edges| edges.penumbra > 0).map(|edges| edges.rmse),
    },
    Metric {
        name: "edge_width_ratio",
        heading: ["edge", "width"],
        description: "10-90 % width of edges divided by that of the soft reference: 1 is ideal, above 1 too soft.",
        decimals: 1,
        value: |case| case.edges.and_then(|edges| edges.width_ratio),
    },
    Metric {
        name: "seam",
        heading: ["seam", "mean"],
        description: "Mean difference of two cascades at points along their border, 0 to 1.",
        decimals: 3,
        value: |case| case.seam.map(|seam| seam.mean),
    },
    Metric {
        name: "flicker",
        heading: ["flicker", "p99"],
        description: "99th percentile of the change of visibility from frame to frame while the camera moves and turns, \
                0 to 1; the worst motion, at the origin and 10 km away.",
        decimals: 3,
        value: |case| worst(case.flicker.iter().filter(|flicker| flicker.motion != Motion::Zoom)),
    },
    Metric {
        name: "flicker_zoom",
        heading: ["zoom", "p99"],
        description: "99th percentile of the change of visibility while the camera zooms, 0 to 1.",
        decimals: 3,
        value: |case| worst(case.flicker.iter().filter(|flicker| flicker.motion == Motion::Zoom)),
    },
    Metric {
        name: "gpu_ms",
        heading: ["GPU", "ms"],
        description: "GPU time of the shadow passes, milliseconds.",
        decimals: 2,
        value: |case| case.cost.and_then(|cost| cost.gpu_ms),
    },
    Metric {
        name: "texture_mib",
        heading: ["maps", "MiB"],
        description: "Size of all textures that the technique's passes write, MiB.",
        decimals: 1,
        value: |case| case.cost.map(|cost| cost.texture_bytes as f64 / f64::from(1 << 20)),
    },
    Metric {
        name: "draws",
        heading: ["caster", "draws"],
        description: "Draws of casters per frame.",
        decimals: 0,
        value: |case| case.cost.map(|cost| cost.draws as f64),
    },
    Metric {
        name: "triangles",
        heading: ["tri-", "angles"],
        description: "Triangles of casters drawn per frame.",
        decimals: 0,
        value: |case| Some(case.cost?.triangles? as f64),
    },
    Metric {
        name: "pages",
        heading: ["pages", ""],
        description: "Pages of virtual shadow maps that a frame needs.",
        decimals: 0,
        value: |case| Some(case.cost?.pages? as f64),
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
