//! Where receivers are, in steps.

use glam::DAffine3;
use shadowgraph_scene::{Aabb, BoundingSphere, Camera, Projection};

/// Number of steps per factor of two of the distances between which receivers are.
const DISTANCE_STEPS: f64 = 4.0;

/// Number of steps per factor of two of the radius around all receivers.
const RADIUS_STEPS: f64 = 8.0;

/// Number of frames for which a distance is kept that is a step off.
const SPARE_FRAMES: u32 = 60;

/// The distances from the camera between which receivers are. When the bounds change, they are those of a fresh start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverRange {
    /// The bounds of all receivers.
    pub bounds: Aabb,
    /// The distance at which they begin; 0 for a camera within their bounds.
    pub begin: SteppedDistance,
    /// The distance at which they end; infinite if there are none.
    pub end: SteppedDistance,
    /// The slices that are skipped in front of the first cascade; `None` before the first frame.
    pub skipped: Option<SkippedSlices>,
}

impl Default for ReceiverRange {
    fn default() -> Self {
        let [begin, end] = [SteppedDistance::default(); 2];
        Self { bounds: Aabb::EMPTY, begin, end, skipped: None }
    }
}

impl ReceiverRange {
    /// Returns the range of receivers with these bounds, in the frame after that of `self`.
    pub(crate) fn next(self, bounds: Aabb, camera: &Camera) -> Self {
        let previous = if bounds == self.bounds { self } else { Self::default() };
        let eye = camera.position_world();
        let (nearest_m, farthest_m) = if bounds.is_empty() {
            (0.0, f64::INFINITY)
        } else {
            let corners = bounds.corners().map(|corner| corner.distance(eye));
            let nearest = eye.clamp(bounds.min, bounds.max);
            (nearest.distance(eye), corners.into_iter().fold(0.0, f64::max))
        };
        let (begin, end) = (previous.begin.at_most(nearest_m), previous.end.at_least(farthest_m));
        Self { bounds, begin, end, skipped: self.skipped }
    }

    /// Skips that many empty slices in front of the first cascade: fewer than before at once, but more only after a while if the camera moves,
    /// so cascades rarely change as it turns.
    pub(crate) fn skipping(self, count: usize, camera: &Camera) -> Self {
        let world_from_view = camera.world_from_view;
        let keeps = |before: &SkippedSlices| {
            let moves = before.world_from_view != world_from_view;
            moves && before.count < count && before.spare_frames < SPARE_FRAMES
        };
        let (count, spare_frames) = match self.skipped.filter(keeps) {
            Some(before) => (before.count, before.spare_frames + 1),
            None => (count, 0),
        };
        Self { skipped: Some(SkippedSlices { count, spare_frames, world_from_view }), ..self }
    }

    /// Returns the view depth before which an image of this aspect shows no receiver, metres, or that of the near plane if it is farther.
    pub(crate) fn begin_m(&self, camera: &Camera, aspect: f64) -> f64 {
        let Projection::Perspective { near, .. } = camera.projection else { return camera.near() };
        // The corners of the image are farther from the camera than its centre, at the same view depth.
        let corner = camera.slice_corners_view(aspect, 1.0, 2.0)[0];
        near.max(self.begin.distance_m / corner.length())
    }

    /// Returns a sphere around all receivers. Its radius rarely changes as they move.
    pub(crate) fn sphere(&self) -> BoundingSphere {
        let step = (self.bounds.half_extent().length().log2() * RADIUS_STEPS).ceil();
        BoundingSphere { center_world: self.bounds.center(), radius_m: (step / RADIUS_STEPS).exp2() }
    }
}

/// Slices in front of the first cascade in which the view has no receivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkippedSlices {
    /// Their number.
    pub count: usize,
    /// Number of frames for which more could have been skipped.
    pub spare_frames: u32,
    /// The transform of the camera.
    pub world_from_view: DAffine3,
}

/// A distance in steps. It may be off that of a fresh start for some frames, so it does not flip back and forth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteppedDistance {
    /// Metres; 0 before the first frame.
    pub distance_m: f64,
    /// Number of frames for which it has been off.
    pub spare_frames: u32,
}

impl SteppedDistance {
    /// Returns the distance, rounded up to a step, or a step more.
    fn at_least(self, distance_m: f64) -> Self {
        let step = (distance_m.log2() * DISTANCE_STEPS).ceil();
        self.next([step, step + 1.0])
    }

    /// Returns the distance, rounded down to a step, or a step less.
    fn at_most(self, distance_m: f64) -> Self {
        let step = (distance_m.log2() * DISTANCE_STEPS).floor();
        self.next([step, step - 1.0])
    }

    /// Returns the distance of the step that is needed, or that of the other one if it is kept for a while.
    fn next(self, steps: [f64; 2]) -> Self {
        let [needed_m, spare_m] = steps.map(|step| (step / DISTANCE_STEPS).exp2());
        if needed_m != spare_m && self.distance_m == spare_m && self.spare_frames < SPARE_FRAMES {
            return Self { spare_frames: self.spare_frames + 1, ..self };
        }
        Self { distance_m: needed_m, spare_frames: 0 }
    }
}
