//! The real scenes, if they are on this machine.

use shadowgraph::options::SunChoice;
use shadowgraph::scene::{Camera, Scene, gltf};
use std::sync::LazyLock;

/// A real scene with a sun, and its camera.
pub(crate) struct RealScene {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) camera: Camera,
}

/// Returns the shared scenes, which are read once, or `None` after reporting a skip where they are missing.
pub(crate) fn real_scenes() -> Option<&'static [RealScene]> {
    static SCENES: LazyLock<Option<Vec<RealScene>>> = LazyLock::new(read);
    if SCENES.is_none() {
        shadowgraph_tests::skip("scenes", "the collection of real scenes is missing (SHADOWGRAPH_SHARED)");
    }
    SCENES.as_deref()
}

fn read() -> Option<Vec<RealScene>> {
    let dir = shadowgraph_tests::shared("scenes")?;
    let mut files: Vec<_> = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "glb"));
    files.sort();
    assert_eq!(files.len(), 21);
    let scenes = files.into_iter().map(|file| {
        let mut scene = gltf::load(&file).unwrap();
        SunChoice::default().apply(&mut scene);
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
        RealScene { name: file.file_stem().unwrap().to_string_lossy().into_owned(), scene, camera }
    });
    Some(scenes.collect())
}
