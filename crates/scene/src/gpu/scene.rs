//! A scene on the GPU.

use glam::DVec3;

use super::draw_list::squared_distance;
use super::upload::{Geometry, GpuInstance, buffer};
use super::{AlphaKey, Draw, DrawList, MaterialKey, MaterialLayouts, limits, materials};
use crate::{Aabb, Error, Scene};

/// The GPU copy of a scene: geometry, images, materials and placements.
pub struct GpuScene {
    origin_world: DVec3,
    bounds: Vec<Aabb>,
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
    /// [`Error::Limit`] where the scene is over a limit of the device, which it names, and
    /// [`Error::Inconsistent`] where an instance, a material or an image does not fit to the rest.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        origin_world: DVec3,
    ) -> Result<Self, Error> {
        let draws = draws(scene)?;
        let layouts = MaterialLayouts::new(device);
        let geometry = Geometry::new(device, queue, &scene.meshes)?;
        let instances = upload_instances(device, queue, scene, origin_world)?;
        let instance_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("instances"),
            layout: &layouts.draw,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: instances.as_entire_binding() }],
        });
        Ok(Self {
            origin_world,
            bounds: (0..scene.instances.len()).map(|i| scene.instance_bounds(i)).collect(),
            draws,
            geometry,
            instances,
            instance_group,
            material_groups: materials::bind_groups(device, queue, &layouts, scene)?,
            layouts,
        })
    }

    /// Moves the point that GPU positions are relative to. Writes the placements again only if it is another
    /// point; `scene` must be the one that was uploaded.
    pub fn set_origin(&mut self, queue: &wgpu::Queue, scene: &Scene, origin_world: DVec3) {
        if origin_world == self.origin_world {
            return;
        }
        self.origin_world = origin_world;
        let mut instances = GpuInstance::all(scene, origin_world);
        instances.truncate(self.draws.len());
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
    }

    /// Returns the point in the world that GPU positions are relative to, metres.
    #[must_use]
    pub fn origin_world(&self) -> DVec3 {
        self.origin_world
    }

    /// Returns how many triangles a draw has.
    #[must_use]
    pub fn triangle_count(&self, draw: &Draw) -> u32 {
        self.geometry.ranges.get(draw.mesh as usize).map_or(0, |range| range.index_count / 3)
    }

    /// Returns the bounds of each instance in the world.
    #[must_use]
    pub fn bounds(&self) -> &[Aabb] {
        &self.bounds
    }

    /// Returns the layouts of groups 2 and 3, for pipelines that draw this scene.
    #[must_use]
    pub fn layouts(&self) -> &MaterialLayouts {
        &self.layouts
    }

    /// Orders the draws of these instances for an eye at `eye_world`. Instances that do not exist are left out.
    #[must_use]
    pub fn draw_list(&self, visible: &[u32], eye_world: DVec3) -> DrawList {
        let draws = visible.iter().filter_map(|&instance| self.draws.get(instance as usize));
        DrawList::sorted(draws.copied(), |instance| {
            squared_distance(&self.bounds[instance as usize], eye_world)
        })
    }

    /// Draws. Sets the pipeline, group 2 (for keys that are not opaque, and for all with `material_group`: the
    /// pipelines of opaque keys read the material too), group 3 and the buffers, each only where it changes;
    /// groups 0 and 1 must be set. Draws of another scene are left out.
    pub fn draw<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        draws: &[Draw],
        material_group: bool,
        pipeline_for: &dyn Fn(MaterialKey) -> &'p wgpu::RenderPipeline,
    ) {
        if draws.is_empty() {
            return;
        }
        pass.set_vertex_buffer(0, self.geometry.vertices.slice(..));
        pass.set_index_buffer(self.geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.set_bind_group(3, &self.instance_group, &[]);
        let (mut key, mut material) = (None, None);
        for draw in draws {
            let Some(range) = self.geometry.ranges.get(draw.mesh as usize) else { continue };
            let Some(group) = self.material_groups.get(draw.material as usize) else { continue };
            if draw.instance as usize >= self.draws.len() {
                continue;
            }
            if key != Some(draw.key) {
                pass.set_pipeline(pipeline_for(draw.key));
                key = Some(draw.key);
            }
            let needs_material = material_group || draw.key.alpha != AlphaKey::Opaque;
            if needs_material && material != Some(draw.material) {
                pass.set_bind_group(2, group, &[]);
                material = Some(draw.material);
            }
            let indices = range.first_index..range.first_index + range.index_count;
            pass.draw_indexed(indices, range.base_vertex, draw.instance..draw.instance + 1);
        }
    }
}

/// The draw of each instance.
fn draws(scene: &Scene) -> Result<Vec<Draw>, Error> {
    let draw = |(index, instance): (usize, &crate::Instance)| {
        let missing = |kind: &str, wanted: usize, count: usize| Error::Inconsistent {
            what: format!("instance {index} \"{}\"", instance.name),
            reason: format!("it refers to {kind} {wanted}, the scene has {count}"),
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
            material: instance.material as u32,
            mesh: instance.mesh as u32,
            instance: index as u32,
        })
    };
    scene.instances.iter().enumerate().map(draw).collect()
}

/// The storage buffer of all placements.
fn upload_instances(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    scene: &Scene,
    origin_world: DVec3,
) -> Result<wgpu::Buffer, Error> {
    let size = size_of::<GpuInstance>() as u64;
    let bytes = scene.instances.len() as u64 * size;
    limits::storage(&device.limits(), "the scene's instances", bytes)?;
    let instances = GpuInstance::all(scene, origin_world);
    let data = bytemuck::cast_slice(&instances);
    Ok(buffer(device, queue, "instances", wgpu::BufferUsages::STORAGE, size, bytes, [data]))
}
