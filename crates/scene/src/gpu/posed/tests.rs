#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::mesh::{MorphTarget, SkinWeights};
use glam::DVec3;

#[test]
fn structs_have_the_layout_of_the_wgsl_structs() {
    let module = shadowgraph_shaders::compose("pose.wgsl", &[]).unwrap();
    shadowgraph_shaders::check_layout!(&module, "Job", Job:
        rest_vertex, posed_vertex, vertex_count, first_influence, influences_per_vertex, first_joint,
        first_delta, first_weight, weight_count, previous_first_joint, previous_first_weight,
    )
    .unwrap();
    shadowgraph_shaders::check_layout!(&module, "Influence", Influence: joint, weight).unwrap();
    let fields = [("row_x", 0), ("row_y", 16), ("row_z", 32)];
    shadowgraph_shaders::layout::check(&module, "Joint", size_of::<[Vec4; 3]>(), &fields).unwrap();
    assert_eq!((size_of::<Vertex>(), size_of::<MorphDelta>()), (16 * 4, 9 * 4), "words in pose.wgsl");
}

/// A mesh with a skin of `joints` joints and one morph target.
fn mesh(vertices: usize) -> Mesh {
    let mut mesh = Mesh::new("", vec![Vertex::default(); vertices], vec![0, 1, 2]);
    let influences = vec![Influence { joint: 0, weight: 1.0 }; vertices * 4];
    mesh.skin = Some(SkinWeights::new(influences, 4, &mesh.vertices).unwrap());
    mesh.morph_targets = vec![MorphTarget::new(vec![MorphDelta::default(); vertices])];
    mesh
}

fn pose(x: f64) -> MeshPose {
    MeshPose { joints: [DAffine3::from_translation(DVec3::X * x)].into(), weights: vec![0.5] }
}

#[test]
fn instances_share_the_mesh_and_have_their_own_vertices_until_they_are_removed() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let gpu = (&device, &queue);
    let mut scene = crate::Scene::default();
    let mesh_key = scene.insert_mesh(mesh(100));
    let material = scene.insert_material(crate::Material::default()).unwrap();
    let mut insert = || {
        let instance = crate::Instance::new(mesh_key, material, DAffine3::IDENTITY);
        scene.insert_instance(instance).unwrap()
    };
    let (first, second) = (insert(), insert());
    let mut posed = PosedGeometry::new(&device).unwrap();
    assert!(posed.inputs().is_none());
    let hundred = mesh(100);
    let update = |posed: &mut PosedGeometry, key, x, version| {
        let updated = posed.update(gpu, key, (mesh_key, &hundred, version), &pose(x)).unwrap();
        posed.flush(&device, &queue).unwrap();
        updated
    };
    let base = update(&mut posed, first, 1.0, 7).0;
    assert_eq!(update(&mut posed, first, 1.0, 7), (base, false));
    assert_eq!(update(&mut posed, first, 2.0, 7), (base, true));
    let other = update(&mut posed, second, 3.0, 7).0;
    assert!(base.abs_diff(other) >= 200);
    let job = |posed: &PosedGeometry, index: usize| posed.jobs[index];
    assert_eq!(job(&posed, 0).rest_vertex, job(&posed, 1).rest_vertex);
    assert_eq!([0, 1].map(|index| job(&posed, index).posed_vertex), [base, other]);
    assert_eq!(posed.workgroups, [[0, 0], [0, 64], [1, 0], [1, 64]]);
    let x = |posed: &PosedGeometry, first: u32| posed.joints[first as usize][0].w;
    let joints = |posed: &PosedGeometry| {
        [0, 1]
            .map(|index| job(posed, index))
            .map(|job| [job.first_joint, job.previous_first_joint].map(|first| x(posed, first)))
    };
    assert_eq!(joints(&posed), [[2.0, 1.0], [3.0, 3.0]]);
    posed.begin_frame();
    posed.flush(&device, &queue).unwrap();
    assert_eq!(joints(&posed), [[2.0, 2.0], [3.0, 3.0]]);
    posed.remove(first);
    posed.flush(&device, &queue).unwrap();
    assert_eq!((posed.jobs.len(), posed.meshes.len()), (1, 1));
    // A replaced mesh is uploaded again.
    update(&mut posed, second, 3.0, 8);
    assert_eq!((posed.jobs.len(), posed.meshes[mesh_key].users), (1, 1));
    posed.remove(second);
    posed.flush(&device, &queue).unwrap();
    assert!(posed.inputs().is_none() && posed.meshes.is_empty());
}

#[test]
fn only_what_changed_since_the_last_recorded_pass_is_deformed() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let mut scene = crate::Scene::default();
    let mesh_key = scene.insert_mesh(mesh(64));
    let material = scene.insert_material(crate::Material::default()).unwrap();
    let keys = [(); 3].map(|()| {
        scene.insert_instance(crate::Instance::new(mesh_key, material, DAffine3::IDENTITY)).unwrap()
    });
    let mut posed = PosedGeometry::new(&device).unwrap();
    let rest = mesh(64);
    // Returns the jobs of a frame in which an instance is given a pose.
    let mut frame = |moves: &[(usize, f64)], is_recorded: bool| {
        posed.begin_frame();
        for &(index, x) in moves {
            posed.update((&device, &queue), keys[index], (mesh_key, &rest, 1), &pose(x)).unwrap();
        }
        posed.flush(&device, &queue).unwrap();
        let inputs = posed.inputs();
        if let Some(inputs) = inputs.as_ref().filter(|_| is_recorded) {
            inputs.done.note();
        }
        inputs.map_or(0, |inputs| inputs.jobs.len() / size_of::<Job>())
    };
    assert_eq!(frame(&[(0, 0.0), (1, 0.0), (2, 0.0)], true), 3);
    assert_eq!(frame(&[], true), 0);
    assert_eq!(frame(&[(1, 1.0)], true), 1);
    // Its previous pose changes once more.
    assert_eq!(frame(&[], true), 1);
    assert_eq!(frame(&[], true), 0);
    // What was not recorded remains.
    assert_eq!(frame(&[(0, 2.0)], false), 1);
    assert_eq!(frame(&[(2, 2.0)], true), 2);
    assert_eq!(frame(&[], true), 1);
    assert_eq!(frame(&[(2, 2.0)], true), 0);
}

#[test]
fn many_workgroups_fill_rows() {
    let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let mut posed = PosedGeometry::new(&device).unwrap();
    posed.workgroups = vec![[0, 0]; MAX_WORKGROUPS + 2];
    posed.pad();
    assert_eq!(posed.dispatch, [32_769, 2, 1]);
    assert_eq!((posed.workgroups.len(), posed.workgroups[65_537]), (65_538, [NO_JOB, 0]));
}
