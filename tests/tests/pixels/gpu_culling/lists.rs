//! The lists and the draws that the GPU writes.

use super::{Random, boxes};
use crate::stage::gpu;
use glam::DVec3;
use shadowgraph::core::{Graph, Subresource};
use shadowgraph::lighting::{CullPass, CullView};
use shadowgraph::scene::gpu::{CullFlags, GpuScene};
use shadowgraph::scene::{ConvexVolume, Plane, Scene};
use shadowgraph::{Gpu, wgpu};

/// Words of the arguments of a draw.
const ARGUMENTS: usize = 5;
/// Distance to a plane, metres, within which rounding decides.
const SLACK_M: f64 = 1e-3;

/// What the GPU wrote for one view: the first slot and the number of instances of each batch, and the list.
struct Written {
    draws: Vec<[u32; ARGUMENTS]>,
    list: Vec<u32>,
    count: u32,
}

fn cull(gpu: &Gpu, scene: &GpuScene, views: &[CullView]) -> Vec<Written> {
    let pass = CullPass::new(&gpu.device).unwrap();
    let mut graph = Graph::default();
    let mut frame = graph.frame();
    let culled = pass.add_to(&mut frame, scene, views, "test");
    let mut request = |buffer| frame.read_back_buffer(buffer, Subresource::FULL);
    let requests: Vec<_> =
        culled.groups.iter().map(|group| [&group.draws, &group.instances].map(&mut request)).collect();
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut executed = graph.compile(frame).unwrap().execute(&mut graph, &gpu.device, &mut encoder).unwrap();
    let texels: Vec<_> = requests
        .into_iter()
        .map(|requests| requests.map(|request| executed.read_back(request).unwrap()))
        .collect();
    gpu.queue.submit([encoder.finish()]);
    let inputs = scene.cull_inputs();
    let (batches, slots) = (inputs.batch_count as usize, inputs.slot_count as usize);
    let mut written = Vec::new();
    for (texels, views) in texels.into_iter().zip(views.chunks(32)) {
        let [draws, list] = texels.map(|texels| words(&texels.wait(&gpu.device).unwrap()));
        for view in 0..views.len() {
            let draws = &draws[..];
            let of_view = &draws[view * batches * ARGUMENTS..][..batches * ARGUMENTS];
            written.push(Written {
                draws: of_view.as_chunks().0.to_vec(),
                list: list[view * slots..][..slots].to_vec(),
                count: draws[views.len() * batches * ARGUMENTS + view],
            });
        }
    }
    written
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect()
}

/// Returns the distance by which the box of an instance reaches into the volume, metres; negative if it is outside.
fn reach_m(scene: &Scene, gpu: &GpuScene, number: u32, volume: &ConvexVolume) -> f64 {
    let key = gpu.instance(number).unwrap();
    let instance = scene.instance(key).unwrap();
    let corners = scene.mesh(instance.mesh).unwrap().bounds.corners();
    let corners = corners.map(|corner| instance.world_from_local.transform_point3(corner));
    let reach = |plane: &Plane| {
        corners.iter().map(|corner| plane.normal.dot(*corner) + plane.distance).fold(f64::MIN, f64::max)
    };
    volume.planes.iter().map(reach).fold(f64::MAX, f64::min)
}

fn random_volume(random: &mut Random) -> ConvexVolume {
    let planes = random.between(0.0, 25.0) as usize;
    let plane = |_| {
        let mut axis = || random.between(-1.0, 1.0);
        let normal = DVec3::new(axis(), axis(), axis()).normalize_or(DVec3::Y);
        Plane { normal, distance: random.between(-5.0, 40.0) }
    };
    ConvexVolume { planes: (0..planes).map(plane).collect() }
}

#[test]
fn lists_have_the_instances_of_each_volume_in_order() {
    let Some(gpu) = gpu() else { return };
    for seed in 0..6 {
        let mut random = Random(seed);
        let scene = boxes(&mut random, 700);
        let uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene, DVec3::new(7.0, 0.0, -3.0)).unwrap();
        let view = |_| CullView {
            name: String::new(),
            volume: random_volume(&mut random),
            required: CullFlags::SEEN.union(CullFlags::SOLID),
            excluded: CullFlags::default(),
        };
        let views: Vec<_> = (0..35).map(view).collect();
        let written = cull(gpu, &uploaded, &views);
        assert_eq!(written.len(), views.len());
        for (index, (view, written)) in views.iter().zip(&written).enumerate() {
            let mut found = Vec::new();
            for draw in &written.draws {
                let list = &written.list[draw[4] as usize..][..draw[1] as usize];
                assert!(list.is_sorted(), "view {index}");
                found.extend_from_slice(list);
            }
            assert!(found.is_sorted() && found.len() == written.count as usize, "view {index}");
            for number in 0..uploaded.instance_count() as u32 {
                let reach_m = reach_m(&scene, &uploaded, number, &view.volume);
                let is_found = found.binary_search(&number).is_ok();
                assert!(is_found || reach_m < SLACK_M, "view {index} lacks {number}: {reach_m}");
                assert!(!is_found || reach_m > -SLACK_M, "view {index} has {number}: {reach_m}");
            }
        }
    }
}
