//! The GPU copy of a scene.

use glam::DVec3;

use super::draw_list::{Draw, DrawList, DrawPipeline, squared_distance};
use super::key::MaterialKey;
use super::materials::MaterialLayouts;
use super::upload::{Geometry, GpuInstance, buffer};
use super::{limits, materials};
use crate::bounds::Aabb;
use crate::cull::{CullTree, CullVolume};
use crate::error::Error;
use crate::scene::{Instance, Scene};

/// The GPU copy of a scene: geometry, images, materials and transforms.
///
/// Its instances have their own numbers, in an order that needs few state changes when they are drawn: the results of
/// culling need no sorting, and neighbours with the same mesh and material share a draw call.
pub struct GpuScene {
    origin_world: DVec3,
    /// The scene's instance index of each number.
    order: Vec<u32>,
    bounds: Vec<Aabb>,
    tree: CullTree,
    /// The draw of each instance, by number.
    draws: Vec<Draw>,
    geometry: Geometry,
    instances: wgpu::Buffer,
    instance_group: wgpu::BindGroup,
    material_groups: Vec<wgpu::BindGroup>,
    layouts: MaterialLayouts,
}

impl GpuScene {
    /// Uploads a scene. Positions on the GPU are relative to `origin_world`: [`origin_near`](crate::origin_near)
    /// the camera.
    ///
    /// # Errors
    ///
    /// [`Error::Limit`], with the name of the limit, if the scene exceeds a limit of the device;
    /// [`Error::Inconsistent`] if an instance, a material or an image does not fit the rest.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        origin_world: DVec3,
    ) -> Result<Self, Error> {
        let (order, draws) = draws(scene)?;
        let layouts = MaterialLayouts::new(device);
        let geometry = Geometry::new(device, queue, &scene.meshes)?;
        let instances = upload_instances(device, queue, scene, &order, origin_world)?;
        let instance_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("instances"),
            layout: &layouts.draw,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: instances.as_entire_binding() }],
        });
        let bounds: Vec<_> = order.iter().map(|&i| scene.instance_bounds(i as usize)).collect();
        Ok(Self {
            origin_world,
            tree: CullTree::new(&bounds),
            bounds,
            order,
            draws,
            geometry,
            instances,
            instance_group,
            material_groups: materials::bind_groups(device, queue, &layouts, scene)?,
            layouts,
        })
    }

    /// Moves the origin of GPU positions. Uploads the transforms again only if the origin changes; `scene` must be the one
    /// that was uploaded.
    pub fn set_origin(&mut self, queue: &wgpu::Queue, scene: &Scene, origin_world: DVec3) {
        if origin_world == self.origin_world {
            return;
        }
        self.origin_world = origin_world;
        let instances = GpuInstance::all(scene, &self.order, origin_world);
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
    }

    /// Returns the origin of GPU positions in the world, metres.
    #[must_use]
    pub fn origin_world(&self) -> DVec3 {
        self.origin_world
    }

    /// Returns the number of triangles of a draw.
    #[must_use]
    pub fn triangle_count(&self, draw: &Draw) -> u32 {
        self.geometry.ranges.get(draw.mesh as usize).map_or(0, |range| range.index_count / 3)
    }

    /// Returns the bounds of each instance in the world, by number.
    #[must_use]
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }

    /// Returns the bounds of all instances in the world.
    #[must_use]
    pub fn all_bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    /// Returns the scene's instance index of a number.
    #[must_use]
    pub fn instance(&self, number: u32) -> Option<u32> {
        self.order.get(number as usize).copied()
    }

    /// Appends the numbers of the instances that intersect a volume, ascending.
    pub fn cull(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        self.tree.query(volume, numbers);
    }

    /// Returns the draw of an instance.
    #[must_use]
    pub fn draw_for(&self, number: u32) -> Option<&Draw> {
        self.draws.get(number as usize)
    }

    /// Returns the layouts of groups 2 and 3, for pipelines that draw this scene.
    #[must_use]
    pub fn layouts(&self) -> &MaterialLayouts {
        &self.layouts
    }

    /// Returns the draws of the instances with these numbers (ascending) for an eye at `eye_world`. Numbers that do not
    /// exist are skipped.
    #[must_use]
    pub fn draw_list(&self, numbers: &[u32], eye_world: DVec3) -> DrawList {
        let mut list = DrawList::default();
        self.draw_list_into(numbers, eye_world, &mut list);
        list
    }

    /// Fills an existing list as [`draw_list`](Self::draw_list) does. A list with enough capacity is not reallocated.
    pub fn draw_list_into(&self, numbers: &[u32], eye_world: DVec3, list: &mut DrawList) {
        let draws = numbers.iter().filter_map(|&number| self.draws.get(number as usize));
        list.fill(draws.copied(), |number| squared_distance(&self.bounds[number as usize], eye_world));
    }

    /// Records draws. Sets the pipeline, group 2 (if the pipeline reads it), group 3 and the buffers, each only where it
    /// changes; groups 0 and 1 must be set. Draws without a pipeline, or of another scene, are skipped. Returns the number of
    /// draw calls: neighbours with one mesh share a call.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        draws: impl IntoIterator<Item = &'p Draw>,
        pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
    ) -> u32 {
        let mut draws = draws.into_iter().peekable();
        if draws.peek().is_none() {
            return 0;
        }
        let mut calls = 0;
        pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.set_bind_group(3, &self.instance_group, &[]);
        let (mut current_pipeline, mut material) = (None, None);
        while let Some(draw) = draws.next() {
            let Some(range) = self.geometry.ranges.get(draw.mesh as usize) else { continue };
            let Some(group) = self.material_groups.get(draw.material as usize) else { continue };
            if draw.instance as usize >= self.draws.len() {
                continue;
            }
            let Some(pipeline) = pipeline_for(draw) else { continue };
            if current_pipeline != Some(pipeline.pipeline) {
                pass.set_pipeline(pipeline.pipeline);
                current_pipeline = Some(pipeline.pipeline);
            }
            if pipeline.reads_material && material != Some(draw.material) {
                pass.set_bind_group(2, group, &[]);
                material = Some(draw.material);
            }
            let mut end = draw.instance + 1;
            while draws.next_if(|next| next.continues(draw, end)).is_some() {
                end += 1;
            }
            let indices = range.first_index..range.first_index + range.index_count;
            pass.draw_indexed(indices, range.base_vertex, draw.instance..end);
            calls += 1;
        }
        calls
    }
}

/// Returns the scene's instance indices in draw order, and the draws.
fn draws(scene: &Scene) -> Result<(Vec<u32>, Vec<Draw>), Error> {
    let draw = |(index, instance): (usize, &Instance)| {
        let missing = |kind: &str, wanted: usize, count: usize| Error::Inconsistent {
            what: format!("instance {index} \"{}\"", instance.name),
            reason: format!("{kind} {wanted} does not exist, the scene has {count}"),
        };
        let (meshes, materials) = (scene.meshes.len(), scene.materials.len());
        if instance.mesh >= meshes {
            return Err(missing("mesh", instance.mesh, meshes));
        }
        let material = scene.materials.get(instance.material);
        let material = material.ok_or_else(|| missing("material", instance.material, materials))?;
        let mirrored = instance.world_from_local.matrix3.determinant() < 0.0;
        Ok(Draw {
            key: MaterialKey::new(material, mirrored),
            casts: material.caster_mode(),
            material: instance.material as u32,
            mesh: instance.mesh as u32,
            instance: index as u32,
        })
    };
    let mut draws: Vec<Draw> = scene.instances.iter().enumerate().map(draw).collect::<Result<_, _>>()?;
    draws.sort_unstable();
    let order = draws.iter().map(|draw| draw.instance).collect();
    for (number, draw) in (0..).zip(&mut draws) {
        draw.instance = number;
    }
    Ok((order, draws))
}

/// Creates the storage buffer of all transforms.
fn upload_instances(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    scene: &Scene,
    order: &[u32],
    origin_world: DVec3,
) -> Result<wgpu::Buffer, Error> {
    let size = size_of::<GpuInstance>() as u64;
    let bytes = scene.instances.len() as u64 * size;
    limits::storage(&device.limits(), "the scene's instances", bytes)?;
    let instances = GpuInstance::all(scene, order, origin_world);
    let data = bytemuck::cast_slice(&instances);
    Ok(buffer(device, queue, "instances", wgpu::BufferUsages::STORAGE, size, bytes, [data]))
}
