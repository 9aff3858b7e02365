//! The sun of the window: by direction or by time, and a day that plays.

use shadowgraph::options::{SunChoice, sun_at};
use shadowgraph::scene::{Light, LightKey, LightKind, Scene, SkyDirection, SolarTime};

/// What places the sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Placement {
    /// Azimuth and elevation.
    Direction,
    /// Time, day and latitude.
    Time,
}

/// The scene's first directional light, and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Sun {
    pub(super) key: LightKey,
    /// The light as it was last shown.
    shown: Option<Light>,
    /// The light at daytime.
    day_light: Light,
    pub(super) place: Placement,
    pub(super) sky: SkyDirection,
    pub(super) time: SolarTime,
    /// Whether time passes.
    pub(super) plays: bool,
    pub(super) hours_per_second: f64,
}

impl Sun {
    /// Returns the sun of a scene to which a choice was applied; `None` for a scene without directional lights.
    pub(super) fn from_scene(scene: &Scene, choice: &SunChoice) -> Option<Self> {
        let mut lights = scene.light_keys().iter().zip(scene.lights());
        let (key, light, direction) = lights.find_map(|(key, light)| match light.kind {
            LightKind::Directional { direction } => Some((*key, light, direction)),
            _ => None,
        })?;
        let noon = SolarTime { hour: 12.0, day: 172.0, latitude: 52.5_f64.to_radians() };
        let (place, time, day_light) = match choice {
            SunChoice::Time(time, sun) => (Placement::Time, *time, sun.clone()),
            _ => (Placement::Direction, noon, light.clone()),
        };
        let sky = SkyDirection::from_vector(-direction);
        let mut sun =
            Self { key, shown: None, day_light, place, sky, time, plays: false, hours_per_second: 0.5 };
        sun.shown = Some(sun.light());
        Some(sun)
    }

    /// Starts the day at the current time, or stops it.
    pub(super) fn play(&mut self, plays: bool) {
        self.plays = plays;
        if plays {
            self.place = Placement::Time;
        }
    }

    /// Lets time pass while the day plays. After midnight the next day begins.
    pub(super) fn advance(&mut self, seconds: f64) {
        if self.plays {
            let hour = self.time.hour + seconds * self.hours_per_second;
            self.time.day = (self.time.day - 1.0 + (hour / 24.0).floor()).rem_euclid(365.0) + 1.0;
            self.time.hour = hour.rem_euclid(24.0);
        }
    }

    /// Returns the light if it has changed since the last call.
    pub(super) fn changed(&mut self) -> Option<Light> {
        let light = Some(self.light()).filter(|light| self.shown.as_ref() != Some(light));
        if light.is_some() {
            self.shown.clone_from(&light);
        }
        light
    }

    /// Returns the light.
    pub(super) fn light(&self) -> Light {
        match self.place {
            Placement::Direction => {
                let kind = LightKind::Directional { direction: -self.sky.to_vector() };
                Light { kind, ..self.day_light.clone() }
            }
            Placement::Time => sun_at(&self.time, &self.day_light),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn sun(text: &str) -> Sun {
        let (mut scene, choice) = (Scene::default(), text.parse::<SunChoice>().unwrap());
        choice.apply(&mut scene);
        Sun::from_scene(&scene, &choice).unwrap()
    }

    fn to_sun(sun: &Sun) -> glam::DVec3 {
        let LightKind::Directional { direction } = sun.light().kind else { return glam::DVec3::ZERO };
        -direction
    }

    #[test]
    fn a_direction_is_kept_and_a_time_is_that_of_the_option() {
        let by_direction = sun("dir=1,-1,0 lux=7");
        assert_eq!((by_direction.place, by_direction.light().intensity), (Placement::Direction, 7.0));
        assert!(to_sun(&by_direction).distance(glam::DVec3::new(-1.0, 1.0, 0.0).normalize()) < 1e-9);
        let by_time = sun("time=06:00 day=80 lat=0");
        assert_eq!((by_time.place, by_time.time.hour), (Placement::Time, 6.0));
        assert!(Sun::from_scene(&Scene::default(), &SunChoice::None).is_none());
    }

    #[test]
    fn a_day_plays_over_midnight_into_the_next() {
        let mut sun = sun("time=23:00 day=365 lat=50 lux=9");
        sun.advance(2.0);
        assert_eq!(sun.changed(), None);
        assert_eq!((sun.time.hour, sun.time.day, sun.light().intensity), (23.0, 365.0, 0.0));
        sun.play(true);
        sun.advance(4.0);
        assert_eq!((sun.time.hour, sun.time.day), (1.0, 1.0));
        sun.advance(22.0);
        assert!(sun.changed().is_some() && sun.changed().is_none());
        assert_eq!((sun.time.hour, sun.light().intensity), (12.0, 9.0));
        assert!(to_sun(&sun).y > 0.0);
    }
}
