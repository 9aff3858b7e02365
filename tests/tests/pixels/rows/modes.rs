//! Shadow modes of materials and objects by name.

use super::{Greys, count, cube_view, greys, greys_with};
use crate::stage::{add_instance, box_mesh, cube_on_floor, gpu, material, nth_instance, nth_material, sun};
use glam::{DVec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::scene::{AlphaMode, Material, Scene};
use shadowgraph::shadows::{PCF, RAYTRACED, ShadowSettings};
use shadowgraph::{Renderer, ViewOptions};

/// Returns a sheet, 1.5 m above a floor under a vertical sun, and a view of both. Its alpha is 0.6.
fn sheet() -> (Scene, ViewOptions) {
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.remove_instance(nth_instance(&scene, 1)).unwrap();
    let mesh = scene.insert_mesh(box_mesh(DVec3::new(-1.0, 1.5, -1.0), DVec3::new(1.0, 1.51, 1.0)));
    let sheet = Material {
        name: "sheet of paper".into(),
        alpha: AlphaMode::Blend,
        base_color: Vec4::new(0.8, 0.8, 0.8, 0.6),
        ..material()
    };
    let sheet = scene.insert_material(sheet).unwrap();
    let sheet = add_instance(&mut scene, mesh, sheet, DVec3::ZERO);
    scene.edit_instance(sheet, |sheet| sheet.name = "sheet 1".into()).unwrap();
    let (floor, floor_material) = (nth_instance(&scene, 0), nth_material(&scene, 0));
    scene.edit_instance(floor, |floor| floor.name = "floor".into()).unwrap();
    scene.edit_material(floor_material, |floor| floor.name = "concrete".into()).unwrap();
    scene.insert_light(sun(DVec3::NEG_Y));
    let mut options = cube_view(|_| ());
    options.camera = crate::stage::camera(DVec3::new(0.0, 0.8, 3.5), DVec3::new(0.0, 0.0, 0.0));
    (scene, options)
}

fn settings(text: &str) -> ShadowSettings {
    let settings: ShadowSettings = ron::from_str(text).unwrap();
    settings.validate().unwrap();
    settings
}

fn dark(greys: &Greys) -> usize {
    count(greys, |grey| grey < 128)
}

#[test]
fn row_49_materials_have_modes_by_name() {
    let Some(gpu) = gpu() else { return };
    let (scene, options) = sheet();
    let dark = |text: &str| {
        let options = ViewOptions { shadows: settings(text), ..options.clone() };
        let [mapped, traced] =
            [PCF, RAYTRACED].map(|technique| dark(&greys_with(gpu, &scene, 0, &options, technique)));
        assert!(mapped.abs_diff(traced) < 100, "{text}: {mapped} {traced}");
        mapped
    };
    let whole = dark(r#"(materials: {"sheet*": (casts: On)})"#);
    assert!(whole > 1000);
    assert!(dark(r#"(materials: {"sheet*": (casts: Clip(0.5))})"#).abs_diff(whole) < 10);
    for none in [
        r#"(materials: {"sheet*": (casts: Clip(0.7))})"#,
        r#"(materials: {"sheet ?? *": (casts: Off)})"#,
        r#"(materials: {"sheet*": (casts: On), "*paper": (casts: Off)})"#,
        r#"(materials: {"sheet*": (casts: On), "concrete": (receives: false)})"#,
    ] {
        assert_eq!(dark(none), 0, "{none}");
    }
    assert!(dark(r#"(materials: {"*paper": (casts: Off), "sheet*": (casts: On)})"#).abs_diff(whole) < 10);
    let error = ron::from_str::<ShadowSettings>(r#"(materials: {"s*": (casts: Clip(1.5))})"#).unwrap();
    let error = error.validate().unwrap_err().to_string();
    assert_eq!(error, "invalid value: `materials.\"s*\".casts` is Clip(1.5); allowed: Clip(0 to 1)");
}

#[test]
fn row_49_modes_by_name_change_from_frame_to_frame_and_leave_the_scene_as_it_is() {
    let Some(gpu) = gpu() else { return };
    let (scene, mut options) = sheet();
    let mut renderer = Renderer::new(gpu, scene.clone(), &options.camera, Aov::Visibility(0)).unwrap();
    let mut images = Vec::new();
    for text in ["()", r#"(materials: {"*paper": (casts: Off)})"#, "()"] {
        options.shadows = settings(text);
        images.push(renderer.draw(gpu, &options).unwrap().image.rgba8);
    }
    assert!(images[0] != images[1] && images[0] == images[2]);
    assert!(*renderer.scene() == scene);
}

#[test]
fn row_50_objects_have_modes_by_name() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, mut options) = sheet();
    scene.edit_material(nth_material(&scene, 1), |sheet| sheet.alpha = AlphaMode::Opaque).unwrap();
    // From above, the sheet hides a part of its shadow.
    options.camera = crate::stage::camera(DVec3::new(0.0, 4.0, 3.0), DVec3::ZERO);
    let shadow = |text: &str| {
        let options = ViewOptions { shadows: settings(text), ..options.clone() };
        dark(&greys(gpu, &scene, 0, &options))
    };
    let seen = shadow("()");
    assert!(seen > 500);
    let alone = shadow(r#"(objects: {"sheet*": (casts: ShadowOnly)})"#);
    assert!(alone > seen + 500, "{alone} {seen}");
    assert_eq!(shadow(r#"(objects: {"sheet*": (casts: Off)})"#), 0);
    assert_eq!(shadow(r#"(objects: {"floor": (receives: false)})"#), 0);
    assert_eq!(shadow(r#"(objects: {"sheets": (casts: Off)})"#), seen, "another name");
}
