//! Loads every file of the shared directories of valid and of malformed glTF files, if they exist.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glam::Vec4;
use shadowgraph_scene::Scene;
use shadowgraph_scene::gltf;

/// The maximum time to load a file.
const MAX_TIME: Duration = Duration::from_secs(10);

/// Returns a directory of shared files, or logs that the test is skipped.
fn shared(name: &str) -> Option<PathBuf> {
    let shared = std::env::var_os("SHADOWGRAPH_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    let path = shared.join(name);
    if path.is_dir() {
        return Some(path);
    }
    skip(&name.replace('-', "_"), &format!("no directory {name} in SHADOWGRAPH_SHARED"));
    None
}

/// Logs a skipped test as `CONTRIBUTING.md` says.
fn skip(id: &str, reason: &str) {
    let line = format!("SKIP {id}: {reason}\n");
    print!("{line}");
    if let Some(log) = std::env::var_os("SHADOWGRAPH_SKIP_LOG") {
        let mut log = std::fs::OpenOptions::new().append(true).create(true).open(log).unwrap();
        log.write_all(line.as_bytes()).unwrap();
    }
}

fn files_below(directory: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut stack = vec![directory.to_owned()];
    while let Some(directory) = stack.pop() {
        for entry in std::fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            match path.extension().and_then(|extension| extension.to_str()) {
                _ if path.is_dir() => stack.push(path),
                Some("gltf" | "glb") => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// Asserts what a renderer may rely on in any loaded scene.
fn check(scene: &Scene, file: &Path) {
    let file = file.display();
    for (_, mesh) in scene.meshes() {
        assert!(!mesh.indices.is_empty() && mesh.indices.len() % 3 == 0, "{file}");
        assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.vertices.len()), "{file}");
        for vertex in &mesh.vertices {
            assert!(
                vertex.position.iter().chain(&vertex.uv0).chain(&vertex.uv1).all(|x| x.is_finite()),
                "{file}"
            );
            let length = |v: &[f32]| v.iter().map(|x| x * x).sum::<f32>().sqrt();
            assert!((length(&vertex.normal) - 1.0).abs() < 1e-3, "{file}: {:?}", vertex.normal);
            assert!((length(&vertex.tangent[..3]) - 1.0).abs() < 1e-3, "{file}: {:?}", vertex.tangent);
            assert!(vertex.tangent[3].abs() == 1.0, "{file}: {:?}", vertex.tangent);
        }
    }
    for (_, instance) in scene.instances() {
        let (mesh, material) = (scene.mesh(instance.mesh), scene.material(instance.material));
        assert!(mesh.is_some() && material.is_some(), "{file}");
        assert!(instance.world_from_local.is_finite(), "{file}");
    }
    for (_, material) in scene.materials() {
        let textures = [
            material.base_color_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.occlusion_texture,
            material.emissive_texture,
        ];
        assert!(textures.iter().flatten().all(|t| scene.image(t.image).is_some() && t.uv_set < 2), "{file}");
    }
    for (_, image) in scene.images() {
        assert_eq!(image.rgba8.len() as u64, u64::from(image.width) * u64::from(image.height) * 4, "{file}");
    }
    let kinds: Vec<u8> = scene.lights().iter().map(|light| light.kind.order()).collect();
    assert!(kinds.is_sorted(), "{file}: {kinds:?}");
    assert!(scene.notes.iter().all(|note| !note.contains('\n')), "{file}: {:?}", scene.notes);
}

#[test]
fn every_valid_scene_loads() {
    let Some(directory) = shared("scenes") else { return };
    let files = files_below(&directory);
    for file in &files {
        let start = Instant::now();
        let scene = gltf::load(file).unwrap();
        check(&scene, file);
        assert!(scene.instances().len() > 0 && !scene.bounds().is_empty(), "{}", file.display());
        println!(
            "{}: {} triangles, {} instances, {} images, {} lights, {} cameras, {:.2} s; {:?}",
            file.file_name().unwrap().display(),
            scene.triangle_count(),
            scene.instances().len(),
            scene.images().len(),
            scene.lights().len(),
            scene.cameras.len(),
            start.elapsed().as_secs_f64(),
            scene.notes
        );
    }
    assert!(files.len() >= 21, "{} scenes", files.len());
}

#[test]
fn every_malformed_file_loads_or_gives_one_line() {
    let Some(directory) = shared("bad-gltf") else { return };
    let files = files_below(&directory);
    for file in &files {
        let start = Instant::now();
        match gltf::load(file) {
            Ok(scene) => {
                check(&scene, file);
                println!("loads: {} {:?}", file.file_name().unwrap().display(), scene.notes);
            }
            Err(error) => {
                let line = error.to_string();
                assert!(!line.contains('\n') && line.starts_with(&file.display().to_string()), "{line}");
                println!("error: {}", line.trim_start_matches(&directory.display().to_string()));
            }
        }
        assert!(start.elapsed() < MAX_TIME, "{} took {:?}", file.display(), start.elapsed());
    }
    assert!(files.len() >= 119, "{} files", files.len());
}

#[test]
fn computed_tangents_agree_with_those_of_a_file() {
    let Some(directory) = shared("scenes") else { return };
    let scene = gltf::load(&directory.join("FlightHelmet.glb")).unwrap();
    for (_, instance) in scene.instances() {
        let map = scene.material(instance.material).unwrap().normal_texture.unwrap();
        let mut mesh = scene.mesh(instance.mesh).unwrap().clone();
        let expected: Vec<_> = mesh.vertices.iter().map(|vertex| Vec4::from(vertex.tangent)).collect();
        mesh.generate_tangents(map.uv_set, &map.uv_transform);
        let matching = mesh.vertices.iter().zip(&expected).filter(|(vertex, expected)| {
            let computed = Vec4::from(vertex.tangent);
            computed.w == expected.w && computed.truncate().dot(expected.truncate()) > 0.9
        });
        let fraction = matching.count() as f64 / expected.len() as f64;
        assert!(fraction > 0.98, "{:?}: {fraction}", mesh.name);
    }
}
