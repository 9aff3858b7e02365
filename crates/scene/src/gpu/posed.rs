//! Deformed meshes: the vertices that a compute pass writes, and what it reads.

mod inputs;

use std::collections::BTreeMap;
use std::iter;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, Vec4};
use slotmap::SecondaryMap;

pub use inputs::{PoseDone, PoseInputs};

use super::element_buffer::ElementBuffer;
use super::limits;
use crate::error::Error;
use crate::keys::{InstanceKey, MeshKey};
use crate::mesh::{Influence, Mesh, MeshPose, MorphDelta, Vertex};

/// Vertices of a workgroup: the size in `pose.wgsl`.
const WORKGROUP: u32 = 64;
/// The maximum number of workgroups of a dimension, which every device has.
const MAX_WORKGROUPS: usize = 65_535;
/// The job of workgroups without work: `NO_JOB` of `pose.wgsl`.
const NO_JOB: u32 = u32::MAX;

/// `Job` of `pose.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Job {
    rest_vertex: u32,
    posed_vertex: u32,
    vertex_count: u32,
    first_influence: u32,
    influences_per_vertex: u32,
    first_joint: u32,
    first_delta: u32,
    first_weight: u32,
    weight_count: u32,
    previous_first_joint: u32,
    previous_first_weight: u32,
}

/// A mesh that instances deform.
struct DeformedMesh {
    vertices: Range<u64>,
    influences: Range<u64>,
    influences_per_vertex: u32,
    deltas: Range<u64>,
    target_count: usize,
    /// The version of the mesh that was uploaded.
    version: u64,
    /// The number of instances.
    users: u32,
}

/// An instance whose mesh is deformed.
struct DeformedInstance {
    mesh: MeshKey,
    /// The version of the mesh.
    version: u64,
    /// The vertices of this frame, and as many for the positions in the previous one.
    vertices: Range<u64>,
    pose: MeshPose,
    /// The pose in the previous frame.
    previous: MeshPose,
    /// The revision of the inputs since which its vertices are the same.
    revision: u64,
}

/// All deformed meshes.
pub(super) struct PosedGeometry {
    rest: ElementBuffer,
    influences: ElementBuffer,
    deltas: ElementBuffer,
    vertices: ElementBuffer,
    meshes: SecondaryMap<MeshKey, DeformedMesh>,
    instances: SecondaryMap<InstanceKey, DeformedInstance>,
    /// Instances whose previous pose differs from their own, with duplicates.
    moved: Vec<InstanceKey>,
    /// Whether an instance has changed since the inputs were computed.
    changed: bool,
    /// The number of times that the inputs were computed.
    revision: u64,
    /// The revision of the last inputs whose pass was recorded.
    recorded: Arc<AtomicU64>,
    jobs: Vec<Job>,
    workgroups: Vec<[u32; 2]>,
    dispatch: [u32; 3],
    joints: Vec<[Vec4; 3]>,
    weights: Vec<f32>,
}

impl PosedGeometry {
    /// Creates empty buffers.
    pub(super) fn new(device: &wgpu::Device) -> Result<Self, Error> {
        use wgpu::BufferUsages as Usage;
        let buffer = |label, usage, bytes: usize| {
            let element = (bytes as u64, i32::MAX as u64);
            ElementBuffer::new(device, (label, Usage::STORAGE | usage), element, 1)
        };
        Ok(Self {
            rest: buffer("vertices at rest", Usage::empty(), size_of::<Vertex>())?,
            influences: buffer("influences", Usage::empty(), size_of::<Influence>())?,
            deltas: buffer("morph targets", Usage::empty(), size_of::<MorphDelta>())?,
            vertices: buffer("posed vertices", Usage::VERTEX, size_of::<Vertex>())?,
            meshes: SecondaryMap::new(),
            instances: SecondaryMap::new(),
            moved: Vec::new(),
            changed: false,
            revision: 0,
            recorded: Arc::default(),
            jobs: Vec::new(),
            workgroups: Vec::new(),
            dispatch: [0; 3],
            joints: Vec::new(),
            weights: Vec::new(),
        })
    }

    /// Begins a frame: the instances that moved in the last frame have now the same previous pose.
    pub(super) fn begin_frame(&mut self) {
        for key in std::mem::take(&mut self.moved) {
            if let Some(instance) = self.instances.get_mut(key) {
                instance.previous.clone_from(&instance.pose);
                instance.revision = self.revision + 1;
                self.changed = true;
            }
        }
    }

    /// Gives an instance its pose, and returns the first of its vertices and whether its pose is another one than before.
    ///
    /// # Errors
    /// The deformed meshes are larger than the device allows.
    pub(super) fn update(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        key: InstanceKey,
        (mesh_key, mesh, version): (MeshKey, &Mesh, u64),
        pose: &MeshPose,
    ) -> Result<(u32, bool), Error> {
        let is_known =
            |instance: &&mut DeformedInstance| (instance.mesh, instance.version) == (mesh_key, version);
        if let Some(instance) = self.instances.get_mut(key).filter(is_known) {
            let moved = instance.pose != *pose;
            instance.pose.clone_from(pose);
            if instance.previous.joints.len() != pose.joints.len() {
                // Another skin did not move from where this one is.
                instance.previous.clone_from(pose);
            }
            if moved {
                instance.revision = self.revision + 1;
                self.moved.push(key);
                self.changed = true;
            }
            return Ok((instance.vertices.start as u32, moved));
        }
        self.remove(key);
        if self.meshes.get(mesh_key).is_none_or(|mesh| mesh.version != version) {
            self.upload_mesh(gpu, mesh_key, mesh, version)?;
        }
        let (device, queue) = gpu;
        let vertices = self.vertices.allocate(device, queue, 2 * mesh.vertices.len() as u64)?;
        self.vertices.write(queue, vertices.start, bytemuck::cast_slice(&mesh.vertices));
        self.meshes[mesh_key].users += 1;
        let first = vertices.start as u32;
        let (pose, previous) = (pose.clone(), pose.clone());
        let revision = self.revision + 1;
        let instance = DeformedInstance { mesh: mesh_key, version, vertices, pose, previous, revision };
        self.instances.insert(key, instance);
        self.changed = true;
        Ok((first, true))
    }

    /// Removes an instance, and its mesh with the last one.
    pub(super) fn remove(&mut self, key: InstanceKey) {
        let Some(instance) = self.instances.remove(key) else { return };
        self.vertices.free(instance.vertices);
        self.changed = true;
        if let Some(mesh) = self.meshes.get_mut(instance.mesh) {
            mesh.users -= 1;
            if mesh.users == 0 {
                self.free_mesh(instance.mesh);
            }
        }
    }

    fn free_mesh(&mut self, key: MeshKey) {
        if let Some(mesh) = self.meshes.remove(key) {
            self.rest.free(mesh.vertices);
            self.influences.free(mesh.influences);
            self.deltas.free(mesh.deltas);
        }
    }

    /// Uploads a mesh. Instances of its previous version keep counting as users.
    fn upload_mesh(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        key: MeshKey,
        mesh: &Mesh,
        version: u64,
    ) -> Result<(), Error> {
        let users = self.meshes.get(key).map_or(0, |mesh| mesh.users);
        self.free_mesh(key);
        let vertices = self.rest.allocate(device, queue, mesh.vertices.len() as u64)?;
        self.rest.write(queue, vertices.start, bytemuck::cast_slice(&mesh.vertices));
        let skin = mesh.skin.as_ref().map_or(&[][..], |skin| skin.influences());
        let influences = self.influences.allocate(device, queue, skin.len() as u64)?;
        self.influences.write(queue, influences.start, bytemuck::cast_slice(skin));
        let target_count = mesh.morph_targets.len();
        let count = mesh.vertices.len() * target_count;
        let deltas = self.deltas.allocate(device, queue, count as u64)?;
        for (target, first) in
            mesh.morph_targets.iter().zip((deltas.start..).step_by(mesh.vertices.len().max(1)))
        {
            let given = target.deltas();
            let given = &given[..given.len().min(mesh.vertices.len())];
            self.deltas.write(queue, first, bytemuck::cast_slice(given));
        }
        let influences_per_vertex = mesh.skin.as_ref().map_or(0, |skin| skin.per_vertex() as u32);
        let mesh = DeformedMesh {
            vertices,
            influences,
            influences_per_vertex,
            deltas,
            target_count,
            version,
            users,
        };
        self.meshes.insert(key, mesh);
        Ok(())
    }

    /// Computes the inputs of the pass if an instance has changed, of all that have changed since a pass was recorded, and sends
    /// pending writes to the queue.
    ///
    /// # Errors
    /// The deformed meshes are larger than the device can bind.
    pub(super) fn flush(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), Error> {
        for buffer in [&mut self.rest, &mut self.influences, &mut self.deltas, &mut self.vertices] {
            buffer.flush(queue);
        }
        if !std::mem::take(&mut self.changed) {
            return Ok(());
        }
        self.revision += 1;
        let recorded = self.recorded.load(Ordering::Relaxed);
        self.jobs.clear();
        self.workgroups.clear();
        self.joints.clear();
        self.weights.clear();
        // Meshes of one skin share its joints.
        let mut first_joints = BTreeMap::new();
        for instance in self.instances.values().filter(|instance| instance.revision > recorded) {
            let Some(mesh) = self.meshes.get(instance.mesh) else { continue };
            let mut first_joint = |joints: &Arc<[DAffine3]>| {
                *first_joints.entry(joints.as_ptr().addr()).or_insert_with(|| {
                    let first = self.joints.len() as u32;
                    self.joints.extend(joints.iter().map(rows));
                    first
                })
            };
            let (joint, previous_joint) =
                (first_joint(&instance.pose.joints), first_joint(&instance.previous.joints));
            let mut push_weights = |weights: &[f32]| {
                let first = self.weights.len() as u32;
                let weights = weights.iter().copied().chain(iter::repeat(0.0));
                self.weights.extend(weights.take(mesh.target_count));
                first
            };
            let DeformedInstance { pose, previous, .. } = instance;
            let first_weight = push_weights(&pose.weights);
            let weights_stand = previous.weights == pose.weights;
            let previous_first_weight =
                if weights_stand { first_weight } else { push_weights(&previous.weights) };
            let vertex_count = (instance.vertices.end - instance.vertices.start) as u32 / 2;
            let job = self.jobs.len() as u32;
            self.workgroups.extend((0..vertex_count).step_by(WORKGROUP as usize).map(|first| [job, first]));
            let is_skinned = !instance.pose.joints.is_empty();
            self.jobs.push(Job {
                rest_vertex: mesh.vertices.start as u32,
                posed_vertex: instance.vertices.start as u32,
                vertex_count,
                first_influence: mesh.influences.start as u32,
                influences_per_vertex: if is_skinned { mesh.influences_per_vertex } else { 0 },
                first_joint: joint,
                first_delta: mesh.deltas.start as u32,
                first_weight,
                weight_count: mesh.target_count as u32,
                previous_first_joint: previous_joint,
                previous_first_weight,
            });
        }
        self.pad();
        self.check_limits(&device.limits())
    }

    /// Fills the last row of workgroups, and arrays that are empty.
    fn pad(&mut self) {
        let rows = self.workgroups.len().div_ceil(MAX_WORKGROUPS).max(1);
        let width = self.workgroups.len().div_ceil(rows);
        self.dispatch = [width as u32, rows as u32, 1];
        self.workgroups.resize(width * rows, [NO_JOB, 0]);
        self.joints.resize(self.joints.len().max(1), [Vec4::ZERO; 3]);
        self.weights.resize(self.weights.len().max(1), 0.0);
    }

    fn check_limits(&self, limits: &wgpu::Limits) -> Result<(), Error> {
        for (what, bytes) in [
            ("the vertices of deformed meshes", self.rest.buffer.size()),
            ("the influences of deformed meshes", self.influences.buffer.size()),
            ("the morph targets", self.deltas.buffer.size()),
            ("the vertices of deformed instances", self.vertices.buffer.size()),
            ("the joints", size_of_val(&self.joints[..]) as u64),
        ] {
            limits::storage(limits, what, bytes)?;
        }
        Ok(())
    }

    /// Returns what the pass reads and writes; `None` if no mesh has changed since it was recorded.
    pub(super) fn inputs(&self) -> Option<PoseInputs<'_>> {
        if self.dispatch[0] == 0 || self.recorded.load(Ordering::Relaxed) == self.revision {
            return None;
        }
        Some(PoseInputs {
            jobs: bytemuck::cast_slice(&self.jobs),
            workgroups: bytemuck::cast_slice(&self.workgroups),
            dispatch: self.dispatch,
            joints: bytemuck::cast_slice(&self.joints),
            weights: bytemuck::cast_slice(&self.weights),
            rest: &self.rest.buffer,
            influences: &self.influences.buffer,
            deltas: &self.deltas.buffer,
            vertices: &self.vertices.buffer,
            done: PoseDone { recorded: self.recorded.clone(), revision: self.revision },
        })
    }

    /// Sets the vertex buffers of a pass for a deformed mesh with this number of vertices: 0 has its vertices, 1 those of the
    /// previous frame.
    pub(super) fn set_vertices(&self, pass: &mut wgpu::RenderPass<'_>, count: u64) {
        pass.set_vertex_buffer(0, self.vertices.buffer.slice(..));
        pass.set_vertex_buffer(1, self.vertices.buffer.slice(count * size_of::<Vertex>() as u64..));
    }
}

/// Returns the rows of an affine matrix.
fn rows(joint: &DAffine3) -> [Vec4; 3] {
    let rows = joint.matrix3.transpose();
    let at = joint.translation;
    [rows.x_axis.extend(at.x), rows.y_axis.extend(at.y), rows.z_axis.extend(at.z)].map(|row| row.as_vec4())
}

#[cfg(test)]
mod tests;
