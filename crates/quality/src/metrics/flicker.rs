//! Change of shadows while only the camera moves.

use super::error::{check_fractions, check_length};
use super::{MetricsError, Summary};

/// Summarises |change of visibility| (0 to 1) from each frame to the next at a list of world points.
///
/// `frames` has the visibilities of the points frame by frame, `truths` their hard truths. A point whose
/// truth (at 1/2) differs between two frames does not count for that pair. The summary's count is that of
/// points times pairs that count.
///
/// # Errors
/// - [`MetricsError::Length`]: the numbers of frames and truths differ, or frames have different numbers of points.
/// - [`MetricsError::Value`]: a number is not from 0 to 1.
pub fn flicker(frames: &[Vec<f32>], truths: &[Vec<f32>]) -> Result<Summary, MetricsError> {
    check_length("truths", truths.len(), frames.len())?;
    let points = frames.first().map_or(0, Vec::len);
    for (list, frame) in frames.iter().map(|f| ("frames", f)).chain(truths.iter().map(|t| ("truths", t))) {
        check_length(list, frame.len(), points)?;
        check_fractions(list, frame)?;
    }
    let mut changes = Vec::with_capacity(points * frames.len().saturating_sub(1));
    for (frame, truth) in frames.windows(2).zip(truths.windows(2)) {
        let stays = |point: &usize| (truth[0][*point] < 0.5) == (truth[1][*point] < 0.5);
        changes.extend((0..points).filter(stays).map(|point| (frame[1][point] - frame[0][point]).abs()));
    }
    Ok(Summary::new(&changes))
}
