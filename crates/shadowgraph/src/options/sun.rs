//! The directional lights of the scene, none, or another one.

use super::error::OptionError;
use super::pairs::{Pairs, Range};
use glam::{DVec3, Vec3};
use shadowgraph_scene::{Light, LightKind, Scene};
use std::str::FromStr;

const OPTION: &str = "sun";
const KEYS: [&str; 3] = ["dir", "lux", "color"];
const DIR: Range = Range::within(-1.0e6, 1.0e6, "");
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
}

impl SunChoice {
    /// Changes a scene's lights accordingly. Returns a note if the scene had no light and got the default sun.
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
        }
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

impl FromStr for SunChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        if text.trim() == "none" {
            return Ok(Self::None);
        }
        let pairs = Pairs::parse(OPTION, text, &KEYS)?;
        let form = "\"dir=X,Y,Z lux=L color=R,G,B\" (dir: the direction in which the light travels), or none";
        let dir = pairs.vector("dir", DIR)?.ok_or_else(|| pairs.missing("dir", form))?;
        let direction = dir.try_normalize().ok_or_else(|| {
            OptionError::new(OPTION, "dir must not be zero; it is the direction in which the light travels")
        })?;
        let lux = pairs.number("lux", LUX)?.map_or(DEFAULT_SUN_LUX, |lux| lux as f32);
        let color = pairs.vector("color", COLOR)?.map_or(Vec3::ONE, |color| color.as_vec3());
        Ok(Self::Sun(sun(direction, lux, color)))
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
                .contains("unknown key `kelvin`; expected one of: dir, lux, color")
        );
    }
}
