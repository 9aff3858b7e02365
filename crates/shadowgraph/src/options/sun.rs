//! The directional lights of the scene, none, or another one.

use super::error::OptionError;
use super::pairs::{Pairs, Range};
use glam::{DVec3, Vec3};
use shadowgraph_scene::{Light, LightKind, Scene, SkyDirection, SolarTime};
use std::str::FromStr;

const OPTION: &str = "sun";
const KEYS: [&str; 6] = ["dir", "time", "day", "lat", "lux", "color"];
const DIR: Range = Range::within(-1.0e6, 1.0e6, "");
const DAY: Range = Range::within(1.0, 366.0, "");
const LAT: Range = Range::within(-90.0, 90.0, "degrees");
const LUX: Range = Range::within(0.0, 1.0e6, "lux");
const COLOR: Range = Range::within(0.0, 1.0, "(linear)");

/// The default illuminance of a sun, lux.
pub const DEFAULT_SUN_LUX: f32 = 20_000.0;

/// The directional light of the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SunChoice {
    /// The lights of the scene; a scene without any light gets [`default_sun`].
    #[default]
    Scene,
    /// No directional light.
    None,
    /// This one, instead of those of the scene. It is light 0.
    Sun(Light),
    /// The sun at this moment, by [`sun_at`], instead of those of the scene. It is light 0.
    Time(SolarTime, Light),
}

impl SunChoice {
    /// Changes a scene's lights accordingly. Returns a note if the scene had no light and got the default sun, or if the sun is
    /// below the horizon.
    ///
    /// ```
    /// use shadowgraph::options::SunChoice;
    /// let mut scene = shadowgraph_scene::Scene::default();
    /// "dir=0,-1,0 lux=5".parse::<SunChoice>()?.apply(&mut scene);
    /// assert_eq!(scene.lights()[0].intensity, 5.0);
    /// # Ok::<(), shadowgraph::options::OptionError>(())
    /// ```
    pub fn apply(&self, scene: &mut Scene) -> Option<String> {
        match self {
            Self::Scene if scene.lights().is_empty() => {
                scene.insert_light(default_sun());
                Some(format!("the scene has no light; a default sun of {DEFAULT_SUN_LUX} lux is added"))
            }
            Self::Scene => None,
            Self::None => {
                remove_directional(scene);
                None
            }
            Self::Sun(sun) => {
                remove_directional(scene);
                scene.insert_light(sun.clone());
                None
            }
            Self::Time(time, sun) => {
                remove_directional(scene);
                scene.insert_light(sun_at(time, sun));
                let elevation_deg = SkyDirection::from_vector(time.to_sun()).elevation.to_degrees();
                (elevation_deg <= 0.0).then(|| {
                    format!("the sun is {:.1} degrees below the horizon; it emits no light", -elevation_deg)
                })
            }
        }
    }
}

/// Returns a sun in the position of a moment. Below the horizon it has 0 lux and casts no shadow.
#[must_use]
pub fn sun_at(time: &SolarTime, sun: &Light) -> Light {
    let to_sun = time.to_sun();
    let kind = LightKind::Directional { direction: -to_sun };
    let is_up = to_sun.y > 0.0;
    Light {
        kind,
        intensity: if is_up { sun.intensity } else { 0.0 },
        casts_shadow: is_up && sun.casts_shadow,
        ..sun.clone()
    }
}

/// Returns the sun of a scene without lights: white, from above, the front and the left.
#[must_use]
pub fn default_sun() -> Light {
    sun(DVec3::new(0.5, -1.0, -0.6).normalize(), DEFAULT_SUN_LUX, Vec3::ONE)
}

fn sun(direction: DVec3, intensity: f32, color: Vec3) -> Light {
    let kind = LightKind::Directional { direction };
    Light { name: Some("sun".to_owned()), kind, color, intensity, casts_shadow: true }
}

/// Removes the directional lights. The others keep their keys, so that animations still move them.
fn remove_directional(scene: &mut Scene) {
    let is_directional = |light: &Light| matches!(light.kind, LightKind::Directional { .. });
    let lights = scene.light_keys().iter().zip(scene.lights());
    let keys: Vec<_> = lights.filter(|(_, light)| is_directional(light)).map(|(key, _)| *key).collect();
    keys.into_iter().for_each(|key| drop(scene.remove_light(key)));
}

/// Returns the unit direction of the key `dir`.
fn direction(pairs: &Pairs<'_>) -> Result<DVec3, OptionError> {
    let form = "\"dir=X,Y,Z lux=L color=R,G,B\" (dir: the direction in which the light travels), \
                \"time=HH:MM day=1..366 lat=DEGREES\" in place of dir, or none";
    let dir = pairs.vector("dir", DIR)?.ok_or_else(|| pairs.missing("dir", form))?;
    dir.try_normalize().ok_or_else(|| {
        OptionError::new(OPTION, "dir must not be zero; it is the direction in which the light travels")
    })
}

impl FromStr for SunChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        if text.trim() == "none" {
            return Ok(Self::None);
        }
        let pairs = Pairs::parse(OPTION, text, &KEYS)?;
        let lux = pairs.number("lux", LUX)?.map_or(DEFAULT_SUN_LUX, |lux| lux as f32);
        let color = pairs.vector("color", COLOR)?.map_or(Vec3::ONE, |color| color.as_vec3());
        let light = |direction| sun(direction, lux, color);
        let Some(key) = pairs.any_of(&["time", "day", "lat"]) else {
            return Ok(Self::Sun(light(direction(&pairs)?)));
        };
        if pairs.any_of(&["dir"]).is_some() {
            let reason = format!("dir and {key} are both given; expected either dir, or time, day and lat");
            return Err(OptionError::new(OPTION, reason));
        }
        let missing = |key| pairs.missing(key, "\"time=HH:MM day=1..366 lat=DEGREES\" (true solar time)");
        let hour = pairs.time("time")?.ok_or_else(|| missing("time"))?;
        let day = pairs.number("day", DAY)?.ok_or_else(|| missing("day"))?;
        let latitude = pairs.number("lat", LAT)?.ok_or_else(|| missing("lat"))?.to_radians();
        let time = SolarTime { hour, day, latitude };
        Ok(Self::Time(time, light(-time.to_sun())))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    fn scene() -> Scene {
        let mut scene = Scene::default();
        let point = LightKind::Point { position_world: DVec3::ZERO, range: None };
        scene.insert_light(Light { kind: point, ..default_sun() });
        scene.insert_light(default_sun());
        scene.insert_light(default_sun());
        scene
    }

    fn orders(scene: &Scene) -> Vec<u8> {
        scene.lights().iter().map(|light| light.kind.order()).collect()
    }

    fn error(text: &str) -> String {
        text.parse::<SunChoice>().unwrap_err().to_string()
    }

    #[test]
    fn a_sun_replaces_the_directional_lights_and_is_light_zero() {
        let mut scene = scene();
        let choice: SunChoice = "dir=0,-2,0 lux=7 color=1,0.5,0".parse().unwrap();
        let point = scene.light_keys()[2];
        assert_eq!(choice.apply(&mut scene), None);
        assert_eq!(orders(&scene), [0, 2]);
        assert_eq!(scene.light_index(point), Some(1), "other lights keep their keys");
        assert_eq!(scene.lights()[0].kind, LightKind::Directional { direction: DVec3::NEG_Y });
        assert_eq!((scene.lights()[0].intensity, scene.lights()[0].color), (7.0, Vec3::new(1.0, 0.5, 0.0)));
    }

    #[test]
    fn none_removes_the_directional_lights_and_adds_nothing() {
        let mut scene = scene();
        assert_eq!("none".parse::<SunChoice>().unwrap().apply(&mut scene), None);
        assert_eq!(orders(&scene), [2]);
        let mut dark = Scene::default();
        assert_eq!(SunChoice::None.apply(&mut dark), None);
        assert!(dark.lights().is_empty());
    }

    #[test]
    fn only_a_scene_without_lights_gets_the_default_sun_and_a_note() {
        let mut dark = Scene::default();
        assert!(SunChoice::Scene.apply(&mut dark).unwrap().contains("no light"));
        assert_eq!(dark.lights(), [default_sun()]);
        let mut lit = scene();
        assert_eq!(SunChoice::Scene.apply(&mut lit), None);
        assert_eq!(lit, scene());
    }

    #[test]
    fn errors_name_the_value_and_its_range() {
        assert!(error("").contains("missing key `dir`; expected \"dir=X,Y,Z"));
        assert!(error("noon").contains("invalid value `noon`; expected key=value"));
        assert!(error("dir=0,0,0").contains("dir must not be zero"));
        assert!(error("dir=0,-1,0 lux=nan").contains("lux=nan is out of range: 0 to 1000000 lux"));
        assert!(error("dir=0,-1,0 color=1,1,2").contains("color=1,1,2 is out of range: 0 to 1 (linear)"));
        assert!(
            error("dir=0,-1,0 kelvin=5000")
                .contains("unknown key `kelvin`; expected one of: dir, time, day, lat, lux, color")
        );
        assert_eq!(
            error("dir=0,-1,0 day=3"),
            "sun: dir and day are both given; expected either dir, or time, day and lat"
        );
        assert!(error("time=12:00 lat=50").contains("missing key `day`; expected \"time=HH:MM day=1..366"));
        assert!(error("time=12:00 day=0 lat=50").contains("day=0 is out of range: 1 to 366"));
        assert!(error("time=12:00 day=1 lat=91").contains("lat=91 is out of range: -90 to 90 degrees"));
        assert!(error("time=25:00 day=1 lat=0").contains("`time=25:00`; expected HH:MM"));
    }

    #[test]
    fn a_time_gives_the_sun_of_that_moment_and_at_night_a_dark_one_with_a_note() {
        let mut day = scene();
        assert_eq!("time=06:00 day=80 lat=0 lux=7".parse::<SunChoice>().unwrap().apply(&mut day), None);
        let LightKind::Directional { direction } = day.lights()[0].kind else { panic!("{:?}", day.lights()) };
        // Just after sunrise: the light travels to the west.
        assert!(direction.distance(DVec3::NEG_X) < 0.02, "{direction}");
        assert_eq!((day.lights()[0].intensity, orders(&day)), (7.0, vec![0, 2]));
        let mut night = scene();
        let note = "time=00:00 day=355 lat=52.5".parse::<SunChoice>().unwrap().apply(&mut night);
        assert_eq!(note.unwrap(), "the sun is 60.9 degrees below the horizon; it emits no light");
        assert_eq!((night.lights()[0].intensity, night.lights()[0].casts_shadow), (0.0, false));
        assert_eq!(orders(&night), [0, 2]);
    }
}
