//! The cost of shadows: culling, draw lists, saved draws, and three pipelines with growing overdraw.
//!
//! `cargo bench --workspace --profile dev --bench shadows [-- SCENE.glb]`; the scene for the saved draws is by default
//! the demo scene. The profile is that of the tests, with optimised dependencies; `--profile release` builds everything again.
#![allow(missing_docs, clippy::print_stdout, reason = "it prints what it measures")]

use std::time::{Duration, Instant};

use glam::{DAffine3, DVec3};
use shadowgraph::Pipeline;
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::scene::gpu::{DrawList, GpuScene};
use shadowgraph::scene::{
    Aabb, Camera, CullTree, CullVolume, EditError, Instance, Light, LightKind, Material, Mesh, Projection,
    Scene, Vertex,
};
use shadowgraph::shadows::{
    CullSettings, MapPlan, OrthoFit, ShadowInputs, ShadowPlan, ShadowSettings, SpotCone, SpotFit,
    light_from_world, plan_shadows,
};
use shadowgraph::{Gpu, RenderConfig, Renderer, ViewOptions};

type Failure = Box<dyn std::error::Error>;

/// Repetitions of each measurement; medians are printed.
const ROUNDS: usize = 21;
/// Measured frames of each pipeline, in turn.
const FRAMES: usize = 9;
const BOXES: usize = 100_000;
const CITY_M: f64 = 2000.0;

fn main() -> Result<(), Failure> {
    let boxes = city();
    culling(&boxes)?;
    lists(&boxes)?;
    draws(std::env::args().skip(1).find(|argument| !argument.starts_with("--")))?;
    overdraw()
}

/// Culls the casters of four cascades and sixteen spot lights with the tree and with brute force.
fn culling(boxes: &[Aabb]) -> Result<(), Failure> {
    let (tree, volumes) = (CullTree::new(boxes), shadow_volumes()?);
    let mut found = [vec![Vec::new(); volumes.len()], vec![Vec::new(); volumes.len()]];
    let mut times = Vec::new();
    for _ in 0..ROUNDS {
        let [each, by_tree] = &mut found;
        let each = time(|| {
            for (volume, found) in volumes.iter().zip(each) {
                found.clear();
                let items = (0u32..).zip(boxes).filter(|(_, bounds)| volume.planes.intersects(bounds));
                found.extend(items.map(|(item, _)| item));
            }
        });
        let by_tree = time(|| {
            for (volume, found) in volumes.iter().zip(by_tree) {
                found.clear();
                tree.query(volume, found);
            }
        });
        times.push((each, by_tree));
    }
    assert_eq!(found[0], found[1], "the lists differ");
    let hits: usize = found[0].iter().map(Vec::len).sum();
    let faster = median(times.iter().map(|(each, tree)| each.as_secs_f64() / tree.as_secs_f64()));
    println!("culling {BOXES} casters for 4 cascades and 16 spots: {hits} found, the same lists");
    println!(
        "  brute force {:.1?}, tree {:.2?}: {faster:.0} times faster\n",
        median(times.iter().map(|(each, _)| *each)),
        median(times.iter().map(|(_, tree)| *tree))
    );
    Ok(())
}

/// Culls many instances for a moving camera, and builds the draw list.
fn lists(boxes: &[Aabb]) -> Result<(), Failure> {
    let (device, queue) = Gpu::noop().map(|gpu| (gpu.device, gpu.queue))?;
    let scene = GpuScene::new(&device, &queue, &city_scene(boxes)?, DVec3::ZERO)?;
    let (mut numbers, mut list) = (Vec::new(), DrawList::default());
    let mut frame = |frame: usize| {
        let camera = camera(frame);
        let volume = camera.frustum(1.5).into();
        let begin = Instant::now();
        let allocated = allocation_counter::measure(|| {
            numbers.clear();
            scene.cull(&volume, &mut numbers);
            scene.draw_list_into(&numbers, camera.position_world(), &mut list);
        });
        (begin.elapsed(), allocated.count_total, list.solid.len())
    };
    // The first round warms the lists.
    for index in 0..200 {
        let _warm = frame(index);
    }
    let measured: Vec<_> = (0..200).map(frame).collect();
    let seen = measured.iter().map(|(_, _, seen)| seen).sum::<usize>() / measured.len();
    let allocations: u64 = measured.iter().map(|(_, count, _)| count).sum();
    println!("{BOXES} instances, {seen} visible to a moving camera: culling and draw list");
    println!(
        "  {:.2?} per frame, {allocations} allocations in 200 frames\n",
        median(measured.iter().map(|m| m.0))
    );
    Ok(())
}

/// Counts the draws of a scene's shadow maps, with and without culling casters that do not matter.
fn draws(file: Option<String>) -> Result<(), Failure> {
    let scene = match &file {
        Some(file) => shadowgraph::scene::gltf::load(std::path::Path::new(file))?,
        None => shadowgraph_samples::demo::demo_scene(),
    };
    println!("draws of shadow maps, {}", file.as_deref().unwrap_or("the demo scene"));
    let cameras =
        if scene.cameras.is_empty() { vec![scene.framing_camera(1.5)] } else { scene.cameras.clone() };
    let gpu = Gpu::noop()?;
    for (number, camera) in cameras.iter().enumerate() {
        let renderer = Renderer::new(&gpu, scene.clone(), camera, Aov::Color)?;
        let draws = |cull: CullSettings| -> Result<usize, Failure> {
            let settings = ShadowSettings { cull, ..ShadowSettings::default() };
            let casters = renderer.casters();
            let origin_world = casters.scene.origin_world();
            let lights = renderer.scene().lights();
            let settings = &settings;
            let inputs =
                ShadowInputs { view: 0, camera, aspect: 1.5, lights, casters, origin_world, settings };
            Ok(count(&plan_shadows(&inputs)?))
        };
        let all = draws(CullSettings::NONE)?;
        let (seen, kept) =
            (draws(CullSettings { unseen: true, covered: false })?, draws(CullSettings::default())?);
        let saved = |kept: usize| 100.0 - 100.0 * kept as f64 / all.max(1) as f64;
        println!(
            "  camera {number}: {all} in reach, {seen} that affect visible receivers (-{:.0} %), {kept} without those \
             covered by finer cascades (-{:.0} %)",
            saved(seen),
            saved(kept)
        );
    }
    println!();
    Ok(())
}

/// Measures a frame of each pipeline with layers that occlude each other, the farthest drawn first.
fn overdraw() -> Result<(), Failure> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    println!("a frame at 640x360 by layers of overdraw, 5x5 filter, on {}", gpu.adapter.name);
    println!(
        "  {:>6}{:>12}{:>12}{:>16}{:>22}",
        "layers", "minimal", "minimal_lit", "screen_shadows", "screen / minimal_lit"
    );
    for layers in [1, 2, 4, 8] {
        let scene = layered(layers)?;
        let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: Some(100.0) };
        let camera = Camera::look_at(DVec3::new(0.0, 0.0, 6.0), DVec3::ZERO, DVec3::Y, projection);
        let shadows = ShadowSettings { distance_m: 30.0, ..ShadowSettings::default() };
        let options = ViewOptions { camera, size_px: [640, 360], shadows };
        let pipelines = [Pipeline::minimal(), Pipeline::minimal_lit(), Pipeline::screen_shadows()];
        let mut renderers = Vec::new();
        for pipeline in pipelines {
            let config = RenderConfig::from(pipeline);
            renderers.push(Renderer::with_config(&gpu, scene.clone(), &options.camera, Aov::Color, config)?);
        }
        let mut times = vec![Vec::new(); 3];
        for round in 0..FRAMES + 2 {
            for (renderer, times) in renderers.iter_mut().zip(&mut times) {
                let begin = Instant::now();
                renderer.draw(&gpu, &options)?;
                // The first frames create pipelines.
                if round > 1 {
                    times.push(begin.elapsed());
                }
            }
        }
        let ratio = times[2]
            .iter()
            .zip(&times[1])
            .map(|(screen, forward)| screen.as_secs_f64() / forward.as_secs_f64());
        let ratio = median(ratio);
        let [minimal, forward, screen] = [0, 1, 2].map(|i| median(times[i].iter().copied()));
        println!("  {layers:>6}{minimal:>12.1?}{forward:>12.1?}{screen:>16.1?}{ratio:>22.2}");
    }
    Ok(())
}

fn count(plan: &ShadowPlan) -> usize {
    let tiles = |map: &Option<MapPlan>| {
        map.as_ref().map_or(0, |map| map.tiles.iter().map(|tile| tile.casters.len()).sum::<usize>())
    };
    tiles(&plan.cascades) + tiles(&plan.atlas)
}

fn shadow_volumes() -> Result<Vec<CullVolume>, Failure> {
    let sun = light_from_world(DVec3::new(-0.4, -0.8, -0.3)).ok_or("no direction")?;
    let eye = DVec3::new(120.0, 1.7, -80.0);
    let sphere = |radius_m| shadowgraph::scene::BoundingSphere { center_world: eye, radius_m };
    let cascades = [10.0, 30.0, 90.0, 150.0]
        .map(|radius| OrthoFit::new(sun, sphere(radius), 2048, 5.0).cull_volume().into());
    let mut random = Random(11);
    let mut volumes = cascades.to_vec();
    for _ in 0..16 {
        let position_world =
            eye + (random.point() - DVec3::splat(0.5)) * DVec3::new(400.0, 0.0, 400.0) + DVec3::Y * 4.0;
        let direction = (random.point() - DVec3::new(0.5, 1.0, 0.5)).normalize();
        let cone =
            SpotCone { position_world, direction, half_angle: 0.2 + 0.6 * random.number(), range_m: 20.0 };
        let axes = light_from_world(direction).ok_or("no direction")?;
        volumes.push(SpotFit::new(cone, axes, 0.05, 512, 5.0).cull_volume().into());
    }
    Ok(volumes)
}

/// Returns a camera that flies through the city and sees about a tenth of it.
fn camera(frame: usize) -> Camera {
    let along = frame as f64 * 2.0;
    let eye = DVec3::new(along - 200.0, 30.0, 0.4 * along);
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: Some(700.0) };
    Camera::look_at(eye, eye + DVec3::new(1.0, -0.1, 0.2), DVec3::Y, projection)
}

/// Returns buildings of 1 to 10 m, and as many small objects of 0.1 to 1 m.
fn city() -> Vec<Aabb> {
    let mut random = Random(7);
    let boxes = (0..BOXES).map(|number| {
        let scale = if number % 2 == 0 { 10.0 } else { 1.0 };
        let size = random.point() * 0.9 * scale + DVec3::splat(0.1 * scale);
        let at = (random.point() - DVec3::splat(0.5)) * CITY_M;
        Aabb { min: at.with_y(0.0), max: at.with_y(0.0) + size }
    });
    boxes.collect()
}

/// Returns a scene with an instance of a unit quad for each box, with eight materials.
fn city_scene(boxes: &[Aabb]) -> Result<Scene, EditError> {
    let mut scene = Scene::default();
    let quad = scene.insert_mesh(quad());
    let materials: Vec<_> =
        (0..8).map(|_| scene.insert_material(Material::default())).collect::<Result<_, _>>()?;
    for (bounds, &material) in boxes.iter().zip(materials.iter().cycle()) {
        let transform =
            DAffine3::from_translation(bounds.min) * DAffine3::from_scale(bounds.max - bounds.min);
        scene.insert_instance(Instance::new(quad, material, transform))?;
    }
    Ok(scene)
}

/// Returns a scene with walls that fill the image, the farthest first, and posts in front of them.
fn layered(layers: usize) -> Result<Scene, EditError> {
    let mut scene = Scene::default();
    let quad = scene.insert_mesh(quad());
    let material = || Material { double_sided: true, metallic: 0.0, ..Material::default() };
    // Draws are ordered by material: the farthest has the first.
    for layer in 0..layers {
        let material = scene.insert_material(material())?;
        let corner = DVec3::new(-8.0, -5.0, 0.3 * layer as f64 - 3.0);
        let transform =
            DAffine3::from_translation(corner) * DAffine3::from_scale(DVec3::new(16.0, 10.0, 1.0));
        scene.insert_instance(Instance::new(quad, material, transform))?;
    }
    let post = scene.insert_material(material())?;
    for number in -4..5 {
        let transform = DAffine3::from_translation(DVec3::new(f64::from(number), -1.5, 0.8))
            * DAffine3::from_scale(DVec3::new(0.3, 3.0, 1.0));
        scene.insert_instance(Instance::new(quad, post, transform))?;
    }
    scene.insert_light(Light {
        name: None,
        kind: LightKind::Directional { direction: DVec3::new(0.3, -0.4, -1.0).normalize() },
        color: glam::Vec3::ONE,
        intensity: 10_000.0,
        casts_shadow: true,
    });
    Ok(scene)
}

/// Returns the unit square at z = 0, facing +Z.
fn quad() -> Mesh {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let vertex = |[x, y]: [f32; 2]| Vertex {
        position: [x, y, 0.0],
        normal: [0.0, 0.0, 1.0],
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv0: [x, y],
        uv1: [0.0; 2],
        color: Vertex::WHITE,
    };
    Mesh::new("quad", corners.map(vertex).to_vec(), vec![0, 1, 2, 0, 2, 3])
}

fn time(work: impl FnOnce()) -> Duration {
    let begin = Instant::now();
    work();
    begin.elapsed()
}

fn median<T: PartialOrd + Copy>(values: impl Iterator<Item = T>) -> T {
    let mut values: Vec<T> = values.collect();
    values.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    values[values.len() / 2]
}

/// Deterministic pseudo-random numbers.
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }
}
