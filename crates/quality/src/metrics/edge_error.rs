//! Errors of soft edges.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::samples::{Samples, is_disconnected};

/// Range of the soft reference in penumbras, neither fully dark nor fully lit.
pub const PENUMBRA: Range<f32> = 0.02..0.98;

/// Difference of visibility and soft reference in penumbras.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EdgeError {
    /// Number of receivers in a penumbra.
    pub penumbra: usize,
    /// The root of the mean squared difference over them, 0 to 1; 0 if there are none.
    pub rmse: f64,
    /// Number of crossings where both widths were measured.
    pub crossings: usize,
    /// Number of crossings where the reference has a width and the visibility has none.
    pub unmeasured: usize,
    /// Sum of the measured 10-90 % widths divided by that of the reference: 1 is ideal, above 1 too soft. `None` without
    /// crossings.
    pub width_ratio: Option<f64>,
}

/// Measures the edges; `None` without a soft reference.
///
/// Penumbras are receivers with soft truth in [`PENUMBRA`]. Widths are taken along the image's rows and
/// columns, each cut into runs of receivers on one piece of surface. At every place in a run where soft truth
/// crosses 1/2, its width is the way between where it is 0.1 and 0.9 around there, linear between pixels. The
/// measured width is that of the nearest crossing of visibility in the same direction in the run. There is no
/// width if, on the way to 0.9, the value falls below 1/4 or the run ends (or rises above 3/4 on the way to
/// 0.1). Crossings where the truth has no width do not count. A hard edge has a width of 0.8 pixels. A
/// slanted edge is wider along a row but crossed by fewer, so every metre of edge weighs the same, and the
/// slant drops out of the ratio.
#[must_use]
pub fn edge_error(samples: &Samples<'_>) -> Option<EdgeError> {
    let soft_truth = samples.images.soft_truth?;
    let mut result = EdgeError::default();
    let mut squared = 0.0;
    for pixel in samples.receivers().filter(|&pixel| soft_truth[pixel] > PENUMBRA.start) {
        if soft_truth[pixel] < PENUMBRA.end {
            result.penumbra += 1;
            squared += f64::from(samples.images.visibility[pixel] - soft_truth[pixel]).powi(2);
        }
    }
    result.rmse = (squared / result.penumbra.max(1) as f64).sqrt();
    let mut widths_px = [0.0, 0.0];
    let rows = (0..samples.height).map(|y| Vec::from_iter(y * samples.width..(y + 1) * samples.width));
    let columns = (0..samples.width).map(|x| Vec::from_iter((x..samples.len()).step_by(samples.width)));
    for line in rows.chain(columns) {
        for run in
            line.chunk_by(|&a, &b| continues_run(samples, a, b)).filter(|run| samples.is_receiver(run[0]))
        {
            let truth: Vec<f32> = run.iter().map(|&pixel| soft_truth[pixel]).collect();
            let measured: Vec<f32> = run.iter().map(|&pixel| samples.images.visibility[pixel]).collect();
            add_widths(&truth, &measured, &mut widths_px, &mut result);
        }
    }
    result.width_ratio = (widths_px[0] > 0.0).then(|| widths_px[1] / widths_px[0]);
    Some(result)
}

fn continues_run(samples: &Samples<'_>, a: usize, b: usize) -> bool {
    samples.is_receiver(a) && samples.is_receiver(b) && !is_disconnected(samples, a, b)
}

/// Adds the reference and the measured width at each crossing of a run.
fn add_widths(truth: &[f32], measured: &[f32], widths_px: &mut [f64; 2], result: &mut EdgeError) {
    for at in 0..truth.len().saturating_sub(1) {
        let Some(rising) = crosses(truth, at) else { continue };
        let Some(true_px) = width_px(truth, at, rising) else { continue };
        let nearest = nearest_crossing(measured, at, rising);
        match nearest.and_then(|at| width_px(measured, at, rising)) {
            Some(measured_px) => {
                result.crossings += 1;
                widths_px[0] += f64::from(true_px);
                widths_px[1] += f64::from(measured_px);
            }
            None => result.unmeasured += 1,
        }
    }
}

/// Returns whether values cross 1/2 upwards (or downwards) between an index and the next; `None` if neither.
fn crosses(values: &[f32], at: usize) -> Option<bool> {
    let [low, high] = [values[at] < 0.5, values[at + 1] < 0.5];
    (low != high).then_some(low)
}

fn nearest_crossing(values: &[f32], at: usize, rising: bool) -> Option<usize> {
    let matches = |at: &usize| crosses(values, *at) == Some(rising);
    let ahead = (at..values.len() - 1).find(matches);
    let behind = (0..at).rev().find(matches);
    match (ahead, behind) {
        (Some(ahead), Some(behind)) => Some(if ahead - at <= at - behind { ahead } else { behind }),
        (ahead, behind) => ahead.or(behind),
    }
}

/// Returns the 10-90 % width of the transition that crosses 1/2 between an index and the next.
fn width_px(values: &[f32], at: usize, rising: bool) -> Option<f32> {
    let (before, after) = values.split_at(at + 1);
    let (before, after) = (before.iter().rev().copied(), after.iter().copied());
    let (first, second) = (values[at], values[at + 1]);
    // Both ways lead away from one half: upwards unchanged, downwards mirrored at 1/2.
    let [up, down] = if rising {
        [rise_px(first, after), rise_px(1.0 - second, before.map(|value| 1.0 - value))]
    } else {
        [rise_px(second, before), rise_px(1.0 - first, after.map(|value| 1.0 - value))]
    };
    // Both begin at the other one's first pixel, so the pixel between is in both.
    Some(up? + down? - 1.0)
}

/// Returns the distance in pixels, from the pixel with the value `from`, to where values reach 0.9; `None` if they
/// fall below 1/4 before.
fn rise_px(from: f32, values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut last = from;
    for (steps, value) in values.enumerate() {
        if value >= 0.9 {
            return Some(steps as f32 + (0.9 - last) / (value - last));
        }
        if value < 0.25 {
            return None;
        }
        last = value;
    }
    None
}
