//! Capturing textures changes neither the image of a frame nor its plan.

use shadowgraph::core::TexelValues;
use shadowgraph::inspect::{ContentsRecorder, InspectedFrame};
use shadowgraph::options::Aov;
use shadowgraph::shadows::{ShadowSettings, Techniques, VirtualSettings};
use shadowgraph::{Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;

use crate::stage::gpu;

fn inspect(technique: &str) -> Option<(InspectedFrame, shadowgraph::RenderedFrame)> {
    let gpu = gpu()?;
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let shadows = ShadowSettings { distance_m: 60.0, ..ShadowSettings::default() }.without_cache();
    let options = ViewOptions { camera: camera.clone(), size_px: [160, 90], shadows };
    let technique = Techniques::built_in().find(technique).unwrap();
    let new = || Renderer::with_config(gpu, scene.clone(), &camera, Aov::Color, technique).unwrap();
    let inspected = new().inspect(gpu, &options).unwrap();
    Some((inspected, new().draw(gpu, &options).unwrap()))
}

#[test]
fn a_captured_frame_has_the_plan_and_the_pixels_of_an_uncaptured_frame() {
    for technique in ["pcf", "evsm", "sdsm", "pcf+contact"] {
        let Some((inspected, drawn)) = inspect(technique) else { return };
        assert_eq!(inspected.frame.plan, drawn.plan, "{technique}");
        assert_eq!(inspected.frame.image, drawn.image, "{technique}");
        assert!(!inspected.frame.times.is_empty() && !inspected.textures.is_empty());
        // The captured texels, where all of them are kept.
        let image = drawn.plan.find_resource("image").unwrap();
        let captured = inspected.textures.iter().rfind(|shot| shot.resource == image).unwrap();
        let texels = captured.texels.as_ref().unwrap();
        assert_eq!(texels.size_px, drawn.image.size_px);
        assert_eq!(texels.values, TexelValues::Bytes(drawn.image.rgba8.clone()), "{technique}");
    }
}

#[test]
fn the_page_outlines_the_frustum_of_every_shadow_map() {
    let Some((inspected, _)) = inspect("sdsm") else { return };
    assert_eq!(inspected.lights.len(), demo_scene().lights().len());
    let scene = demo_scene();
    let options = ViewOptions {
        camera: scene.cameras[0].clone(),
        size_px: [160, 90],
        shadows: ShadowSettings { distance_m: 60.0, ..ShadowSettings::default() },
    };
    let page = inspected.page(scene.lights(), &options);
    let names: Vec<_> = page.drawings[0].outlines.iter().map(|outline| &*outline.name).collect();
    assert_eq!(names.len(), 1 + 4 + 3, "{names:?}");
    assert!(names[1].starts_with("cascade 0, 0.1 to ") && names.contains(&"light 2 (teal)"), "{names:?}");
    // Fitted to the visible depths on the GPU: the nearest cascade begins at the nearest surface.
    assert!(inspected.views[0].end_m < 60.0 && inspected.views[0].end_m > 0.0);
}

#[test]
fn two_renderers_record_the_same_contents_with_every_technique() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let mut shadows = ShadowSettings { distance_m: 60.0, ..ShadowSettings::default() };
    // Small maps, because all their texels are read back.
    (shadows.cascades.map_size_px, shadows.atlas.map_size_px) = (512, 512);
    shadows.techniques.set(&VirtualSettings { pool_mib: 8, ..VirtualSettings::default() }).unwrap();
    let options = ViewOptions { camera: camera.clone(), size_px: [160, 90], shadows };
    let techniques = Techniques::built_in();
    for kind in techniques.kinds() {
        let technique = techniques.find(kind.name).unwrap();
        let record = || {
            let mut renderer =
                Renderer::with_config(gpu, scene.clone(), &camera, Aov::Color, technique).unwrap();
            // What the first frame leaves is read by the second.
            renderer.draw(gpu, &options).unwrap();
            let mut recorder = ContentsRecorder::new(0);
            renderer.record_contents(gpu, &options, &mut recorder).unwrap();
            recorder.to_json().unwrap()
        };
        let (first, second) = (record(), record());
        let problems: Vec<_> =
            first.as_array().unwrap().iter().filter(|part| part["hash"].is_null()).collect();
        assert!(problems.is_empty(), "{}: {problems:?}", kind.name);
        assert_eq!(first, second, "{}", kind.name);
    }
}
