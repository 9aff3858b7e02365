//! Reports for tests.

use super::data::{CaseReport, Cost, Flicker, ImageFiles, Motion, Report};
use crate::ViewErrors;
use crate::metrics::{
    EdgeError, MeanError, Misclassified, MissingContacts, N_DOT_L_BINS, PeterPanning, Summary,
};
use shadowgraph_shadows::ShadowSettings;

/// Returns a report with a case for each technique and percentage of misclassified pixels, with all other values present.
pub(super) fn report(cases: &[(&str, f64)]) -> Report {
    Report {
        version: Report::VERSION,
        adapter: "llvmpipe".into(),
        size_px: [640, 360],
        settings: ShadowSettings::default(),
        variants: Vec::new(),
        cases: cases.iter().enumerate().map(|(index, &(name, wrong))| case(index, name, wrong)).collect(),
    }
}

fn case(index: usize, technique: &str, misclassified_percent: f64) -> CaseReport {
    let some = Summary { count: 10, mean: 0.5, p99: 0.75 };
    let flicker = |motion, far_out| Flicker { motion, far_out, change: some };
    CaseReport {
        scene: "tower".into(),
        light: "sun 15".into(),
        view: format!("view {index}"),
        technique: technique.into(),
        errors: errors(misclassified_percent, some),
        edges: Some(EdgeError {
            penumbra: 9,
            rmse: 0.25,
            crossings: 3,
            unmeasured: 0,
            width_ratio: Some(1.5),
        }),
        seam: Some(some),
        flicker: vec![flicker(Motion::Translate, true), flicker(Motion::Zoom, false)],
        cost: Some(Cost {
            gpu_ms: Some(1.25),
            texture_bytes: 64 << 20,
            draws: 20,
            triangles: Some(123_456),
            pages: None,
        }),
        images: Some(ImageFiles {
            color: format!("images/{index}/image.png"),
            truth: format!("images/{index}/truth.png"),
            visibility: format!("images/{index}/visibility.png"),
            difference: format!("images/{index}/difference.png"),
        }),
    }
}

fn errors(misclassified_percent: f64, some: Summary) -> ViewErrors {
    let mut misclassified = Misclassified::default();
    misclassified.outside.misclassified_percent = misclassified_percent;
    for (bin, above) in misclassified.outside.acne_by_n_dot_l.iter_mut().zip(N_DOT_L_BINS) {
        bin.n_dot_l_above = above;
    }
    ViewErrors {
        misclassified,
        mean_error: MeanError::default(),
        missing_contacts: MissingContacts { contacts: 40, missing: 10, missing_percent: 25.0 },
        peter_panning: PeterPanning { cm: some, texels: some, missing: 0 },
    }
}
