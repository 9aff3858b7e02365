//! Animated files: transforms and vertices agree with a reference in f64, and images with those of meshes that are deformed on the CPU.

mod sequence;
mod truck;

use glam::{DAffine3, DVec3};
use shadowgraph::lighting::PosePass;
use shadowgraph::options::Aov;
use shadowgraph::scene::animation::{Channel, LocalTransform, Node};
use shadowgraph::scene::gpu::GpuScene;
use shadowgraph::scene::{AnimationSelection, Attachment, Hierarchy, LightKind, Scene};
use shadowgraph::shadows::{RAYTRACED, SplitScheme, VertexBuffers};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_core::{Graph, Subresource};
use shadowgraph_tests::animated::{self, CUBIC, MORPHED, RIGID, SKINNED, SKINNED_BY_EIGHT};

use crate::raytraced::traced_by;
use crate::stage::{camera, floor_mesh, gpu, light, material, sun, sun_direction, view};

/// The times of the frames, seconds: before the start, at it, between keyframes, at the end and after it.
const TIMES_S: [f64; 7] = [-1.0, 0.0, 0.2, 0.4, 0.8, 1.0, 7.5];

/// Reads the deformed vertices of a scene's first instance back from the GPU, and returns their positions and normals in the world.
fn posed(gpu: &Gpu, scene: &Scene, pass: &PosePass) -> Vec<[DVec3; 2]> {
    let uploaded = GpuScene::new(&gpu.device, &gpu.queue, scene, DVec3::ZERO).unwrap();
    let mut graph = Graph::default();
    let mut frame = graph.frame();
    pass.add_to(&mut frame, &uploaded);
    let VertexBuffers(buffers) = VertexBuffers::published_in(&frame);
    let request = frame.read_back_buffer(&buffers[0], Subresource::FULL);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame).unwrap().execute(&mut graph, &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let bytes = executed.read_back(request).unwrap().wait(&gpu.device).unwrap();
    let (_, instance) = scene.instances().next().unwrap();
    let count = scene.mesh(instance.mesh).unwrap().vertices.len();
    let first = uploaded.draw_for(0).unwrap().posed.unwrap() as usize;
    let words: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
    let vector = |word: usize| DVec3::new(words[word].into(), words[word + 1].into(), words[word + 2].into());
    let vertex = |index: usize| {
        let normal = instance.world_from_local.transform_vector3(vector(index * 16 + 3));
        [instance.world_from_local.transform_point3(vector(index * 16)), normal]
    };
    (first..first + count).map(vertex).collect()
}

#[test]
fn deformed_vertices_are_within_a_tenth_of_a_millimetre_of_a_reference_in_f64() {
    let Some(gpu) = gpu() else { return };
    let pass = PosePass::new(&gpu.device).unwrap();
    for kind in [SKINNED, SKINNED_BY_EIGHT, MORPHED] {
        let mut scene = (kind.file)().load();
        for time_s in TIMES_S {
            scene.set_time(AnimationSelection::All, time_s).unwrap();
            let found = posed(gpu, &scene, &pass);
            let expected = (kind.vertices)(time_s.clamp(0.0, 1.0));
            assert_eq!(found.len(), expected.len(), "{}", kind.name);
            for (found, expected) in found.iter().zip(&expected) {
                for (found, expected) in found.iter().zip(expected) {
                    let error = found.distance(*expected);
                    assert!(error < 1e-4, "{} at {time_s} s: {found} for {expected}", kind.name);
                }
            }
            let bounds = scene.bounds();
            assert!(expected.iter().all(|[position, _]| bounds.contains_point(*position)), "{}", kind.name);
        }
    }
}

#[test]
fn joints_are_within_a_tenth_of_a_millimetre_of_a_reference_in_f64() {
    for kind in [SKINNED, SKINNED_BY_EIGHT] {
        let mut scene = (kind.file)().load();
        for time_s in TIMES_S {
            scene.set_time(AnimationSelection::All, time_s).unwrap();
            let (_, instance) = scene.instances().next().unwrap();
            let joints = &instance.pose.as_ref().unwrap().joints;
            let expected = animated::skinned_joints(time_s.clamp(0.0, 1.0));
            assert_eq!(joints.len(), expected.len());
            for (joint, expected) in joints.iter().zip(expected) {
                let found = instance.world_from_local * *joint;
                assert!(found.abs_diff_eq(expected, 1e-4), "{kind:?} at {time_s} s: {found} for {expected}");
            }
        }
    }
}

#[test]
fn transforms_are_within_a_tenth_of_a_millimetre_of_a_reference_in_f64() {
    for kind in [RIGID, CUBIC] {
        let mut scene = (kind.file)().load();
        for time_s in TIMES_S {
            scene.set_time(AnimationSelection::All, time_s).unwrap();
            let (_, instance) = scene.instances().next().unwrap();
            let vertices = &scene.mesh(instance.mesh).unwrap().vertices;
            for (vertex, [expected, _]) in vertices.iter().zip((kind.vertices)(time_s.clamp(0.0, 1.0))) {
                let local = DVec3::from(vertex.position.map(f64::from));
                let found = instance.world_from_local.transform_point3(local);
                assert!(
                    found.distance(expected) < 1e-4,
                    "{} at {time_s} s: {found} for {expected}",
                    kind.name
                );
            }
        }
    }
}

/// Adds a floor, a sun, a spot light and a point light to a scene.
fn staged(mut scene: Scene) -> Scene {
    scene.add(floor_mesh(20.0), material(), DAffine3::IDENTITY).unwrap();
    scene.insert_light(sun(sun_direction(50.0, 30.0)));
    let position_world = DVec3::new(3.0, 5.0, 2.0);
    let direction = (DVec3::Y - position_world).normalize();
    let range = Some(20.0);
    let spot = LightKind::Spot { position_world, direction, range, inner_angle: 0.5, outer_angle: 0.7 };
    scene.insert_light(light(spot, 3000.0));
    let position_world = DVec3::new(-3.0, 4.0, 2.0);
    scene.insert_light(light(LightKind::Point { position_world, range }, 2000.0));
    scene
}

/// Returns an animated scene with copies of its nodes and what moves with them, moved along Z.
fn repeated(scene: &Scene, distances_m: &[f64]) -> Scene {
    let mut repeated = scene.clone();
    repeated.hierarchy = Hierarchy::default();
    repeated.hierarchy.animations = scene.hierarchy.animations.clone();
    for animation in &mut repeated.hierarchy.animations {
        animation.channels.clear();
    }
    for (copy, distance_m) in distances_m.iter().enumerate() {
        let (from, to) = (&scene.hierarchy, &mut repeated.hierarchy);
        // A new root above the old ones.
        let root = to.nodes.len();
        let local = LocalTransform::Matrix(DAffine3::from_translation(DVec3::Z * *distance_m));
        to.nodes.push(Node { name: String::new(), parent: None, local, weights: Vec::new(), skin: None });
        to.nodes.extend(from.nodes.iter().cloned().map(|node| Node {
            parent: Some(node.parent.map_or(root, |parent| root + 1 + parent)),
            skin: node.skin.map(|skin| skin + to.skins.len()),
            ..node
        }));
        to.skins.extend(from.skins.iter().cloned().map(|mut skin| {
            skin.joints.iter_mut().for_each(|joint| *joint += root + 1);
            skin
        }));
        for (from, to) in from.animations.iter().zip(&mut to.animations) {
            to.channels
                .extend(from.channels.iter().cloned().map(|it| Channel { node: it.node + root + 1, ..it }));
        }
        for Attachment { node, object } in &from.instances {
            let object = match copy {
                0 => *object,
                _ => repeated.insert_instance(scene.instance(*object).unwrap().clone()).unwrap(),
            };
            repeated.hierarchy.instances.push(Attachment { node: node + root + 1, object });
        }
    }
    repeated.set_time(AnimationSelection::All, 0.0).unwrap();
    repeated
}

/// Returns the scene with its deformed meshes replaced by meshes of the same shape.
fn baked(scene: &Scene) -> Scene {
    let mut baked = scene.clone();
    for (key, instance) in scene.instances() {
        let Some(pose) = &instance.pose else { continue };
        let mut mesh = scene.mesh(instance.mesh).unwrap().clone();
        mesh.vertices = mesh.posed_vertices(pose);
        (mesh.skin, mesh.morph_targets) = (None, Vec::new());
        let mesh = shadowgraph::scene::Mesh::new("baked", mesh.vertices, mesh.indices);
        let mesh = baked.insert_mesh(mesh);
        baked.edit_instance(key, |instance| (instance.mesh, instance.pose) = (mesh, None)).unwrap();
    }
    baked
}

/// Draws a renderer's scene at these times, and asserts that each image is that of a new scene in which the same shapes stand.
fn drawn_as_new(gpu: &Gpu, renderer: &mut Renderer, options: &ViewOptions, times_s: [f64; 5], name: &str) {
    let (scene, aov) = (renderer.scene().clone(), renderer.aov().clone());
    let mut reference = Renderer::new(gpu, scene, &options.camera, aov.clone()).unwrap();
    let mut images = Vec::new();
    for time_s in times_s {
        renderer.scene_mut().set_time(AnimationSelection::All, time_s).unwrap();
        reference.set_scene(gpu, baked(renderer.scene())).unwrap();
        let [found, expected] =
            [&mut *renderer, &mut reference].map(|renderer| renderer.draw(gpu, options).unwrap().image.rgba8);
        let differs = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).any(|i| a[i].abs_diff(b[i]) > 8);
        let pixels = found.as_chunks::<4>().0.iter().zip(expected.as_chunks::<4>().0);
        let differing = pixels.filter(|pair| differs(*pair)).count();
        assert!(differing <= 14, "{name} {aov:?} at {time_s} s: {differing} pixels");
        assert!(!images.contains(&found), "{name} {aov:?} at {time_s} s is as before");
        images.push(found);
    }
}

#[test]
fn images_and_shadows_are_at_five_times_those_of_a_new_scene() {
    let Some(gpu) = gpu() else { return };
    let mut options = view(camera(DVec3::new(3.0, 3.0, 6.0), DVec3::Y), 60.0);
    options.size_px = [160, 90];
    // The bounds of a pose are wider than those of its shape, and other splits begin where these do.
    options.shadows.cascades.split = SplitScheme::Standard;
    for kind in [RIGID, CUBIC, SKINNED, MORPHED] {
        // One in each of the cascades.
        let scene = staged(repeated(&(kind.file)().load(), &[0.0, -6.0, -25.0]));
        for aov in [Aov::Color, Aov::Visibility(0), Aov::Visibility(1), Aov::Visibility(2)] {
            let mut renderer = Renderer::new(gpu, scene.clone(), &options.camera, aov).unwrap();
            drawn_as_new(gpu, &mut renderer, &options, [0.0, 0.2, 0.4, 0.6, 1.0], kind.name);
        }
    }
}

#[test]
fn gpu_rays_follow_animations_as_rays_of_the_cpu_do() {
    let Some(gpu) = gpu() else { return };
    let mut options = view(camera(DVec3::new(3.0, 3.0, 6.0), DVec3::Y), 30.0);
    options.size_px = [160, 90];
    let (mut unlike, mut compared) = (0, 0);
    for kind in [RIGID, CUBIC, SKINNED, SKINNED_BY_EIGHT, MORPHED] {
        let scene = staged((kind.file)().load());
        let mut renderer =
            Renderer::with_config(gpu, scene, &options.camera, Aov::Visibility(0), RAYTRACED).unwrap();
        let mut images = Vec::new();
        for time_s in [0.0, 0.4, 1.0] {
            renderer.scene_mut().set_time(AnimationSelection::All, time_s).unwrap();
            let traced = traced_by(gpu, &mut renderer, &options, 0);
            let (differ, of) = traced.unlike_the_cpu();
            println!("{} at {time_s} s: {differ} of {of} pixels differ", kind.name);
            (unlike, compared) = (unlike + differ, compared + of);
            images.push(traced.visibility);
        }
        assert!(images[0] != images[1] && images[1] != images[2], "{} moves", kind.name);
    }
    assert!(compared > 50_000 && unlike * 10_000 <= compared, "{unlike} of {compared} pixels differ");
}

#[test]
fn a_deformed_mesh_far_from_where_it_rests_is_drawn_with_its_shadow() {
    let Some(gpu) = gpu() else { return };
    let mut options = view(camera(DVec3::new(3.0, 3.0, 6.0), DVec3::Y), 30.0);
    options.size_px = [160, 90];
    let draw = |scene: Scene| {
        let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(0)).unwrap();
        renderer.draw(gpu, &options).unwrap().image.rgba8
    };
    let near = draw(staged((SKINNED.file)().load()));
    // The mesh rests 500 m away; its joints move it back.
    let mut file = (SKINNED.file)();
    animated::move_rest(&mut file, 500.0);
    let far = draw(staged(file.load()));
    let differing =
        near.as_chunks::<4>().0.iter().zip(far.as_chunks::<4>().0).filter(|(a, b)| a != b).count();
    assert!(differing <= 14, "{differing} pixels");
}
