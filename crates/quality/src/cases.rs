//! Measurement cases as data: scenes, suns and views.

use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::{Deserialize, Serialize};
use shadowgraph_samples::test_scenes;
use shadowgraph_scene::{Camera, Light, Projection};

use shadowgraph::ron_file;

use crate::Error;

/// A set of cases: each scene under each of its suns from each of its views.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseSet {
    /// The scenes.
    pub cases: Vec<Case>,
}

/// A scene with its suns and views.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Source of the scene.
    pub scene: SceneSource,
    /// Elevations of the sun above the horizon, degrees, each above 0 and up to 90. Empty: the lights of the file.
    #[serde(default)]
    pub sun_elevations_deg: Vec<f64>,
    /// Azimuth of the direction in which the sun's light travels, from east (+X) towards north (-Z), degrees.
    #[serde(default)]
    pub sun_heading_deg: f64,
    /// Cameras. Empty: the cameras of the file, else one that frames the scene.
    #[serde(default)]
    pub views: Vec<CaseView>,
}

/// Source of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SceneSource {
    /// A test scene, one of [`test_scenes::TEST_SCENES`].
    #[serde(alias = "Trial")]
    TestScene(String),
    /// A glTF or GLB file; a relative path starts at the directory of the case file.
    File(PathBuf),
}

/// A camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseView {
    /// Name in tables.
    pub name: String,
    /// Position, metres.
    pub eye: [f64; 3],
    /// Point at the centre of the view, metres.
    pub target: [f64; 3],
    /// Vertical field of view, degrees, above 0 and below 180.
    #[serde(default = "default_fov_deg")]
    pub fov_deg: f64,
}

fn default_fov_deg() -> f64 {
    50.0
}

impl CaseView {
    /// Returns the camera, with its near plane at 10 cm and no far plane.
    #[must_use]
    pub fn camera(&self) -> Camera {
        let projection = Projection::Perspective { fov_y: self.fov_deg.to_radians(), near: 0.1, far: None };
        let (eye, target) = (DVec3::from(self.eye), DVec3::from(self.target));
        Camera { name: Some(self.name.clone()), ..Camera::look_at(eye, target, DVec3::Y, projection) }
    }
}

impl Case {
    /// Returns the sun at an elevation.
    #[must_use]
    pub fn sun(&self, elevation_deg: f64) -> Light {
        test_scenes::sun(elevation_deg, self.sun_heading_deg)
    }

    /// Returns the scene's name in tables.
    #[must_use]
    pub fn name(&self) -> String {
        match &self.scene {
            SceneSource::TestScene(name) => name.clone(),
            SceneSource::File(path) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        }
    }
}

/// Returns the built-in cases: nine test scenes, four suns, a near and a far view each.
///
/// # Errors
/// None in practice: a test reads them.
pub fn built_in_cases() -> Result<CaseSet, Error> {
    CaseSet::parse(include_str!("cases.ron"), Path::new("the built-in cases"))
}

impl CaseSet {
    /// Reads cases from RON; errors name `file`.
    ///
    /// # Errors
    /// [`Error::File`] with line and column, or the value that is out of range and its range.
    pub fn parse(text: &str, file: &Path) -> Result<Self, Error> {
        let file = file.display().to_string();
        let set: Self = ron_file::parse_file(&file, text)?;
        if set.cases.is_empty() {
            return Err(ron_file::field_error(&file, text, "cases", "expected at least one case").into());
        }
        for (index, case) in set.cases.iter().enumerate() {
            let error = |problem| ron_file::field_error(&file, text, &format!("cases.{index}"), problem);
            case.check().map_err(error)?;
        }
        Ok(set)
    }
}

/// The largest coordinate of a view, metres.
const MAX_COORDINATE_M: f64 = 1e9;

impl Case {
    fn check(&self) -> Result<(), String> {
        let name = self.name();
        if let SceneSource::TestScene(test_scene) = &self.scene
            && !test_scenes::TEST_SCENES.contains(&test_scene.as_str())
        {
            return Err(format!(
                "unknown test scene `{test_scene}`; expected one of: {}",
                test_scenes::TEST_SCENES.join(", ")
            ));
        }
        let in_range = |elevation: &f64| *elevation > 0.0 && *elevation <= 90.0;
        if let Some(invalid) = self.sun_elevations_deg.iter().find(|elevation| !in_range(elevation)) {
            return Err(format!(
                "{name}: invalid value {invalid} in sun_elevations_deg; allowed: above 0, up to 90"
            ));
        }
        if matches!(self.scene, SceneSource::TestScene(_))
            && (self.sun_elevations_deg.is_empty() || self.views.is_empty())
        {
            return Err(format!(
                "{name}: a test scene has no lights or cameras; expected sun_elevations_deg and views"
            ));
        }
        for view in &self.views {
            let numbers = || view.eye.iter().chain(&view.target);
            if let Some(invalid) =
                numbers().find(|value| !(-MAX_COORDINATE_M..=MAX_COORDINATE_M).contains(*value))
            {
                return Err(format!(
                    "{name}, view {}: invalid coordinate {invalid} in eye or target; allowed: -1e9 to 1e9 m",
                    view.name
                ));
            }
            if view.eye == view.target {
                return Err(format!("{name}, view {}: eye and target must be different points", view.name));
            }
            if !(view.fov_deg > 0.0 && view.fov_deg < 180.0) {
                let fov = view.fov_deg;
                return Err(format!(
                    "{name}, view {}: invalid value {fov} of fov_deg; allowed: above 0, below 180",
                    view.name
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn problem(text: &str) -> String {
        CaseSet::parse(text, Path::new("my.ron")).unwrap_err().to_string()
    }

    #[test]
    fn the_built_in_cases_contain_every_test_scene_under_four_suns() {
        let set = built_in_cases().unwrap();
        let names: Vec<_> = set.cases.iter().map(Case::name).collect();
        assert_eq!(names, test_scenes::TEST_SCENES);
        assert!(set.cases.iter().all(|case| case.sun_elevations_deg.len() == 4 && case.views.len() == 2));
    }

    #[test]
    fn the_former_name_of_test_scenes_is_still_read() {
        let text = r#"(cases: [(scene: TestScene("cube"), sun_elevations_deg: [30], views: [
            (name: "a", eye: (3, 1, 2), target: (0, 1, 0))])])"#;
        let read = |text: &str| CaseSet::parse(text, Path::new("my.ron")).unwrap();
        assert_eq!(read(text), read(&text.replace("TestScene", "Trial")));
    }

    #[test]
    fn an_invalid_case_is_an_error_of_one_line_with_problem_and_location() {
        let text = r#"(cases: [(scene: TestScene("castle"))])"#;
        assert!(
            problem(text).contains("my.ron:1:10: unknown test scene `castle`; expected one of: cube, slats")
        );
        let text = r#"(cases: [(scene: TestScene("cube"), sun_elevations_deg: [95], views: [])])"#;
        assert!(
            problem(text)
                .contains("cube: invalid value 95 in sun_elevations_deg; allowed: above 0, up to 90")
        );
        let text = r#"(cases: [(scene: TestScene("cube"), suns: [])])"#;
        assert!(
            problem(text).contains("my.ron:1:37: ") && problem(text).contains("suns"),
            "{}",
            problem(text)
        );
        assert!(problem("(cases: [])").contains("my.ron:1:9: expected at least one case"));
        let view = r#"(name: "a", eye: (NaN, 1, 2), target: (0, 1, 2))"#;
        let text =
            format!(r#"(cases: [(scene: TestScene("cube"), sun_elevations_deg: [30], views: [{view}])])"#);
        assert!(problem(&text).contains("cube, view a: invalid coordinate NaN in eye or target"));
        let view = r#"(name: "a", eye: (0, 1, 2), target: (0, 1, 2))"#;
        let text =
            format!(r#"(cases: [(scene: TestScene("cube"), sun_elevations_deg: [30], views: [{view}])])"#);
        assert!(problem(&text).contains("cube, view a: eye and target"));
    }
}
