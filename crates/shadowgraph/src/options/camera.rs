//! A camera of the scene by index or name, or a free one.

use super::error::OptionError;
use super::pairs::{Pairs, Range};
use glam::DVec3;
use shadowgraph_scene::{Camera, Projection, Scene};
use std::str::FromStr;

const OPTION: &str = "camera";
const KEYS: [&str; 5] = ["eye", "target", "fov_deg", "near", "far"];
const COORDINATE: Range = Range::within(-1.0e9, 1.0e9, "metres");
const FOV_DEG: Range = Range::within(0.1, 175.0, "degrees");
const NEAR: Range = Range::above(0.0, 1.0e6, "metres");
const FAR: Range = Range::above(0.0, 1.0e9, "metres");
const DEFAULT_FOV_DEG: f64 = 50.0;
const DEFAULT_NEAR_M: f64 = 0.1;

/// The camera of the image.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum CameraChoice {
    /// The scene's first camera, or else one that frames the scene.
    #[default]
    Default,
    /// A camera of the scene by its index, or else by its name.
    Scene(String),
    /// A free camera.
    Free(Camera),
}

impl CameraChoice {
    /// Returns the camera for a scene. `aspect` is the image's width over its height, above 0.
    ///
    /// ```
    /// use shadowgraph::options::CameraChoice;
    /// let scene = shadowgraph_scene::Scene::default();
    /// let camera = "eye=0,2,5 target=0,1,0 fov_deg=40".parse::<CameraChoice>()?.resolve(&scene, 1.5)?;
    /// assert_eq!(camera.position_world().y, 2.0);
    /// # Ok::<(), shadowgraph::options::OptionError>(())
    /// ```
    ///
    /// # Errors
    /// For a camera that the scene does not have; the message lists its cameras.
    pub fn resolve(&self, scene: &Scene, aspect: f64) -> Result<Camera, OptionError> {
        match self {
            Self::Default => {
                Ok(scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(aspect)))
            }
            Self::Free(camera) => Ok(camera.clone()),
            Self::Scene(wanted) => {
                let by_index = wanted.parse().ok().and_then(|index: usize| scene.cameras.get(index));
                let by_name = || scene.cameras.iter().find(|camera| camera.name.as_ref() == Some(wanted));
                by_index.or_else(by_name).cloned().ok_or_else(|| unknown_camera(wanted, scene))
            }
        }
    }
}

fn unknown_camera(wanted: &str, scene: &Scene) -> OptionError {
    const SHOWN: usize = 8;
    let name = |(index, camera): (usize, &Camera)| match &camera.name {
        Some(name) => format!("{index} \"{name}\""),
        None => index.to_string(),
    };
    let mut list: Vec<String> = scene.cameras.iter().enumerate().take(SHOWN).map(name).collect();
    if scene.cameras.len() > SHOWN {
        list.push(format!("{} more", scene.cameras.len() - SHOWN));
    }
    let hint = match list.is_empty() {
        true => "the scene has no cameras".to_owned(),
        false => format!("expected one of: {}", list.join(", ")),
    };
    OptionError::new(OPTION, format!("unknown camera `{wanted}`; {hint}"))
}

impl FromStr for CameraChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        if text.trim().is_empty() {
            return Err(OptionError::new(
                OPTION,
                "empty value; expected an index, a name or eye=X,Y,Z target=X,Y,Z",
            ));
        }
        if text.contains('=') { free(text).map(Self::Free) } else { Ok(Self::Scene(text.to_owned())) }
    }
}

fn free(text: &str) -> Result<Camera, OptionError> {
    const FORM: &str = "\"eye=X,Y,Z target=X,Y,Z fov_deg=F near=N far=F\"";
    let pairs = Pairs::parse(OPTION, text, &KEYS)?;
    let eye = pairs.vector("eye", COORDINATE)?.ok_or_else(|| pairs.missing("eye", FORM))?;
    let target = pairs.vector("target", COORDINATE)?.ok_or_else(|| pairs.missing("target", FORM))?;
    if eye == target {
        return Err(OptionError::new(OPTION, "eye and target must not be the same point"));
    }
    let fov_y = pairs.number("fov_deg", FOV_DEG)?.unwrap_or(DEFAULT_FOV_DEG).to_radians();
    let near = pairs.number("near", NEAR)?.unwrap_or(DEFAULT_NEAR_M);
    let far = pairs.number("far", FAR)?;
    if let Some(far) = far.filter(|far| *far <= near) {
        return Err(OptionError::new(OPTION, format!("far={far} is out of range: above near={near} metres")));
    }
    Ok(Camera::look_at(eye, target, DVec3::Y, Projection::Perspective { fov_y, near, far }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    fn scene() -> Scene {
        let camera = |name: Option<&str>, x: f64| {
            let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
            let camera = Camera::look_at(DVec3::new(x, 0.0, 0.0), DVec3::NEG_Z, DVec3::Y, projection);
            Camera { name: name.map(str::to_owned), ..camera }
        };
        let mut scene = Scene::default();
        scene.cameras = vec![camera(None, 1.0), camera(Some("7"), 2.0), camera(Some("Left side"), 3.0)];
        scene
    }

    fn chosen_x(text: &str) -> f64 {
        text.parse::<CameraChoice>().unwrap().resolve(&scene(), 1.0).unwrap().position_world().x
    }

    fn error(text: &str) -> String {
        text.parse::<CameraChoice>().and_then(|choice| choice.resolve(&scene(), 1.0)).unwrap_err().to_string()
    }

    #[test]
    fn a_camera_is_found_by_index_then_by_name() {
        assert_eq!(chosen_x("0"), 1.0);
        assert_eq!(chosen_x("7"), 2.0);
        assert_eq!(chosen_x("Left side"), 3.0);
        assert_eq!(
            error("Right"),
            "camera: unknown camera `Right`; expected one of: 0, 1 \"7\", 2 \"Left side\""
        );
    }

    #[test]
    fn the_default_is_the_first_camera_or_one_that_frames_the_scene() {
        assert_eq!(CameraChoice::Default.resolve(&scene(), 1.0).unwrap().position_world().x, 1.0);
        assert!(CameraChoice::Default.resolve(&Scene::default(), 1.0).unwrap().world_from_view.is_finite());
    }

    #[test]
    fn a_free_camera_is_in_degrees_and_metres() {
        let choice = "eye=1,2,3 target=1,2,-3 fov_deg=90 near=0.5 far=100".parse().unwrap();
        let CameraChoice::Free(camera) = choice else { panic!("{choice:?}") };
        assert_eq!(camera.position_world(), DVec3::new(1.0, 2.0, 3.0));
        assert!((camera.forward_world() - DVec3::NEG_Z).length() < 1e-12);
        let fov_y = std::f64::consts::FRAC_PI_2;
        assert_eq!(camera.projection, Projection::Perspective { fov_y, near: 0.5, far: Some(100.0) });
    }

    #[test]
    fn a_free_camera_that_looks_straight_down_is_finite() {
        let CameraChoice::Free(camera) = "eye=0,9,0 target=0,0,0".parse().unwrap() else { panic!() };
        assert!(camera.world_from_view.is_finite());
    }

    #[test]
    fn errors_name_the_value_and_its_range() {
        assert_eq!(
            error("ey=1,2,3"),
            "camera: unknown key `ey`; expected one of: eye, target, fov_deg, near, far"
        );
        assert!(error("eye=1,2,3").contains("missing key `target`; expected \"eye=X,Y,Z target"));
        assert!(error("eye=1,2,3 target=1,2,3").contains("same point"));
        assert!(error("eye=1,2,3 target=0,0,NaN").contains("target=0,0,NaN is out of range: -1000000000 to"));
        assert!(
            error("eye=1,2,3 target=0,0,0 fov_deg=180")
                .contains("fov_deg=180 is out of range: 0.1 to 175 degrees")
        );
        assert!(
            error("eye=1,2,3 target=0,0,0 near=0")
                .contains("near=0 is out of range: above 0 to 1000000 metres")
        );
        assert!(error("eye=1,2,3 target=0,0,0 near=5 far=5").contains("far=5 is out of range: above near=5"));
        assert!(error(" ").contains("empty"));
    }
}
