//! The buffers of `rays.wgsl`.

use bytemuck::Pod;

use super::gpu_structs::{RayInstance, RayNode, RaySurface, RayTriangle};
use super::pool::Pool;
use super::scene::SurfaceKinds;
use super::{Error, RayScene};

const FEWER_TRIANGLES: &str = "remove casters whose shadows are not visible, use coarser meshes, or request a device \
                               with a larger max_storage_buffer_binding_size";
const FEWER_TEXELS: &str = "use smaller textures, or request a device with a larger \
                            max_storage_buffer_binding_size";

/// A [`RayScene`] on the GPU.
pub struct GpuRayScene {
    device: wgpu::Device,
    /// Nodes, triangles, instances, surfaces and words, in the order of their bindings.
    buffers: [wgpu::Buffer; 5],
    max_coordinate_m: f32,
    kinds: SurfaceKinds,
}

impl GpuRayScene {
    /// Creates an empty scene, which blocks nothing.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let sizes = [
            2 * size_of::<RayNode>(),
            size_of::<RayTriangle>(),
            size_of::<RayInstance>(),
            size_of::<RaySurface>(),
            4,
        ];
        Self {
            device: device.clone(),
            buffers: sizes.map(|bytes| buffer(device, bytes as u64)),
            max_coordinate_m: 0.0,
            kinds: SurfaceKinds::default(),
        }
    }

    /// Uploads what has changed since the last update, always of the same scene, and returns the number of bytes. Buffers that are too small
    /// are replaced by larger ones. The writes take effect before the next submission's commands.
    ///
    /// # Errors
    ///
    /// [`Error::TooBig`] if a buffer would be larger than the device's bindings can be.
    pub fn update(&mut self, queue: &wgpu::Queue, scene: &mut RayScene) -> Result<u64, Error> {
        scene.rebuild_if_degraded()?;
        self.max_coordinate_m = scene.max_coordinate_m();
        self.kinds = scene.surface_kinds();
        let device = &self.device;
        let [nodes, triangles, instances, surfaces, words] = &mut self.buffers;
        let written = [
            upload(device, queue, ("nodes", FEWER_TRIANGLES), &mut scene.nodes, nodes)?,
            upload(device, queue, ("triangles", FEWER_TRIANGLES), &mut scene.triangles, triangles)?,
            upload(device, queue, ("instances", FEWER_TRIANGLES), &mut scene.instances, instances)?,
            upload(device, queue, ("surfaces", FEWER_TRIANGLES), &mut scene.surfaces, surfaces)?,
            upload(device, queue, ("texels", FEWER_TEXELS), &mut scene.words, words)?,
        ];
        Ok(written.into_iter().sum())
    }

    /// Returns the buffers, in the order of their bindings.
    pub(crate) fn buffers(&self) -> &[wgpu::Buffer; 5] {
        &self.buffers
    }

    /// Returns [`RayScene::max_coordinate_m`], from which shaders compute the rays' origins.
    pub(crate) fn max_coordinate_m(&self) -> f32 {
        self.max_coordinate_m
    }

    /// Returns the kinds of surfaces, besides opaque ones.
    pub(crate) fn surface_kinds(&self) -> SurfaceKinds {
        self.kinds
    }
}

/// Uploads the changed elements of a pool, or all of them to a new buffer with space for half as many more, and returns the number of bytes.
fn upload<T: Copy + Default + PartialEq + Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    (what, help): (&'static str, &'static str),
    pool: &mut Pool<T>,
    target: &mut wgpu::Buffer,
) -> Result<u64, Error> {
    let (limits, element) = (device.limits(), size_of::<T>() as u64);
    let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let bytes = pool.elements().len() as u64 * element;
    if bytes > limit {
        return Err(Error::TooBig { what, bytes, limit, help });
    }
    let mut ranges = pool.take_changed();
    if target.size() < bytes {
        let reserved = (bytes + bytes / 2).min(limit);
        *target = buffer(device, reserved - reserved % element);
        ranges = std::iter::once(0..pool.elements().len()).collect();
    }
    let mut written = 0;
    for range in ranges {
        let offset = range.start as u64 * element;
        let contents: &[u8] = bytemuck::cast_slice(&pool.elements()[range]);
        queue.write_buffer(target, offset, contents);
        written += contents.len() as u64;
    }
    Ok(written)
}

/// Creates a buffer of zeros.
fn buffer(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("rays"),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
