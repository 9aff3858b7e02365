//! The history of a pixel and its shadows, compared with images and with rays in f64 through all triangles. `SHADOWGRAPH_SOAK` is the number of
//! pixels of each scene, `SHADOWGRAPH_SOAK_SEED` the seed.

use std::collections::BTreeMap;

use glam::DVec3;
use shadowgraph::inspect::{PixelHistory, WriteEffect};
use shadowgraph::options::Aov;
use shadowgraph::scene::gltf;
use shadowgraph::scene::{AnimationSelection, CasterMode, Light, LightKind, Scene};
use shadowgraph::shadows::Techniques;
use shadowgraph::shadows::rays::ReceiverPoint;
use shadowgraph::{Gpu, RenderConfig, Renderer, SceneRays, ViewOptions};
use shadowgraph_quality::{PixelLight, PixelShadows, PixelSurface, Reachability, ShadowInspector};
use shadowgraph_samples::demo::demo_scene;
use shadowgraph_tests::random::Random;
use shadowgraph_tests::{shared, skip};

use crate::planted::from_env;
use crate::stage::{gpu, view};

/// Pixels of the demo and of a real scene, which has more lights and takes longer, if `SHADOWGRAPH_SOAK` is not set.
const PIXELS: u32 = 12;
const REAL_PIXELS: u32 = 3;

/// Hits whose distances differ by less than this, relative to the distance or to 1 m, are the same.
const SAME_DISTANCE: f64 = 2e-3;

fn history(gpu: &Gpu, renderer: &mut Renderer, options: &ViewOptions, pixel: [u32; 2]) -> PixelHistory {
    let (frame, history) = renderer.pixel_history(gpu, options, pixel).unwrap();
    let [x, y] = pixel;
    let index = (y * options.size_px[0] + x) as usize;
    let shown: Vec<f64> =
        frame.image.rgba8[4 * index..][..4].iter().map(|&byte| f64::from(byte) / 255.0).collect();
    assert_eq!(history.passes[0].writes[0].after[0].value, shown);
    history
}

#[test]
fn what_a_pass_of_the_history_reads_is_what_an_earlier_one_wrote() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let options = ViewOptions { size_px: [160, 90], ..view(scene.cameras[0].clone(), 60.0) };
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Color).unwrap();
    let mut random = Random::new(1);
    // The last one is that of hills far away.
    for number in 0..5 {
        let random = [random.below(160) as u32, random.below(90) as u32];
        let pixel = if number == 4 { [4, 40] } else { random };
        let history = history(gpu, &mut renderer, &options, pixel);
        let mut written = BTreeMap::new();
        for pass in history.passes.iter().rev() {
            for read in &pass.reads {
                let Some(texels) = written.get(&(read.resource.clone(), read.version)) else { continue };
                assert_eq!(texels, &read.texels, "{pixel:?}, {}: {}", pass.pass, read.resource);
            }
            for write in &pass.writes {
                written.insert((write.texture.clone(), write.version), write.after.clone());
            }
        }
        let passes: Vec<_> = history.passes.iter().map(|pass| pass.pass.as_str()).collect();
        assert_eq!(passes[..2], ["smooth/fxaa", "tonemap/tonemap"]);
        for write in history.passes.iter().flat_map(|pass| &pass.writes) {
            if write.texture == "geometry/depth" && write.effect == WriteEffect::Cleared {
                assert_eq!(write.after[0].value, [0.0], "{pixel:?}");
            }
        }
        let is_sky = history
            .passes
            .iter()
            .flat_map(|pass| &pass.writes)
            .any(|write| write.texture == "geometry/depth" && write.effect == WriteEffect::Cleared);
        assert!(is_sky || passes.contains(&"geometry/depth prepass"), "{passes:?}");
        assert!(history.to_text().contains("wrote tonemap/image v1: "));
    }
}

/// The corners of the triangles of an instance that casts shadows, in the world, and its name.
struct Caster {
    name: String,
    is_opaque: bool,
    triangles: Vec<[DVec3; 3]>,
}

fn casters(scene: &Scene) -> Vec<Caster> {
    let all = scene.instances().enumerate().filter_map(|(number, (_, instance))| {
        let (mesh, material) = (scene.mesh(instance.mesh)?, scene.material(instance.material)?);
        let mode = instance.caster_mode(material);
        if mode == CasterMode::Off {
            return None;
        }
        let posed = instance.pose.as_ref().map(|pose| mesh.posed_vertices(pose));
        let vertices = posed.as_deref().unwrap_or(&mesh.vertices);
        let corner = |&index: &u32| {
            let [x, y, z] = vertices[index as usize].position.map(f64::from);
            instance.world_from_local.transform_point3(DVec3::new(x, y, z))
        };
        let triangles = mesh.indices.as_chunks().0.iter();
        let triangles = triangles.map(|[a, b, c]| [a, b, c].map(corner)).collect();
        let name =
            if instance.name.is_empty() { format!("instance {number}") } else { instance.name.clone() };
        Some(Caster { name, is_opaque: mode == CasterMode::On, triangles })
    });
    all.collect()
}

/// Returns the distance to a triangle along a ray (Möller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", 1997).
fn distance(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (edge_b, edge_c) = (b - a, c - a);
    let p = direction.cross(edge_c);
    let determinant = edge_b.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let offset = (origin - a) / determinant;
    let (u, q) = (offset.dot(p), offset.cross(edge_b));
    let (v, t) = (direction.dot(q), edge_c.dot(q));
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// Returns the hits of a ray, the nearest of each caster, from near to far.
fn hits(casters: &[Caster], origin: DVec3, direction: DVec3, end_m: f64) -> Vec<(f64, &Caster)> {
    let nearest = |caster: &Caster| {
        let distances = caster.triangles.iter().filter_map(|&triangle| distance(origin, direction, triangle));
        distances.filter(|&distance| distance < end_m).reduce(f64::min)
    };
    let mut hits: Vec<_> = casters.iter().filter_map(|caster| Some((nearest(caster)?, caster))).collect();
    hits.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    hits
}

/// Asserts that a light's blocker is the nearest opaque surface; false if that depends on a texture.
fn assert_blocker(casters: &[Caster], origin: DVec3, light: &Light, found: &PixelLight) -> bool {
    let (direction, end_m) = match light.kind {
        LightKind::Directional { direction } => (-direction.normalize(), f64::INFINITY),
        LightKind::Spot { position_world, .. } | LightKind::Point { position_world, .. } => {
            let (direction, distance_m) = (position_world - origin).normalize_and_length();
            (direction, distance_m * (1.0 - 1.0 / 4096.0))
        }
    };
    let hits = hits(casters, origin, direction, end_m);
    let same = |a: f64, b: f64| (a - b).abs() <= SAME_DISTANCE * b.max(1.0);
    match (&found.blocker, hits.first()) {
        (None, None) => true,
        (_, Some((_, caster))) if !caster.is_opaque => false,
        (Some(blocker), Some(&(nearest_m, _))) => {
            assert!(same(f64::from(blocker.distance_m), nearest_m), "{blocker:?}, {nearest_m}");
            // Of two surfaces at one place either may be named.
            let names = hits.iter().filter(|(distance_m, _)| same(*distance_m, nearest_m));
            let names: Vec<_> = names.map(|(_, caster)| &caster.name).collect();
            assert!(names.contains(&&blocker.instance), "{blocker:?}, {names:?}");
            true
        }
        // A ray through an edge.
        (None, Some((nearest_m, _))) => panic!("no blocker, but at {nearest_m} m: {found:?}"),
        (Some(blocker), None) => panic!("{blocker:?}, but none"),
    }
}

/// Compares the shadows at random pixels with the images of all lights and with rays.
fn assert_shadows(gpu: &Gpu, (name, scene): (&str, &Scene), options: &ViewOptions, pixels: u32) {
    let config = &RenderConfig::default();
    let casters = casters(scene);
    let mut inspector = ShadowInspector::new(gpu, scene, options, config).unwrap();
    let images = (0u32..).zip(scene.lights()).map(|(number, _)| {
        let aov = Aov::Visibility(number);
        let mut renderer =
            Renderer::with_config(gpu, scene.clone(), &options.camera, aov, config.clone()).unwrap();
        renderer.draw(gpu, options).unwrap().image.rgba8
    });
    let images: Vec<Vec<u8>> = images.collect();
    let origin_world = scene.cameras.first().map_or(DVec3::ZERO, |camera| camera.position_world());
    let reach_m = SceneRays::new(scene, origin_world).unwrap().rays().max_coordinate_m();
    let mut random = Random::new(from_env("SHADOWGRAPH_SOAK_SEED", 0));
    let (mut reached, mut blocked, mut compared, mut wrong) = (0, 0, 0, 0);
    for _ in 0..from_env("SHADOWGRAPH_SOAK", pixels) {
        let [width, height] = options.size_px;
        let pixel = [random.below(width.into()) as u32, random.below(height.into()) as u32];
        let index = (pixel[1] * width + pixel[0]) as usize;
        let PixelShadows { surface, lights, .. } = inspector.shadows_at(pixel).unwrap();
        let Some(PixelSurface { position_world, normal, .. }) = surface else { continue };
        let (position, normal) = (DVec3::from(position_world), glam::Vec3::from(normal));
        let receiver = ReceiverPoint {
            position: (position - origin_world).as_vec3(),
            geometric_normal: normal,
            view_distance_m: position.distance(options.camera.position_world()) as f32,
        };
        let origin = position + normal.as_dvec3() * f64::from(receiver.offset_m(reach_m));
        for (found, light) in lights.iter().zip(scene.lights()) {
            if found.reach != Reachability::Reached {
                continue;
            }
            reached += 1;
            let shown = &images[found.light as usize][4 * index..][..3];
            assert_eq!(
                found.visibility.as_ref().map(|rgb| &rgb[..]),
                Some(shown),
                "{name}, {pixel:?}: {found:?}"
            );
            blocked += u32::from(found.blocker.is_some());
            compared += u32::from(assert_blocker(&casters, origin, light, found));
            if found.differs() && found.unshadowed.is_none() {
                wrong += 1;
                assert!(found.remedy.is_some(), "{name}, {pixel:?}: {found:?}");
            }
        }
    }
    println!(
        "{name}: {reached} lights at pixels, {blocked} blocked, {compared} compared with f64, {wrong} wrong, each with a setting"
    );
    assert!(blocked > 0 && compared * 2 > reached, "{name}: {reached}, {blocked}, {compared}");
}

/// The value of a fact of a light.
fn fact(light: &PixelLight, name: &str) -> Option<f32> {
    Some(*light.facts.iter().find(|fact| fact.name == name)?.values.first()?)
}

/// Asserts that the depths of a lookup are those of a ray, where the whole filter agrees with the ray.
fn assert_depths(light: &PixelLight, place: &str) -> bool {
    let texel_m = fact(light, "width of a texel").unwrap();
    let slope = fact(light, "slope that is followed").unwrap();
    // A stored surface may be as much in front as the receiver's plane changes over some texels.
    let tolerance_m = texel_m * (4.0 + 4.0 * slope);
    let in_front_m = fact(light, "stored surface in front by");
    match (light.visibility.unwrap(), light.ray.unwrap(), &light.blocker) {
        ([0, 0, 0], [0.0, 0.0, 0.0], Some(blocker)) => {
            // The stored surface is that nearest to the light, the blocker that nearest to the receiver.
            let in_front_m = in_front_m.unwrap();
            assert!(in_front_m > blocker.distance_m - tolerance_m, "{place}: {in_front_m}, {light:?}");
        }
        ([255, 255, 255], [1.0, 1.0, 1.0], None) => {
            assert!(in_front_m.is_none_or(|in_front_m| in_front_m < tolerance_m), "{place}: {light:?}");
        }
        _ => return false,
    }
    let [shown, at_point] =
        [light.visibility.unwrap()[0], (light.visibility_at_point.unwrap()[0] * 255.0) as u8];
    assert!(shown.abs_diff(at_point) <= 2, "{place}: {shown}, {at_point}");
    true
}

#[test]
fn facts_of_each_technique_agree_with_images_and_with_rays() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let options = ViewOptions { size_px: [160, 90], ..view(scene.cameras[0].clone(), 60.0) };
    for kind in Techniques::built_in().kinds() {
        let name = kind.name;
        let config = RenderConfig { technique: Some((*kind).into()), ..RenderConfig::default() };
        let mut inspector = ShadowInspector::new(gpu, &scene, &options, &config).unwrap();
        let mut random = Random::new(2);
        let (mut with_facts, mut compared) = (0, 0);
        for _ in 0..10 {
            let pixel = [random.below(160) as u32, random.below(90) as u32];
            let lights = inspector.shadows_at(pixel).unwrap().lights;
            for light in lights.iter().filter(|light| light.reach == Reachability::Reached) {
                with_facts += u32::from(!light.facts.is_empty());
                let has_depths = fact(light, "stored depth").is_some() && !matches!(name, "evsm" | "msm");
                compared += u32::from(has_depths && assert_depths(light, &format!("{name}, {pixel:?}")));
            }
        }
        println!("{name}: {with_facts} lights with facts, {compared} compared");
        assert_eq!(with_facts > 0, name != "none", "{name}");
        assert!(compared > 2 || matches!(name, "none" | "raytraced" | "evsm" | "msm"), "{name}: {compared}");
    }
}

#[test]
fn visibilities_and_blockers_of_random_pixels_are_those_of_images_and_of_rays() {
    let Some(gpu) = gpu() else { return };
    let mut scene = demo_scene();
    let options = view(scene.cameras[0].clone(), 100.0);
    assert_shadows(gpu, ("demo", &scene), &options, PIXELS);
    scene.set_time(AnimationSelection::All, 1.3).unwrap();
    let mut coarse = options.clone();
    (coarse.shadows.cascades.map_size_px, coarse.shadows.cascades.count) = (256, 1);
    assert_shadows(gpu, ("demo, moved, with a coarse map", &scene), &coarse, PIXELS);
}

#[test]
fn visibilities_and_blockers_of_a_real_scene_are_those_of_images_and_of_rays() {
    let Some(gpu) = gpu() else { return };
    let Some(scenes) = shared("scenes") else {
        return skip("scenes", "the scenes are not on this machine");
    };
    let scene = gltf::load(&scenes.join("kaykit_dungeon_hall.glb")).unwrap();
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
    let options = ViewOptions { size_px: [160, 90], ..view(camera, 60.0) };
    assert_shadows(gpu, ("kaykit_dungeon_hall", &scene), &options, REAL_PIXELS);
}
