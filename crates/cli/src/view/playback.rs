//! The time of the scene's animations, which plays, stands or is set by hand.

use shadowgraph::scene::{AnimationSelection, EditError, Hierarchy, Scene};

/// The state of the playback of animations. They start again when the last one has ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Playback {
    pub(super) selection: AnimationSelection,
    /// The time that is shown, seconds.
    pub(super) time_s: f64,
    pub(super) is_playing: bool,
    /// Seconds of the animations per second; negative values play backwards.
    pub(super) speed: f64,
    /// What the scene shows.
    shown: Option<(AnimationSelection, f64)>,
}

impl Playback {
    /// Creates a playback that plays from a time on.
    pub(super) fn new(selection: AnimationSelection, time_s: f64) -> Self {
        Self { selection, time_s, is_playing: true, speed: 1.0, shown: None }
    }

    /// Advances the time, which starts again after the animations and `tracks_end_s`.
    pub(super) fn advance(&mut self, hierarchy: &Hierarchy, tracks_end_s: f64, seconds: f64) {
        let end_s = f64::from(hierarchy.end_s(self.selection)).max(tracks_end_s);
        if self.is_playing && end_s > 0.0 {
            self.time_s = (self.time_s + seconds * self.speed).rem_euclid(end_s);
        }
    }

    /// Moves a scene, and the copy of it that is drawn, to the time if they do not show it yet.
    pub(super) fn apply<'s>(
        &mut self,
        scenes: impl IntoIterator<Item = &'s mut Scene>,
    ) -> Result<(), EditError> {
        let wanted = Some((self.selection, self.time_s));
        if self.shown == wanted {
            return Ok(());
        }
        self.shown = wanted;
        scenes.into_iter().try_for_each(|scene| scene.set_time(self.selection, self.time_s))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use shadowgraph::scene::animation::{Animation, Channel, Curve, Interpolation, Property};

    fn hierarchy() -> Hierarchy {
        let curve = Curve::new(vec![0.0, 2.0], vec![0.0; 6], 3, Interpolation::Linear).unwrap();
        let channels = vec![Channel { node: 0, property: Property::Scale, curve }];
        Hierarchy { animations: vec![Animation { name: None, channels }], ..Hierarchy::default() }
    }

    #[test]
    fn time_runs_at_its_speed_and_starts_again_at_the_end() {
        let mut playback = Playback::new(AnimationSelection::All, 1.5);
        let mut advanced = |change: &dyn Fn(&mut Playback)| {
            change(&mut playback);
            playback.advance(&hierarchy(), 0.0, 0.25);
            playback.time_s
        };
        assert_eq!(advanced(&|_| {}), 1.75);
        assert_eq!(advanced(&|_| {}), 0.0);
        assert_eq!(advanced(&|playback| playback.speed = -2.0), 1.5);
        assert_eq!(advanced(&|playback| playback.is_playing = false), 1.5);
        // Nothing to play.
        let none = |playback: &mut Playback| {
            (playback.selection, playback.is_playing) = (AnimationSelection::None, true);
        };
        assert_eq!(advanced(&none), 1.5);
    }

    #[test]
    fn a_scene_is_moved_only_to_another_time() {
        let mut playback = Playback::new(AnimationSelection::All, 0.0);
        let mut scenes = [Scene::default(), Scene::default()];
        playback.apply(&mut scenes).unwrap();
        let shown = playback.clone();
        playback.apply(&mut scenes).unwrap();
        assert_eq!(playback, shown);
    }
}
