//! A scene on the GPU.

use glam::DVec3;

use super::draw_list::squared_distance;
use super::upload::{Geometry, GpuInstance, buffer};
use super::{Draw, DrawList, MaterialKey, MaterialLayouts, limits, materials};
use crate::{Aabb, CullTree, CullVolume, Error, Scene};

/// The GPU copy of a scene: geometry, images, materials and placements.
///
/// Its instances are numbered anew, in the order in which they are drawn with few changes of state: what is culled by
/// number needs no sorting, and neighbours with the same mesh and material are drawn together.
pub struct GpuScene {
    origin_world: DVec3,
    /// The scene's instance of each number.
    order: Vec<u32>,
    bounds: Vec<Aabb>,
    tree: CullTree,
    /// By number.
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

    /// Moves the point that GPU positions are relative to. Writes the placements again only if it is another
    /// point; `scene` must be the one that was uploaded.
    pub fn set_origin(&mut self, queue: &wgpu::Queue, scene: &Scene, origin_world: DVec3) {
        if origin_world == self.origin_world {
            return;
        }
        self.origin_world = origin_world;
        let instances = GpuInstance::all(scene, &self.order, origin_world);
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

    /// Returns which of the scene's instances has a number.
    #[must_use]
    pub fn instance(&self, number: u32) -> Option<u32> {
        self.order.get(number as usize).copied()
    }

    /// Appends the numbers of the instances that touch a volume, ascending.
    pub fn cull(&self, volume: &CullVolume, numbers: &mut Vec<u32>) {
        self.tree.query(volume, numbers);
    }

    /// Returns what there is to draw of an instance.
    #[must_use]
    pub fn draw_for(&self, number: u32) -> Option<&Draw> {
        self.draws.get(number as usize)
    }

    /// Returns the layouts of groups 2 and 3, for pipelines that draw this scene.
    #[must_use]
    pub fn layouts(&self) -> &MaterialLayouts {
        &self.layouts
    }

    /// Lists the draws of the instances with these numbers (ascending) for an eye at `eye_world`. Numbers that do not exist
    /// are left out.
    #[must_use]
    pub fn draw_list(&self, numbers: &[u32], eye_world: DVec3) -> DrawList {
        let mut list = DrawList::default();
        self.draw_list_into(numbers, eye_world, &mut list);
        list
    }

    /// Lists as [`draw_list`](Self::draw_list) does into a list of before: once it has been as long, nothing is allocated.
    pub fn draw_list_into(&self, numbers: &[u32], eye_world: DVec3, list: &mut DrawList) {
        let draws = numbers.iter().filter_map(|&number| self.draws.get(number as usize));
        list.fill(draws.copied(), |number| squared_distance(&self.bounds[number as usize], eye_world));
    }

    /// Draws. Sets the pipeline, group 2 (where the pipeline reads it), group 3 and the buffers, each only where it
    /// changes; groups 0 and 1 must be set. Draws without a pipeline, or of another scene, are left out. Returns how many draw
    /// calls that took: neighbours of one mesh share one.
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
        let (mut set, mut material) = (None, None);
        while let Some(draw) = draws.next() {
            let Some(range) = self.geometry.ranges.get(draw.mesh as usize) else { continue };
            let Some(group) = self.material_groups.get(draw.material as usize) else { continue };
            if draw.instance as usize >= self.draws.len() {
                continue;
            }
            let Some(with) = pipeline_for(draw) else { continue };
            if set != Some(with.pipeline) {
                pass.set_pipeline(with.pipeline);
                set = Some(with.pipeline);
            }
            if with.reads_material && material != Some(draw.material) {
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

/// What something is drawn with.
#[derive(Clone, Copy, Debug)]
pub struct DrawPipeline<'p> {
    /// The pipeline.
    pub pipeline: &'p wgpu::RenderPipeline,
    /// Whether it reads group 2, the material.
    pub reads_material: bool,
}

/// The scene's instances in the order of their draws, and the draws.
fn draws(scene: &Scene) -> Result<(Vec<u32>, Vec<Draw>), Error> {
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

/// The storage buffer of all placements.
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
