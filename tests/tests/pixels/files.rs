//! A drawn file for each feature of glTF files.

use glam::DVec3;
use image::RgbaImage;
use shadowgraph::options::Aov;
use shadowgraph::scene::gltf::{self, LoadOptions};
use shadowgraph::scene::{Camera, LightKind, Scene};
use shadowgraph::{Gpu, RenderedFrame};
use shadowgraph_tests::features::{FEATURES, Feature, PLAIN};

use crate::stage::{SIZE_PX, draw, gpu, view};

fn feature(name: &str) -> Feature {
    *FEATURES.iter().find(|feature| feature.name == name).unwrap()
}

/// Loads the file of a feature with a variant of its materials.
fn load(feature: Feature, variant: Option<&str>) -> Scene {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("scene.glb");
    std::fs::write(&file, (feature.file)().glb()).unwrap();
    let options = LoadOptions { variant: variant.map(str::to_owned) };
    gltf::load_with(&file, &options, &mut |_| {}).unwrap()
}

fn draw_from(gpu: &Gpu, scene: Scene, camera: Camera) -> RenderedFrame {
    draw(gpu, scene, Aov::Color, &view(camera, 20.0))
}

fn drawn(gpu: &Gpu, scene: Scene) -> RenderedFrame {
    let camera = scene.cameras[0].clone();
    draw_from(gpu, scene, camera)
}

/// Returns the fraction of pixels that differ by more than 16 of 255 in a channel, percent.
fn different_percent(a: &RenderedFrame, b: &RenderedFrame) -> f64 {
    let pixels = a.image.rgba8.chunks_exact(4).zip(b.image.rgba8.chunks_exact(4));
    let count = pixels.len();
    let different = pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 16)).count();
    100.0 * different as f64 / count as f64
}

/// Returns the mean colour of a square of pixels around a point of the world.
fn color_at(frame: &RenderedFrame, camera: &Camera, point: DVec3) -> [f64; 3] {
    let [width, height] = frame.image.size_px.map(f64::from);
    let clip_from_world = camera.clip_from_view(width / height) * camera.view_from_world();
    let ndc = clip_from_world.project_point3(point);
    let (x, y) = ((ndc.x * 0.5 + 0.5) * width, (0.5 - ndc.y * 0.5) * height);
    let mut sum = [0.0; 3];
    for (dx, dy) in (-1..=1).flat_map(|x| (-1..=1).map(move |y| (x, y))) {
        let pixel = (y as i64 + dy) * width as i64 + x as i64 + dx;
        let rgba = &frame.image.rgba8[pixel as usize * 4..][..3];
        (0..3).for_each(|i| sum[i] += f64::from(rgba[i]) / 9.0);
    }
    sum
}

#[test]
fn compressed_and_converted_files_look_like_the_plain_one() {
    let Some(gpu) = gpu() else { return };
    let plain = drawn(gpu, load(PLAIN, None));
    for feature in FEATURES.iter().filter(|feature| feature.equals_plain) {
        let scene = load(*feature, None);
        assert_eq!(scene.notes, [""; 0], "{feature:?}");
        let percent = different_percent(&plain, &drawn(gpu, scene));
        println!("{feature:?}: {percent:.2} % of the pixels differ from those of the plain file");
        // Edges of quantized meshes move by a fraction of a pixel, and ETC1S blurs edges of the texture.
        let allowed = if feature.name == "ktx2_etc1s" { 1.5 } else { 0.4 };
        assert!(percent < allowed, "{feature:?}: {percent} %");
    }
}

#[test]
fn missing_images_are_notes_and_the_colour_of_the_factor() {
    let Some(gpu) = gpu() else { return };
    for name in ["no_image", "no_source"] {
        let scene = load(feature(name), None);
        assert!(!scene.notes.is_empty(), "{name}");
        let camera = scene.cameras[0].clone();
        let frame = drawn(gpu, scene);
        let [red, green, blue] = color_at(&frame, &camera, DVec3::new(0.0, 0.55, 0.35));
        assert!(green > red * 1.4 && green > blue * 1.2, "{name}: {red} {green} {blue}");
    }
}

#[test]
fn instanced_copies_stand_where_their_attributes_say() {
    let scene = load(feature("instances"), None);
    let vases: Vec<DVec3> = scene
        .instances()
        .filter(|(_, instance)| instance.name == "vase")
        .map(|(_, instance)| instance.world_from_local.translation)
        .collect();
    assert_eq!(vases.len(), 5);
    for (copy, position) in vases.iter().enumerate() {
        let x = copy as f64 - 2.0;
        assert!(position.abs_diff_eq(DVec3::new(x * 0.7, 0.0, -x.abs() * 0.4), 1e-6), "{copy}: {position}");
    }
    assert_eq!(scene.notes, [""; 0]);
}

#[test]
fn a_variant_changes_the_material_and_an_unknown_one_is_an_error() {
    let Some(gpu) = gpu() else { return };
    let variants = feature("variants");
    let scene = load(variants, None);
    assert!(scene.notes[0].contains("\"blue\", \"bare\""), "{:?}", scene.notes);
    let default = drawn(gpu, scene);
    assert!(different_percent(&default, &drawn(gpu, load(PLAIN, None))) < 0.01);
    let (blue, bare) = (drawn(gpu, load(variants, Some("blue"))), drawn(gpu, load(variants, Some("bare"))));
    assert!(different_percent(&default, &blue) > 5.0 && different_percent(&blue, &bare) > 5.0);
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("scene.glb");
    std::fs::write(&file, (variants.file)().glb()).unwrap();
    let options = LoadOptions { variant: Some("red".into()) };
    let error = gltf::load_with(&file, &options, &mut |_| {}).unwrap_err().to_string();
    assert!(error.ends_with("unknown variant \"red\"; expected one of: \"blue\", \"bare\""), "{error}");
}

#[test]
fn glass_casts_a_light_shadow_and_coloured_glass_a_coloured_one() {
    let Some(gpu) = gpu() else { return };
    // In the shadow of the vase, on the floor.
    let shadow = DVec3::new(0.75, 0.0, -0.3);
    let lit = DVec3::new(-0.7, 0.0, 0.2);
    let mut brightness = Vec::new();
    for name in ["glass", "stained_glass"] {
        let scene = load(feature(name), None);
        assert_eq!(scene.notes, [""; 0], "{name}");
        let camera = scene.cameras[0].clone();
        let frame = drawn(gpu, scene);
        let relative = |i: usize| color_at(&frame, &camera, shadow)[i] / color_at(&frame, &camera, lit)[i];
        brightness.push([relative(0), relative(1), relative(2)]);
    }
    let [clear, green] = brightness[..] else { panic!("two") };
    println!("clear {clear:?}, green {green:?}");
    assert!(clear.iter().all(|channel| (0.85..1.0).contains(channel)), "{clear:?}");
    assert!(green[1] > 0.8 && green[0] < 0.6 * green[1] && green[2] < 0.8 * green[1], "{green:?}");
}

#[test]
fn a_transmission_texture_leaves_opaque_parts() {
    let Some(gpu) = gpu() else { return };
    let scene = load(feature("label"), None);
    let camera = scene.cameras[0].clone();
    let (glass, label) = (drawn(gpu, load(feature("glass"), None)), drawn(gpu, scene));
    let at = |frame: &RenderedFrame, height: f64| color_at(frame, &camera, DVec3::new(-0.25, height, 0.3))[0];
    // The band of the label, and the glass above it.
    assert!(at(&label, 0.37) > at(&glass, 0.37) + 30.0, "{} {}", at(&label, 0.37), at(&glass, 0.37));
    assert!((at(&label, 0.6) - at(&glass, 0.6)).abs() < 12.0, "{} {}", at(&label, 0.6), at(&glass, 0.6));
}

#[test]
fn specular_glossiness_becomes_metal_where_its_highlights_are_coloured() {
    let materials = |name| load(feature(name), None).materials().map(|(_, m)| m.clone()).collect::<Vec<_>>();
    let gold = &materials("specular_glossiness")[1];
    assert!(gold.metallic > 0.95 && (gold.roughness - 0.4).abs() < 1e-6, "{gold:?}");
    let scene = load(feature("specular_glossiness_map"), None);
    let textured = scene.materials().nth(1).unwrap().1;
    let image = scene.image(textured.metallic_roughness_texture.unwrap().image).unwrap();
    let texel = |y: usize| &image.rgba8[y * image.width as usize * 4..][..4];
    // A ring, and the clay around it: roughness in green, metalness in blue.
    assert!(texel(20)[2] > 240 && texel(20)[1] == 255 - 190, "{:?}", texel(20));
    assert!(texel(4)[2] < 20 && texel(4)[1] == 255 - 60, "{:?}", texel(4));
}

#[test]
fn dark_vertex_colours_have_no_bands() {
    let scene = load(feature("vertex_colors"), None);
    let (_, vase) = scene.meshes().nth(1).unwrap();
    let mut reds: Vec<u16> = vase.vertices.iter().map(|vertex| vertex.color[0]).collect();
    reds.sort_unstable();
    reds.dedup();
    // A ring each; 8 bits would have 21 values.
    assert_eq!(reds.len(), 33);
}

#[test]
fn a_spot_light_with_swapped_cones_shines() {
    let scene = load(feature("spot"), None);
    let [note] = &scene.notes[..] else { panic!("{:?}", scene.notes) };
    assert!(note.contains("innerConeAngle"), "{note}");
    let LightKind::Spot { inner_angle, outer_angle, .. } = scene.lights()[0].kind else {
        panic!("a spot light")
    };
    assert_eq!(inner_angle, outer_angle);
}

#[test]
fn what_is_not_drawn_is_a_note() {
    for (name, text) in
        [("clearcoat", "KHR_materials_clearcoat is not drawn"), ("points", "points and lines")]
    {
        let notes = load(feature(name), None).notes;
        assert!(notes.len() == 1 && notes[0].contains(text), "{name}: {notes:?}");
    }
}

#[test]
fn a_sheet_of_every_feature() {
    const COLUMNS: u32 = 6;
    let Some(gpu) = gpu() else { return };
    let features: Vec<_> = [PLAIN].into_iter().chain(FEATURES).collect();
    let [width, height] = SIZE_PX;
    let rows = (features.len() as u32).div_ceil(COLUMNS);
    let mut sheet = RgbaImage::new(COLUMNS * width, rows * height);
    for (place, feature) in (0..).zip(features) {
        let frame = drawn(gpu, load(feature, None));
        let image = RgbaImage::from_raw(width, height, frame.image.rgba8).unwrap();
        let (x, y) = (place % COLUMNS * width, place / COLUMNS * height);
        image::imageops::replace(&mut sheet, &image, x.into(), y.into());
    }
    let dir = shadowgraph_tests::images().unwrap_or_else(|| env!("CARGO_TARGET_TMPDIR").into());
    let file = dir.join("files.png");
    sheet.save(&file).unwrap();
    println!("wrote {}", file.display());
}
