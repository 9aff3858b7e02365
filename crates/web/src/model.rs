//! Scenes that a stage shows.

use shadowgraph::options::{GroundChoice, SunChoice};
use shadowgraph::scene::gltf::{LoadOptions, Progress, load_bytes};
use shadowgraph::scene::{Camera, Scene};
use shadowgraph_samples::demo::demo_scene;

use crate::error::Error;

/// A scene that is ready to be shown: with a ground and a sun if its file has none, as the program `shadowgraph` adds them.
#[derive(Clone, Debug)]
#[cfg_attr(target_arch = "wasm32", wasm_bindgen::prelude::wasm_bindgen)]
pub struct Model {
    pub(crate) scene: Scene,
    notes: Vec<String>,
}

impl Model {
    /// Returns the built-in demo scene.
    #[must_use]
    pub fn demo_scene() -> Self {
        Self::from_scene(demo_scene())
    }

    /// Loads a glTF or GLB file in memory; `files` are those that it refers to, by their paths relative to it.
    ///
    /// # Errors
    /// Of the file, in one line: where, and what is wrong there.
    pub fn from_bytes(
        name: &str,
        bytes: &[u8],
        files: &[(String, Vec<u8>)],
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self, Error> {
        Ok(Self::from_scene(load_bytes(name, bytes, files, &LoadOptions::default(), progress)?))
    }

    /// Prepares a scene.
    #[must_use]
    pub fn from_scene(mut scene: Scene) -> Self {
        let mut notes = scene.notes.clone();
        GroundChoice::default().place(&scene, true).add_to(&mut scene);
        notes.extend(SunChoice::default().apply(&mut scene));
        Self { scene, notes }
    }

    /// Returns the first camera of the scene; without one, a camera that frames it in images of this aspect ratio, their width over their height,
    /// above 0.
    #[must_use]
    pub fn camera(&self, aspect: f64) -> Camera {
        let first = self.scene.cameras.first().cloned();
        first.unwrap_or_else(|| self.scene.framing_camera(aspect))
    }

    /// Returns what is not drawn as the file says, and what was added to it, a line each.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_file_without_lights_and_cameras_gets_both() {
        let text = br#"{"asset": {"version": "2.0"}, "scenes": [{}]}"#;
        let model = Model::from_bytes("empty.gltf", text, &[], &mut |_| {}).unwrap();
        assert_eq!(model.scene.lights().len(), 1);
        assert!(model.camera(0.5).check(0.5).is_ok());
        assert!(model.notes().iter().any(|note| note.contains("sun")), "{:?}", model.notes());
    }

    #[test]
    fn a_file_that_is_no_gltf_is_an_error_of_one_line() {
        let error = Model::from_bytes("cat.gltf", b"\x89PNG", &[], &mut |_| {}).unwrap_err().to_string();
        assert!(error.contains("cat.gltf") && error.contains("is not glTF"), "{error}");
        assert_eq!(error.lines().count(), 1);
    }
}
