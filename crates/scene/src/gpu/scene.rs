//! The GPU copy of a scene.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;

use super::batches::{Batches, CullFlags};
use super::draw_list::{Draw, DrawList, DrawPipeline, MaterialUse, squared_distance};
use super::geometry::Geometry;
use super::instances::InstanceBuffer;
use super::material_features::MaterialFeatures;
use super::materials::{MaterialLayouts, Materials};
use super::numbers::Numbers;
use super::posed::{PoseInputs, PosedGeometry};
use super::static_changes::StaticChanges;
use crate::bounds::Aabb;
use crate::cull::{CullTree, CullVolume};
use crate::error::Error;
use crate::keys::InstanceKey;
use crate::material::CasterMode;
use crate::scene::{Changes, Scene};

/// Frames for which an instance counts as moving after it has moved.
const MOVING_FRAMES: u64 = 60;

/// The GPU copy of a scene: geometry, images, materials and transforms.
///
/// Its instances have their own numbers, in an order that needs few state changes when they are drawn: the results of
/// culling need no sorting, and neighbours with the same mesh and material share a draw call. A number stays that of its
/// instance until [`update`](Self::update) sorts the instances, which it does when many have been inserted or replaced.
pub struct GpuScene {
    pub(super) origin_world: DVec3,
    pub(super) numbers: Numbers<InstanceKey>,
    /// The instance of each number.
    pub(super) slots: Vec<Option<Slot>>,
    /// Bounds of what cameras see, by number.
    pub(super) bounds: Vec<Aabb>,
    /// What cameras see.
    pub(super) tree: CullTree,
    /// What casts shadows.
    pub(super) caster_tree: CullTree,
    pub(super) geometry: Geometry,
    pub(super) posed: PosedGeometry,
    pub(super) instances: InstanceBuffer,
    pub(super) batches: Batches,
    /// Whether the device can draw indirectly from any first instance.
    pub(super) first_instance: bool,
    /// The numbers of blended instances.
    pub(super) blended: BTreeSet<u32>,
    /// The numbers of casters that tint.
    pub(super) tinting: BTreeSet<u32>,
    /// Where static casters have changed.
    pub(super) static_changes: StaticChanges,
    /// The instances that count as moving, by the first frame in which they may not.
    pub(super) resting: BTreeMap<u64, Vec<u32>>,
    pub(super) materials: Materials,
    pub(super) layouts: MaterialLayouts,
    /// Number of frames so far.
    pub(super) frame: u64,
    /// The number of versions so far.
    pub(super) versions: u64,
    /// The number of instances that are not at their place in the order of draws.
    pub(super) unsorted: usize,
}

/// An instance on the GPU.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    pub(super) key: InstanceKey,
    /// The instance's name.
    pub(super) name: Arc<str>,
    pub(super) draw: Draw,
    /// Whether cameras see it.
    pub(super) is_seen: bool,
    /// Changes with the instance.
    pub(super) version: u64,
    /// The first frame in which it does not count as moving.
    pub(super) stands_from: u64,
}

impl GpuScene {
    /// Uploads a scene. Positions on the GPU are relative to `origin_world`: [`origin_near`](crate::origin_near)
    /// the camera.
    ///
    /// # Errors
    ///
    /// [`Error::Limit`], with the name of the limit, if the scene exceeds a limit of the device.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        origin_world: DVec3,
    ) -> Result<Self, Error> {
        let layouts = MaterialLayouts::new(device);
        let first_instance = device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE);
        let mut empty = Self {
            origin_world,
            numbers: Numbers::default(),
            slots: Vec::new(),
            bounds: Vec::new(),
            tree: CullTree::new(&[]),
            caster_tree: CullTree::new(&[]),
            geometry: Geometry::new(device, scene)?,
            posed: PosedGeometry::new(device)?,
            instances: InstanceBuffer::new(device, &layouts.draw),
            batches: Batches::new(device, first_instance),
            first_instance,
            blended: BTreeSet::new(),
            tinting: BTreeSet::new(),
            static_changes: StaticChanges::default(),
            resting: BTreeMap::new(),
            materials: Materials::new(device, queue, &layouts),
            layouts,
            frame: 0,
            versions: 0,
            unsorted: 0,
        };
        empty.update(device, queue, scene, &Changes::insert_all(scene))?;
        Ok(empty)
    }

    /// Returns the origin of GPU positions in the world, metres.
    #[must_use]
    pub fn origin_world(&self) -> DVec3 {
        self.origin_world
    }

    /// Returns the parts of the material model that materials use, or have used.
    #[must_use]
    pub fn material_features(&self) -> MaterialFeatures {
        self.materials.features
    }

    /// Returns the number of instances that cast shadows and have not moved within the last 60 frames.
    #[must_use]
    pub fn static_caster_count(&self) -> usize {
        self.instances.static_caster_count()
    }

    /// Returns the size of the buffers of instances: their transforms, numbers and batches, bytes.
    #[must_use]
    pub fn instance_bytes(&self) -> u64 {
        self.instances.bytes() + self.batches.buffer().size()
    }

    /// Returns the number of triangles of a draw.
    #[must_use]
    pub fn triangle_count(&self, draw: &Draw) -> u32 {
        self.geometry.ranges(draw.mesh).map_or(0, |ranges| ranges.triangle_count())
    }

    /// Returns the bounds in the world of what cameras see, by number; empty for numbers that no visible instance has.
    #[must_use]
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }

    /// Returns the bounds in the world of all instances that cameras see.
    #[must_use]
    pub fn all_bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// Returns the bounds in the world of all instances that cast shadows.
    #[must_use]
    pub fn all_caster_bounds(&self) -> Aabb {
        self.caster_tree.bounds()
    }

    /// Returns the bounds in the world of an instance as a caster; empty if it casts no shadow.
    #[must_use]
    pub fn caster_bounds(&self, number: u32) -> Aabb {
        self.caster_tree.item_bounds(number)
    }

    /// Returns the key of the instance with a number.
    #[must_use]
    pub fn instance(&self, number: u32) -> Option<InstanceKey> {
        self.slot(number).map(|slot| slot.key)
    }

    /// Returns the number of an instance.
    #[must_use]
    pub fn number(&self, key: InstanceKey) -> Option<u32> {
        self.numbers.get(key)
    }

    /// Returns the name of the instance with a number; `None` if it is empty.
    #[must_use]
    pub fn name(&self, number: u32) -> Option<&str> {
        self.slot(number).map(|slot| &*slot.name).filter(|name| !name.is_empty())
    }

    /// Returns a version of an instance, its mesh and its material: it changes whenever one of them or the
    /// number does, and is never used again.
    #[must_use]
    pub fn version(&self, number: u32) -> Option<u64> {
        let slot = self.slot(number)?;
        let mesh = self.geometry.ranges(slot.draw.mesh).map_or(0, |ranges| ranges.version);
        Some(slot.version.max(mesh).max(self.materials.version(slot.draw.material)))
    }

    /// Returns whether an instance has moved within the last 60 frames.
    #[must_use]
    pub fn is_moving(&self, number: u32) -> bool {
        self.slot(number).is_some_and(|slot| self.frame < slot.stands_from)
    }

    /// Appends the numbers of the instances that cameras see and that intersect a volume, ascending.
    pub fn cull(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        self.tree.query(volume, numbers);
    }

    /// Returns whether any instance intersects a volume.
    #[must_use]
    pub fn any_in(&self, volume: &CullVolume) -> bool {
        self.tree.any(volume)
    }

    /// Appends the numbers of the instances that cast shadows and intersect a volume, ascending.
    pub fn cull_casters(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        self.caster_tree.query(volume, numbers);
    }

    /// Appends the numbers of blended instances that cameras see and that intersect a volume, ascending.
    pub fn cull_blended(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        let intersects = |number: &u32| volume.intersects(&self.bounds[*number as usize]);
        numbers.extend(self.blended.iter().copied().filter(intersects));
    }

    /// Appends the numbers of casters that tint and intersect a volume, ascending.
    pub fn cull_tinting(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        let intersects = |number: &u32| volume.intersects(&self.caster_bounds(*number));
        numbers.extend(self.tinting.iter().copied().filter(intersects));
    }

    /// Returns whether any caster tints.
    #[must_use]
    pub fn any_tints(&self) -> bool {
        !self.tinting.is_empty()
    }

    /// Appends the numbers of [moving](Self::is_moving) instances that cast shadows and intersect a volume, ascending.
    pub fn cull_moving_casters(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        let first = numbers.len();
        let intersects =
            |number: &u32| self.is_moving(*number) && volume.intersects(&self.caster_bounds(*number));
        numbers.extend(self.resting.values().flatten().copied().filter(intersects));
        numbers[first..].sort_unstable();
        let mut last = None;
        numbers.retain(|&number| last.replace(number) != Some(number));
    }

    /// Returns whether any instance counts as [moving](Self::is_moving).
    #[must_use]
    pub fn any_moving(&self) -> bool {
        self.resting.values().flatten().any(|&number| self.is_moving(number))
    }

    /// Returns whether any caster intersects a volume.
    #[must_use]
    pub fn any_caster_in(&self, volume: &CullVolume) -> bool {
        self.caster_tree.any(volume)
    }

    /// Returns the number of instances.
    #[must_use]
    pub fn instance_count(&self) -> usize {
        self.slots.len()
    }

    /// Returns the number of draws that draw all instances if neighbours with one mesh and one material share a draw.
    #[must_use]
    pub fn batch_count(&self) -> usize {
        self.batches.list().len()
    }

    /// Returns the version of the last change of a caster that does not [move](Self::is_moving). A caster that begins to move
    /// is removed, one that ceases to is inserted.
    #[must_use]
    pub fn static_version(&self) -> u64 {
        self.static_changes.version()
    }

    /// Returns whether a caster that does not move and intersects a volume may have changed since a version.
    #[must_use]
    pub fn statics_changed(&self, since: u64, volume: &CullVolume) -> bool {
        self.static_changes.since(since, volume)
    }

    /// Appends the bounds, before and after, of casters that do not move and have changed since a version. Returns false if changes have been
    /// forgotten, which may have been anywhere.
    pub fn static_changes(&self, since: u64, bounds: &mut Vec<Aabb>) -> bool {
        self.static_changes.bounds_since(since, bounds)
    }

    /// Returns what a pass reads and writes to deform meshes by skins and morph targets, before anything draws them; `None` if no
    /// mesh has changed since it was recorded ([`PoseDone`](super::PoseDone)).
    #[must_use]
    pub fn pose_inputs(&self) -> Option<PoseInputs<'_>> {
        self.posed.inputs()
    }

    /// Returns the draw of an instance.
    #[must_use]
    pub fn draw_for(&self, number: u32) -> Option<&Draw> {
        self.slot(number).map(|slot| &slot.draw)
    }

    /// Returns the layouts of groups 2 and 3, for pipelines that draw this scene.
    #[must_use]
    pub fn layouts(&self) -> &MaterialLayouts {
        &self.layouts
    }

    /// Returns the draws of the instances with these numbers (ascending) for an eye at `eye_world`. Numbers that no visible
    /// instance has are skipped.
    #[must_use]
    pub fn draw_list(&self, numbers: &[u32], eye_world: DVec3) -> DrawList {
        let mut list = DrawList::default();
        self.draw_list_into(numbers, eye_world, &mut list);
        list
    }

    /// Fills an existing list as [`draw_list`](Self::draw_list) does. A list with enough capacity is not reallocated.
    pub fn draw_list_into(&self, numbers: &[u32], eye_world: DVec3, list: &mut DrawList) {
        let slots = numbers.iter().filter_map(|&number| self.slot(number));
        let draws = slots.filter(|slot| slot.is_seen).map(|slot| slot.draw);
        list.fill(draws, |number| squared_distance(&self.bounds[number as usize], eye_world));
    }

    /// Records draws. Sets the pipeline, group 2 (if the pipeline reads it), group 3 and the buffers, each only where it
    /// changes; groups 0 and 1 must be set. Draws without a pipeline, or of another scene, are skipped. Returns the number of
    /// draw calls: neighbours with one mesh share a call.
    pub fn draw<'d, 'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        draws: impl IntoIterator<Item = &'d Draw>,
        pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
    ) -> u32 {
        let mut draws = draws.into_iter().peekable();
        if draws.peek().is_none() {
            return 0;
        }
        let mut calls = 0;
        self.geometry.set_indices(pass);
        pass.set_bind_group(3, self.instances.group(), &[0]);
        let (mut current_pipeline, mut material, mut is_posed) = (None, None, None);
        while let Some(draw) = draws.next() {
            let Some(ranges) = self.geometry.ranges(draw.mesh) else { continue };
            let Some(group) = self.materials.group(draw.material) else { continue };
            if draw.instance as usize >= self.slots.len() {
                continue;
            }
            let Some(pipeline) = pipeline_for(draw) else { continue };
            if current_pipeline != Some(pipeline.pipeline) {
                pass.set_pipeline(pipeline.pipeline);
                current_pipeline = Some(pipeline.pipeline);
            }
            if pipeline.material != MaterialUse::None && material != Some((draw.material, pipeline.material))
            {
                pass.set_bind_group(2, group.get(pipeline.material), &[]);
                material = Some((draw.material, pipeline.material));
            }
            match draw.posed {
                Some(_) => self.posed.set_vertices(pass, ranges.vertex_count()),
                None if is_posed != Some(false) => self.geometry.set_vertices(pass),
                None => {}
            }
            is_posed = Some(draw.posed.is_some());
            let mut end = draw.instance + 1;
            while draws.next_if(|next| next.continues(draw, end)).is_some() {
                end += 1;
            }
            let (indices, base_vertex) = ranges.draw();
            let base_vertex = draw.posed.map_or(base_vertex, |first| first as i32);
            pass.draw_indexed(indices, base_vertex, draw.instance..end);
            calls += 1;
        }
        calls
    }

    pub(super) fn slot(&self, number: u32) -> Option<&Slot> {
        self.slots.get(number as usize)?.as_ref()
    }

    /// Returns the frame from which an instance that moves now does not count as moving.
    pub(super) fn moves_until(&self) -> u64 {
        self.frame + MOVING_FRAMES
    }

    /// Returns the flags of the instance with a number.
    pub(super) fn flags(&self, number: u32) -> CullFlags {
        let exists = |bounds: &Aabb| !bounds.is_empty();
        let is_seen = self.bounds.get(number as usize).is_some_and(exists);
        let flags = [
            (is_seen, CullFlags::SEEN),
            (exists(&self.caster_bounds(number)), CullFlags::CASTER),
            (self.is_moving(number), CullFlags::MOVING),
        ];
        let set = flags.into_iter().filter(|(has, _)| *has);
        set.fold(CullFlags::default(), |all, (_, flag)| all.union(flag))
    }

    /// Returns a new version.
    pub(super) fn next_version(&mut self) -> u64 {
        self.versions += 1;
        self.versions
    }
}

/// Returns the bounds of an instance for cameras and as a caster: empty if they do not see it, or it casts no shadow.
pub(super) fn split_bounds(slot: &Slot, bounds: Aabb) -> [Aabb; 2] {
    let casts = slot.draw.casts != CasterMode::Off;
    [slot.is_seen, casts].map(|included| if included { bounds } else { Aabb::EMPTY })
}
