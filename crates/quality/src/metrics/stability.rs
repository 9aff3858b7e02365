//! Change of visibility from frame to frame, beyond that of the reference.

use serde::{Deserialize, Serialize};

use super::samples::{MetricsError, check_fractions, check_length};
use super::visibility::Summary;

/// The least change of visibility that counts as a changed pixel.
pub const CHANGE: f32 = 0.03;

/// Change of shadows along a path of frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Of each point, the sum of all |changes of visibility| minus that of the reference, at least 0, per step from one frame to the
    /// next, 0 to 1. A shadow edge that passes once counts nothing, however soft it is; one that goes back and forth does.
    pub excess: Summary,
    /// Points whose visibility changes by more than [`CHANGE`] in a step; the mean over the steps.
    pub changed: f64,
    /// The same of the reference.
    pub truth_changed: f64,
    /// The same of the hard reference: that of the light's centre alone.
    pub hard_changed: f64,
}

impl Stability {
    /// Returns `changed` relative to the reference; `None` where the reference does not change.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        (self.truth_changed > 0.0).then(|| self.changed / self.truth_changed)
    }
}

/// References of points along a path: lists of points, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truths {
    /// The visible fraction of the light.
    pub soft: Vec<Vec<f32>>,
    /// Visibility of the light's centre.
    pub hard: Vec<Vec<f32>>,
}

/// Compares how the visibilities of points change with how their references do. `frames` are lists of points, frame by frame. Also
/// returns the excess of each point.
///
/// # Errors
/// - [`MetricsError::Length`]: the numbers of frames and truths differ, or frames have different numbers of points.
/// - [`MetricsError::Value`]: a number is not from 0 to 1.
pub fn stability(frames: &[Vec<f32>], truths: &Truths) -> Result<(Stability, Vec<f32>), MetricsError> {
    let points = frames.first().map_or(0, Vec::len);
    for (name, list) in [("frames", frames), ("soft", &truths.soft[..]), ("hard", &truths.hard[..])] {
        check_length(name, list.len(), frames.len())?;
        for frame in list {
            check_length(name, frame.len(), points)?;
            check_fractions(name, frame)?;
        }
    }
    let steps = frames.len().saturating_sub(1).max(1);
    let ((ours, changed), (theirs, truth_changed)) = (variation(frames), variation(&truths.soft));
    let excess: Vec<f32> =
        ours.iter().zip(&theirs).map(|(ours, theirs)| (ours - theirs).max(0.0) / steps as f32).collect();
    let per_step = |count: usize| count as f64 / steps as f64;
    let stability = Stability {
        excess: Summary::new(&excess),
        changed: per_step(changed),
        truth_changed: per_step(truth_changed),
        hard_changed: per_step(variation(&truths.hard).1),
    };
    Ok((stability, excess))
}

/// Returns the sum of all |changes| of each point, and how many of all are more than [`CHANGE`].
fn variation(frames: &[Vec<f32>]) -> (Vec<f32>, usize) {
    let mut sums = vec![0.0; frames.first().map_or(0, Vec::len)];
    let mut changed = 0;
    for pair in frames.windows(2) {
        for (sum, (before, after)) in sums.iter_mut().zip(pair[0].iter().zip(&pair[1])) {
            let change = (after - before).abs();
            *sum += change;
            changed += usize::from(change > CHANGE);
        }
    }
    (sums, changed)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn both(soft: &[Vec<f32>]) -> Truths {
        Truths { soft: soft.to_vec(), hard: soft.to_vec() }
    }

    #[test]
    fn a_wide_penumbra_changes_more_points_than_the_hard_edge_of_the_same_light() {
        // An edge that moves by one point in each step, with a penumbra of four.
        let soft =
            |frame: usize| (0..20).map(|x| ((x as f32 - frame as f32 - 3.0) / 4.0).clamp(0.0, 1.0)).collect();
        let hard = |frame: usize| (0..20).map(|x| f32::from(x > frame + 5)).collect();
        let truths = Truths { soft: (0..9).map(soft).collect(), hard: (0..9).map(hard).collect() };
        let (stability, excess) = stability(&truths.soft, &truths).unwrap();
        assert_eq!((stability.changed, stability.truth_changed, stability.hard_changed), (4.0, 4.0, 1.0));
        assert_eq!((stability.ratio(), excess.iter().sum::<f32>()), (Some(1.0), 0.0));
    }

    #[test]
    fn a_soft_edge_that_passes_once_has_no_excess_and_changes_more_points() {
        // Of four points, the reference flips one in each step, the technique ramps over two.
        let truths: Vec<Vec<f32>> = vec![vec![1.0; 4], vec![0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]];
        let frames: Vec<Vec<f32>> =
            vec![vec![0.5, 1.0, 1.0, 1.0], vec![0.0, 0.5, 1.0, 1.0], vec![0.0, 0.0, 0.5, 1.0]];
        let (stability, excess) = stability(&frames, &both(&truths)).unwrap();
        // The third point is still on its way.
        assert_eq!(excess, [0.0, 0.0, 0.25, 0.0]);
        assert_eq!((stability.changed, stability.truth_changed, stability.ratio()), (2.0, 1.0, Some(2.0)));
    }

    #[test]
    fn a_point_that_flickers_counts_each_time() {
        let truths = vec![vec![1.0, 0.0]; 5];
        let flickering = |on: f32| vec![on, 0.0];
        let frames: Vec<Vec<f32>> = [1.0, 0.75, 1.0, 0.75, 1.0].into_iter().map(flickering).collect();
        let (stability, excess) = stability(&frames, &both(&truths)).unwrap();
        assert_eq!(excess, [0.25, 0.0]);
        assert_eq!((stability.excess.mean, stability.excess.p99), (0.125, 0.25));
        assert_eq!((stability.changed, stability.truth_changed, stability.ratio()), (1.0, 0.0, None));
    }

    #[test]
    fn lists_of_different_lengths_are_refused() {
        assert!(stability(&[vec![1.0]], &Truths::default()).is_err());
        assert!(stability(&[vec![1.0]], &Truths { hard: Vec::new(), ..both(&[vec![1.0]]) }).is_err());
        assert!(stability(&[vec![1.0], vec![1.0, 0.0]], &both(&[vec![1.0], vec![1.0]])).is_err());
        assert!(stability(&[vec![1.5]], &both(&[vec![1.0]])).is_err());
        assert_eq!(stability(&[], &both(&[])).unwrap().0, Stability::default());
    }
}
