//! The storage buffer of instance transforms: group 3.

use std::num::NonZeroU64;

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3, UVec4, Vec4};

use super::batches::CullFlags;
use super::limits;
use super::write_batch::WriteBatch;
use crate::error::Error;

/// Instances between two changed ones that are written along, since a write costs more than they do.
const MAX_GAP: u32 = 16;

/// `Instance` of `draw.wgsl`: the rows of world_from_local of this frame and of the previous one, both relative to this
/// frame's origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct GpuInstance {
    rows: [Vec4; 3],
    previous_rows: [Vec4; 3],
    flags: UVec4,
}

/// Returns the rows of an affine matrix relative to the origin: subtracts the origin in f64, then rounds.
fn rows(world_from_local: &DAffine3, origin_world: DVec3) -> [Vec4; 3] {
    let rows = world_from_local.matrix3.transpose();
    let offset = world_from_local.translation - origin_world;
    [rows.x_axis.extend(offset.x), rows.y_axis.extend(offset.y), rows.z_axis.extend(offset.z)]
        .map(|row| row.as_vec4())
}

/// The transforms of all instances, by number.
pub(super) struct InstanceBuffer {
    data: Vec<GpuInstance>,
    /// Number of instances that cast shadows and do not move.
    static_casters: usize,
    /// Numbers of instances that have not been written yet, with duplicates.
    changed: Vec<u32>,
    /// Numbers of instances whose previous transform differs from their own.
    moved: Vec<u32>,
    buffers: Buffers,
}

/// The buffers, for as many instances as there is space for.
struct Buffers {
    instances: wgpu::Buffer,
    /// The size of both buffers, bytes.
    bytes: u64,
    /// The instances, and their numbers: draws of all instances are drawn by number.
    group: wgpu::BindGroup,
}

impl InstanceBuffer {
    /// Creates an empty buffer.
    pub(super) fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout) -> Self {
        Self {
            data: Vec::new(),
            static_casters: 0,
            changed: Vec::new(),
            moved: Vec::new(),
            buffers: create(device, layout, 1),
        }
    }

    /// Returns the bind group of draws whose instances are their numbers.
    pub(super) fn group(&self) -> &wgpu::BindGroup {
        &self.buffers.group
    }

    /// Returns the buffer.
    pub(super) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffers.instances
    }

    /// Returns the size of the buffers, bytes.
    pub(super) fn bytes(&self) -> u64 {
        self.buffers.bytes
    }

    /// Returns the number of instances, with those that do not exist.
    pub(super) fn len(&self) -> u32 {
        self.data.len() as u32
    }

    /// Assigns an instance its batch.
    pub(super) fn set_batch(&mut self, number: u32, batch: u32) {
        self.set_flag(number, |flags| flags.x = batch);
    }

    /// Returns the number of instances that cast shadows and do not move.
    pub(super) fn static_caster_count(&self) -> usize {
        self.static_casters
    }

    /// Returns the flags of an instance.
    pub(super) fn flags(&self, number: u32) -> CullFlags {
        self.data.get(number as usize).map_or_else(CullFlags::default, |instance| CullFlags(instance.flags.y))
    }

    /// Gives an instance its flags.
    pub(super) fn set_flags(&mut self, number: u32, flags: CullFlags) {
        self.static_casters -= usize::from(self.flags(number).is_static_caster());
        self.static_casters += usize::from(flags.is_static_caster());
        self.set_flag(number, |all| all.y = flags.bits());
    }

    fn set_flag(&mut self, number: u32, set: impl FnOnce(&mut UVec4)) {
        let Some(instance) = self.data.get_mut(number as usize) else { return };
        let before = instance.flags;
        set(&mut instance.flags);
        if instance.flags != before {
            self.changed.push(number);
        }
    }

    /// Begins a frame: the instances that moved in the last frame have now the same previous transform.
    pub(super) fn begin_frame(&mut self) {
        for number in std::mem::take(&mut self.moved) {
            if let Some(instance) = self.data.get_mut(number as usize) {
                instance.previous_rows = instance.rows;
                self.changed.push(number);
            }
        }
    }

    /// Inserts an instance that did not move.
    pub(super) fn insert(&mut self, number: u32, world_from_local: &DAffine3, origin_world: DVec3) {
        let index = number as usize;
        if index >= self.data.len() {
            self.data.resize(index + 1, GpuInstance::default());
        }
        let rows = rows(world_from_local, origin_world);
        self.data[index] = GpuInstance { rows, previous_rows: rows, ..self.data[index] };
        self.changed.push(number);
    }

    /// Gives an instance its transform in this frame, and returns whether that is another one.
    pub(super) fn move_to(&mut self, number: u32, world_from_local: &DAffine3, origin_world: DVec3) -> bool {
        let rows = rows(world_from_local, origin_world);
        let moved = self.data.get_mut(number as usize).filter(|instance| instance.rows != rows);
        let Some(instance) = moved else { return false };
        instance.rows = rows;
        self.changed.push(number);
        self.moved.push(number);
        true
    }

    /// Moves the origin. `transforms` are those of all instances.
    pub(super) fn set_origin<'t>(
        &mut self,
        transforms: impl IntoIterator<Item = (u32, &'t DAffine3)>,
        (previous_world, origin_world): (DVec3, DVec3),
    ) {
        let shift = (previous_world - origin_world).as_vec3().to_array();
        for (number, world_from_local) in transforms {
            let Some(instance) = self.data.get_mut(number as usize) else { continue };
            let rows = rows(world_from_local, origin_world);
            let stood = instance.previous_rows == instance.rows;
            instance.rows = rows;
            if stood {
                instance.previous_rows = rows;
            } else {
                instance.previous_rows.iter_mut().zip(shift).for_each(|(row, shift)| row.w += shift);
            }
            self.changed.push(number);
        }
    }

    /// Returns the number of instances to upload.
    #[cfg(test)]
    pub(super) fn pending(&self) -> usize {
        self.changed.len()
    }

    /// Orders the instances: `order` lists the previous number of each.
    pub(super) fn reorder(&mut self, order: &[u32]) {
        let mut numbers = vec![u32::MAX; self.data.len()];
        for (number, &previous) in (0..).zip(order) {
            numbers[previous as usize] = number;
        }
        self.data = order.iter().map(|&previous| self.data[previous as usize]).collect();
        let is_static = |instance: &&GpuInstance| CullFlags(instance.flags.y).is_static_caster();
        self.static_casters = self.data.iter().filter(is_static).count();
        self.moved.iter_mut().for_each(|moved| *moved = numbers[*moved as usize]);
        self.moved.retain(|&moved| moved != u32::MAX);
        self.changed = (0..order.len() as u32).collect();
    }

    /// Uploads what changed, into a larger buffer where needed.
    ///
    /// # Errors
    /// [`Error::Limit`] if there are more instances than the device allows.
    pub(super) fn flush(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        layout: &wgpu::BindGroupLayout,
    ) -> Result<(), Error> {
        let (bytes, element) = (size_of_val(&self.data[..]) as u64, size_of::<GpuInstance>() as u64);
        if bytes > self.buffers.instances.size() {
            let limits = device.limits();
            let most = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size) / element;
            let count = self.data.len();
            let what = format!("the scene's {count} instances, of which the device allows {most}");
            limits::storage(&limits, &what, bytes)?;
            // The first upload has the size of the scene; later ones leave space for more.
            let first = self.buffers.instances.size() <= element;
            let capacity = self.data.len() as u64 * if first { 1 } else { 2 };
            self.buffers = create(device, layout, capacity.min(most));
            self.changed = (0..self.data.len() as u32).collect();
        }
        self.changed.sort_unstable();
        let mut writes = WriteBatch::default();
        let mut next = 0;
        for number in std::mem::take(&mut self.changed) {
            // The instances of a short gap continue the write.
            let first = if next > 0 && number <= next + MAX_GAP { next } else { number };
            let Some(instances) = self.data.get(first as usize..=number as usize) else { continue };
            writes.write(
                queue,
                &self.buffers.instances,
                u64::from(first) * element,
                bytemuck::cast_slice(instances),
            );
            next = number + 1;
        }
        writes.flush(queue);
        Ok(())
    }
}

fn create(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, capacity: u64) -> Buffers {
    let buffer = |label, element: usize, usage, mapped_at_creation| {
        let size = capacity * element as u64;
        let usage = wgpu::BufferUsages::STORAGE | usage;
        device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation })
    };
    let instances = buffer("instances", size_of::<GpuInstance>(), wgpu::BufferUsages::COPY_DST, false);
    let numbers = buffer("instance numbers", size_of::<u32>(), wgpu::BufferUsages::empty(), true);
    if let Ok(mut mapped) = numbers.get_mapped_range_mut(..) {
        let all: Vec<u32> = (0..capacity as u32).collect();
        mapped.copy_from_slice(bytemuck::cast_slice(&all));
    }
    numbers.unmap();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("instances"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: instances.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: numbers.as_entire_binding() },
        ],
    });
    Buffers { bytes: instances.size() + numbers.size(), instances, group }
}

/// Creates the layout of group 3.
pub(super) fn instance_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, has_dynamic_offset, element: usize| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset,
            min_binding_size: NonZeroU64::new(element as u64),
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("instances"),
        entries: &[entry(0, false, size_of::<GpuInstance>()), entry(1, true, size_of::<u32>())],
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use std::mem::offset_of;

    use super::*;

    fn translated(x: f64) -> DAffine3 {
        DAffine3::from_translation(DVec3::X * x)
    }

    fn gpu() -> (wgpu::Device, wgpu::Queue) {
        wgpu::Device::noop(&wgpu::DeviceDescriptor::default())
    }

    /// Returns the x of each instance in this frame and in the previous one.
    fn x(buffer: &InstanceBuffer) -> Vec<[f32; 2]> {
        buffer.data.iter().map(|instance| [instance.rows[0].w, instance.previous_rows[0].w]).collect()
    }

    #[test]
    fn instances_have_the_layout_of_the_wgsl_struct() {
        let module = shadowgraph_shaders::compose("depth.wgsl", &[]).unwrap();
        let (rows, previous) = (offset_of!(GpuInstance, rows), offset_of!(GpuInstance, previous_rows));
        let fields = [
            ("row_x", rows),
            ("row_y", rows + 16),
            ("row_z", rows + 32),
            ("previous_row_x", previous),
            ("previous_row_y", previous + 16),
            ("previous_row_z", previous + 32),
            ("flags", offset_of!(GpuInstance, flags)),
        ];
        shadowgraph_shaders::layout::check(&module, "Instance", size_of::<GpuInstance>(), &fields).unwrap();
    }

    #[test]
    fn instances_far_from_the_world_origin_are_exact_relative_to_the_gpu_origin() {
        let world = DVec3::new(1.0e7 + 0.015_625, -3.0, 2.5);
        let origin = DVec3::new(1.0e7, 0.0, 0.0);
        let transform = DAffine3::from_rotation_y(0.5) * DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0));
        let rows = rows(&(DAffine3::from_translation(world) * transform), origin);
        assert_eq!(rows.map(|row| row.w), [0.015_625, -3.0, 2.5]);
        let local = DVec3::new(0.3, -0.7, 1.9);
        let transformed = rows.map(|row| f64::from(row.truncate().dot(local.as_vec3())));
        assert!(DVec3::from(transformed).abs_diff_eq(transform.transform_point3(local), 1e-6));
    }

    #[test]
    fn the_previous_transform_is_that_of_the_last_frame_and_settles_when_an_instance_stops() {
        let (device, queue) = gpu();
        let layout = instance_layout(&device);
        let mut buffer = InstanceBuffer::new(&device, &layout);
        let mut frame = |moves: &[(u32, f64)]| {
            buffer.begin_frame();
            for &(number, x) in moves {
                if number as usize == buffer.data.len() {
                    buffer.insert(number, &translated(x), DVec3::ZERO);
                } else {
                    buffer.move_to(number, &translated(x), DVec3::ZERO);
                }
            }
            buffer.flush((&device, &queue), &layout).unwrap();
            x(&buffer)
        };
        assert_eq!(frame(&[(0, 1.0), (1, 5.0)]), [[1.0, 1.0], [5.0, 5.0]]);
        assert_eq!(frame(&[(0, 2.0)]), [[2.0, 1.0], [5.0, 5.0]]);
        assert_eq!(frame(&[(0, 3.0), (1, 6.0)]), [[3.0, 2.0], [6.0, 5.0]]);
        assert_eq!(frame(&[(1, 7.0)]), [[3.0, 3.0], [7.0, 6.0]]);
        assert_eq!(frame(&[]), [[3.0, 3.0], [7.0, 7.0]]);
    }

    #[test]
    fn the_previous_transform_follows_the_origin_and_the_order() {
        let device = gpu().0;
        let mut buffer = InstanceBuffer::new(&device, &instance_layout(&device));
        let mut transforms = [translated(1025.0), translated(2.0)];
        for (number, transform) in (0..).zip(&transforms) {
            buffer.insert(number, transform, DVec3::ZERO);
        }
        buffer.begin_frame();
        transforms[0] = translated(1026.0);
        buffer.move_to(0, &transforms[0], DVec3::ZERO);
        buffer.set_origin((0..).zip(&transforms), (DVec3::ZERO, DVec3::X * 1024.0));
        assert_eq!(x(&buffer), [[2.0, 1.0], [-1022.0, -1022.0]]);
        buffer.reorder(&[1, 0]);
        assert_eq!(x(&buffer), [[-1022.0, -1022.0], [2.0, 1.0]]);
        buffer.begin_frame();
        assert_eq!(x(&buffer), [[-1022.0, -1022.0], [2.0, 2.0]]);
    }
}
