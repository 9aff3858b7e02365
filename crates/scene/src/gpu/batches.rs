//! Batches: what the GPU draws with one indirect draw each.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::draw_list::Draw;
use super::geometry::Geometry;
use super::key::AlphaKey;
use super::limits;
use crate::bounds::Aabb;
use crate::error::Error;
use crate::keys::InstanceKey;
use crate::material::CasterMode;

/// Properties of batches and instances that a culled view selects by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct CullFlags(pub(super) u32);

impl CullFlags {
    /// A batch that is not blended.
    pub const SOLID: Self = Self(1);
    /// A batch that casts shadows, if at all, without tint.
    pub const OPAQUE_CASTERS: Self = Self(1 << 1);
    /// A batch of casters that tint.
    pub const TINTING_CASTERS: Self = Self(1 << 2);
    /// An instance that cameras see.
    pub const SEEN: Self = Self(1 << 3);
    /// An instance that casts shadows.
    pub const CASTER: Self = Self(1 << 4);
    /// An instance that [moves](super::GpuScene::is_moving).
    pub const MOVING: Self = Self(1 << 5);

    /// Returns the flags of both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns whether it has all flags of another.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns whether the instance casts shadows and does not move.
    pub(super) const fn is_static_caster(self) -> bool {
        self.contains(Self::CASTER) && !self.contains(Self::MOVING)
    }

    /// Returns the flags as a number, as shaders read them.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }
}

/// Neighbours in the order of draws that share all but the instance. Numbers that no instance has belong to the batch before them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Batch {
    /// The draw of the first instance.
    pub(super) draw: Draw,
    /// Number of instances.
    pub(super) count: u32,
    /// The bounds of the mesh in the space of the instance.
    bounds: Aabb,
    /// The place of the first visible instance in the list of a view.
    pub(super) first_slot: u32,
}

/// `Batch` of `cull_boxes.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct GpuBatch {
    center: Vec3,
    first: u32,
    half_size: Vec3,
    count: u32,
    flags: u32,
    first_index: u32,
    index_count: u32,
    base_vertex: i32,
    first_slot: u32,
    padding: [u32; 3],
}

/// The batches of a scene, in the order of draws.
pub(super) struct Batches {
    list: Vec<Batch>,
    /// The number after that of the last instance.
    end: u32,
    /// Slots of the list of a view.
    slots: u32,
    /// The multiple that first slots are of.
    alignment: u32,
    buffer: wgpu::Buffer,
    /// Whether the buffer is out of date.
    is_changed: bool,
    /// Whether the batches must be found again.
    pub(super) is_stale: bool,
}

impl Batches {
    /// Creates an empty list. Without `first_instance`, each batch is drawn with its slots bound at an offset.
    pub(super) fn new(device: &wgpu::Device, first_instance: bool) -> Self {
        // The offset of a storage buffer is a multiple of 256 bytes on every device.
        let alignment = if first_instance { 1 } else { 64 };
        Self {
            list: Vec::new(),
            end: 0,
            slots: 0,
            alignment,
            buffer: create(device, 1),
            is_changed: false,
            is_stale: true,
        }
    }

    /// Returns the batches.
    pub(super) fn list(&self) -> &[Batch] {
        &self.list
    }

    /// Returns the buffer of batches.
    pub(super) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Returns the number of slots of the list of a view: a multiple of 64, so that lists can be bound at an offset.
    pub(super) fn slots(&self) -> u32 {
        self.slots.next_multiple_of(64)
    }

    /// Finds all batches again. `draws` are the draws of all instances in ascending order, `bounds` returns the local bounds of an
    /// instance. Calls `set` with the number and the batch of each.
    pub(super) fn rebuild<'d>(
        &mut self,
        draws: impl Iterator<Item = (&'d Draw, InstanceKey)>,
        bounds: impl Fn(InstanceKey) -> Aabb,
        mut set: impl FnMut(u32, u32),
    ) {
        self.list.clear();
        (self.end, self.slots) = (0, 0);
        for (draw, key) in draws {
            set(draw.instance, self.append(draw, || bounds(key)));
        }
        (self.is_stale, self.is_changed) = (false, true);
    }

    /// Adds a draw, and returns its batch; `None` if the batches are stale.
    pub(super) fn insert(&mut self, draw: &Draw, bounds: Aabb) -> Option<u32> {
        if self.is_stale {
            return None;
        }
        if draw.instance >= self.end {
            self.is_changed = true;
            return Some(self.append(draw, || bounds));
        }
        let batch = self.find(draw.instance).filter(|&at| draw.continues(&self.list[at].draw, draw.instance));
        self.is_stale = batch.is_none();
        batch.map(|batch| batch as u32)
    }

    /// Returns the index of the batch that contains a number.
    fn find(&self, number: u32) -> Option<usize> {
        self.list.partition_point(|batch| batch.draw.instance <= number).checked_sub(1)
    }

    /// Gives the batch of a deformed mesh, which has one instance, other bounds.
    pub(super) fn set_bounds(&mut self, draw: &Draw, bounds: Aabb) {
        if let Some(at) = self.find(draw.instance) {
            self.list[at].bounds = bounds;
            self.is_changed = true;
        }
    }

    /// Appends an instance after all others, and returns its batch.
    fn append(&mut self, draw: &Draw, bounds: impl FnOnce() -> Aabb) -> u32 {
        let end = std::mem::replace(&mut self.end, draw.instance + 1);
        // Numbers between the last instance and this one are no instances.
        let gap = draw.instance - end;
        if let Some(last) = self.list.last_mut() {
            last.count += gap;
            self.slots += gap;
            if draw.continues(&last.draw, draw.instance) {
                last.count += 1;
                self.slots += 1;
                return self.list.len() as u32 - 1;
            }
        }
        let first_slot = self.slots.next_multiple_of(self.alignment);
        self.list.push(Batch { draw: *draw, count: 1, bounds: bounds(), first_slot });
        self.slots = first_slot + 1;
        self.list.len() as u32 - 1
    }

    /// Uploads the batches if they have changed.
    ///
    /// # Errors
    /// [`Error::Limit`] if there are more than the device allows.
    pub(super) fn flush(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        geometry: &Geometry,
    ) -> Result<(), Error> {
        if !std::mem::take(&mut self.is_changed) {
            return Ok(());
        }
        let batches: Vec<GpuBatch> = self.list.iter().map(|batch| gpu_batch(batch, geometry)).collect();
        let bytes = size_of_val(&batches[..]) as u64;
        if bytes > self.buffer.size() {
            limits::storage(&device.limits(), "the scene's batches", bytes)?;
            self.buffer = create(device, batches.len() as u64);
        }
        queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(&batches));
        Ok(())
    }
}

fn gpu_batch(batch: &Batch, geometry: &Geometry) -> GpuBatch {
    let Batch { draw, count, bounds, first_slot } = batch;
    let (indices, base_vertex) = geometry.ranges(draw.mesh).map_or((0..0, 0), |ranges| ranges.draw());
    let base_vertex = draw.posed.map_or(base_vertex, |first| first as i32);
    let flags = [
        (draw.key.alpha != AlphaKey::Blend, CullFlags::SOLID),
        (draw.casts != CasterMode::Tint, CullFlags::OPAQUE_CASTERS),
        (draw.casts == CasterMode::Tint, CullFlags::TINTING_CASTERS),
    ];
    let flags = flags.into_iter().filter(|(has, _)| *has).map(|(_, flag)| flag.bits()).sum();
    let (center, half_size) = center_and_half_size(bounds);
    GpuBatch {
        center,
        first: draw.instance,
        half_size,
        count: *count,
        flags,
        first_index: indices.start,
        index_count: indices.end - indices.start,
        base_vertex,
        first_slot: *first_slot,
        padding: [0; 3],
    }
}

/// Returns the centre and half the size of a box that contains the bounds.
fn center_and_half_size(bounds: &Aabb) -> (Vec3, Vec3) {
    if bounds.is_empty() {
        return (Vec3::ZERO, Vec3::ZERO);
    }
    let center = bounds.center().as_vec3();
    let reach = (bounds.max - center.as_dvec3()).max(center.as_dvec3() - bounds.min);
    (center, reach.as_vec3() * (1.0 + 1e-6))
}

fn create(device: &wgpu::Device, capacity: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("batches"),
        size: capacity * size_of::<GpuBatch>() as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn batches_have_the_layout_of_the_wgsl_struct() {
        let module = shadowgraph_shaders::compose("cull.wgsl", &[]).unwrap();
        shadowgraph_shaders::check_layout!(&module, "Batch", GpuBatch:
            center, first, half_size, count, flags, first_index, index_count, base_vertex, first_slot, padding,
        )
        .unwrap();
    }
}
