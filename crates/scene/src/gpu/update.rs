//! Edits of the GPU copy of a scene.

use std::collections::BTreeMap;

use glam::DVec3;

use super::batches::CullFlags;
use super::draw_list::Draw;
use super::key::{AlphaKey, PipelineKey};
use super::numbers::Numbers;
use super::scene::{GpuScene, Slot, split_bounds};
use crate::bounds::Aabb;
use crate::cull::CullTree;
use crate::error::Error;
use crate::keys::{InstanceKey, MaterialKey, MeshKey};
use crate::material::CasterMode;
use crate::scene::{Changes, Instance, Scene};

/// Instances out of order, in addition to a quarter of all, before all are sorted.
const MIN_UNSORTED: usize = 64;

impl GpuScene {
    /// Follows the edits of a scene, and begins a frame: what moved since the last call has its previous transform
    /// for motion vectors. Call it once a frame, with what [`Scene::take_changes`] returns, before the frame is recorded; submit
    /// what was recorded earlier first. `scene` must be the one that was uploaded.
    ///
    /// It uploads what changed and nothing else: the time depends on the number of changes, except that a replaced mesh or material
    /// looks for its instances among all.
    ///
    /// # Errors
    ///
    /// [`Error::Limit`] if the scene exceeds a limit of the device, and [`Error::Inconsistent`] for another scene. Part of the
    /// changes is then followed: fix the cause, [restore](Scene::restore_changes) the changes and update again.
    pub fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        changes: &Changes,
    ) -> Result<(), Error> {
        self.frame += 1;
        self.instances.begin_frame();
        self.posed.begin_frame();
        self.rest();
        let materials = self.update_materials((device, queue), scene, changes)?;
        self.update_meshes((device, queue), scene, &changes.meshes)?;
        let mut edits = Edits::default();
        for &key in &changes.instances {
            self.update_instance((device, queue), scene, key, &mut edits)?;
        }
        // In the first frame, all instances are new.
        if self.frame > 1 && (!materials.is_empty() || !changes.meshes.is_empty()) {
            self.update_users((device, queue), scene, (&materials, &changes.meshes), &mut edits)?;
        }
        self.follow_bounds(edits);
        self.update_batches(scene);
        self.batches.flush((device, queue), &self.geometry)?;
        self.geometry.flush(queue);
        self.posed.flush(device, queue)?;
        self.materials.flush(queue);
        self.instances.flush((device, queue), &self.layouts.draw)
    }

    /// Moves the origin of GPU positions. Uploads the transforms again only if the origin changes; `scene` must be the one
    /// that was uploaded, and [`update`](Self::update) must have followed its edits.
    ///
    /// # Errors
    ///
    /// As [`update`](Self::update).
    pub fn set_origin(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        origin_world: DVec3,
    ) -> Result<(), Error> {
        if origin_world == self.origin_world {
            return Ok(());
        }
        let transforms = scene
            .instances()
            .filter_map(|(key, instance)| Some((self.numbers.get(key)?, &instance.world_from_local)));
        self.instances.set_origin(transforms, (self.origin_world, origin_world));
        self.origin_world = origin_world;
        self.instances.flush((device, queue), &self.layouts.draw)
    }

    /// Uploads changed materials and those of changed images; returns all of these.
    fn update_materials(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        changes: &Changes,
    ) -> Result<Vec<MaterialKey>, Error> {
        let mut materials = changes.materials.clone();
        for &image in &changes.images {
            materials.extend(self.materials.remove_image(image));
        }
        materials.sort_unstable();
        materials.dedup();
        for &key in &materials {
            let version = self.next_version();
            self.materials.update(gpu, scene, key, version)?;
        }
        Ok(materials)
    }

    fn update_meshes(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        meshes: &[MeshKey],
    ) -> Result<(), Error> {
        for &key in meshes {
            let version = self.next_version();
            self.geometry.update(gpu, key, scene.mesh(key), version)?;
        }
        Ok(())
    }

    /// Inserts, changes or removes an instance.
    fn update_instance(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        key: InstanceKey,
        edits: &mut Edits,
    ) -> Result<(), Error> {
        let Some(instance) = scene.instance(key) else {
            self.posed.remove(key);
            if let Some(number) = self.numbers.remove(key) {
                self.slots[number as usize] = None;
                self.blended.remove(&number);
                self.tinting.remove(&number);
                edits.set(number, [Aabb::EMPTY; 2]);
            }
            return Ok(());
        };
        let (known, version) = (self.numbers.get(key).is_some(), self.next_version());
        let number = self.numbers.insert(key);
        let (posed, has_new_pose) = self.update_pose(gpu, scene, key, instance)?;
        let draw = Draw { posed, ..self.draw_for_instance(gpu, scene, instance, number)? };
        let index = number as usize;
        if index >= self.slots.len() {
            self.slots.resize(index + 1, None);
            self.bounds.resize(index + 1, Aabb::EMPTY);
        }
        let mut stands_from = self.slots[index].as_ref().map_or(0, |slot| slot.stands_from);
        let world_from_local = &instance.world_from_local;
        if !known {
            self.instances.insert(number, world_from_local, self.origin_world);
        } else if self.instances.move_to(number, world_from_local, self.origin_world) || has_new_pose {
            stands_from = self.moves_until();
            self.resting.entry(stands_from).or_default().push(number);
        }
        if self.slots[index].as_ref().map(|slot| slot.draw) != Some(draw) {
            self.unsorted += 1;
            self.follow_draw(&draw, scene.local_bounds(key));
        } else if has_new_pose {
            self.batches.set_bounds(&draw, scene.local_bounds(key));
        }
        let name = match &self.slots[index] {
            Some(slot) if *slot.name == *instance.name => slot.name.clone(),
            _ => instance.name.as_str().into(),
        };
        let slot = Slot { key, name, draw, is_seen: instance.is_seen(), version, stands_from };
        edits.set(number, split_bounds(&slot, scene.instance_bounds(key)));
        self.slots[index] = Some(slot);
        Ok(())
    }

    /// Updates the draws and the bounds of the instances of changed materials and meshes.
    fn update_users(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        (materials, meshes): (&[MaterialKey], &[MeshKey]),
        edits: &mut Edits,
    ) -> Result<(), Error> {
        let mut meshes = meshes.to_vec();
        meshes.sort_unstable();
        for number in 0..self.slots.len() as u32 {
            let Some(key) = self.instance(number) else { continue };
            let instance = scene.instance(key).ok_or_else(|| Error::missing("instance"))?;
            let mesh_changed = meshes.binary_search(&instance.mesh).is_ok();
            if !mesh_changed && materials.binary_search(&instance.material).is_err() {
                continue;
            }
            let posed = self.update_pose(gpu, scene, key, instance)?.0;
            let draw = Draw { posed, ..self.draw_for_instance(gpu, scene, instance, number)? };
            let Some(slot) = self.slots[number as usize].as_mut() else { continue };
            let is_other = std::mem::replace(&mut slot.draw, draw) != draw;
            edits.set(number, split_bounds(slot, scene.instance_bounds(key)));
            if is_other {
                self.unsorted += 1;
                self.follow_draw(&draw, scene.local_bounds(key));
            }
            self.batches.is_stale |= mesh_changed;
        }
        Ok(())
    }

    /// Deforms the mesh of an instance, and returns the first of its vertices, if it is deformed, and whether its pose is another one
    /// than before.
    fn update_pose(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        key: InstanceKey,
        instance: &Instance,
    ) -> Result<(Option<u32>, bool), Error> {
        let mesh = scene.mesh(instance.mesh).ok_or_else(|| Error::missing("mesh"))?;
        let is_deformable = mesh.skin.is_some() || !mesh.morph_targets.is_empty();
        let Some(pose) = instance.pose.as_ref().filter(|_| is_deformable) else {
            self.posed.remove(key);
            return Ok((None, false));
        };
        let number = self.geometry.number(instance.mesh).ok_or_else(|| Error::missing("mesh"))?;
        let version = self.geometry.ranges(number).map_or(0, |ranges| ranges.version);
        let (first, has_new_pose) = self.posed.update(gpu, key, (instance.mesh, mesh, version), pose)?;
        Ok((Some(first), has_new_pose))
    }

    fn draw_for_instance(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        instance: &Instance,
        number: u32,
    ) -> Result<Draw, Error> {
        let material = scene.material(instance.material).ok_or_else(|| Error::missing("material"))?;
        let mirrored = instance.world_from_local.matrix3.determinant() < 0.0;
        let version = self.versions;
        let receives = (instance.material, instance.receives_shadows);
        Ok(Draw {
            key: PipelineKey::new(material, mirrored),
            casts: instance.caster_mode(material),
            material: self.materials.number(gpu, scene, receives, version)?,
            mesh: self.geometry.number(instance.mesh).ok_or_else(|| Error::missing("mesh"))?,
            posed: None,
            instance: number,
        })
    }

    /// Assigns an instance with another draw its batch.
    fn follow_draw(&mut self, draw: &Draw, local_bounds: Aabb) {
        if let Some(batch) = self.batches.insert(draw, local_bounds) {
            self.instances.set_batch(draw.instance, batch);
        }
        let kinds = [
            (&mut self.blended, draw.key.alpha == AlphaKey::Blend),
            (&mut self.tinting, draw.casts == CasterMode::Tint),
        ];
        for (numbers, belongs) in kinds {
            if belongs {
                numbers.insert(draw.instance);
            } else {
                numbers.remove(&draw.instance);
            }
        }
    }

    /// Finds the batches again if they are stale.
    fn update_batches(&mut self, scene: &Scene) {
        if !self.batches.is_stale {
            return;
        }
        let Self { slots, batches, instances, .. } = self;
        let slots = slots.iter().flatten().map(|slot| (&slot.draw, slot.key));
        batches.rebuild(
            slots,
            |key| scene.local_bounds(key),
            |number, batch| instances.set_batch(number, batch),
        );
    }

    /// Clears the flags of instances that have moved and stand now.
    fn rest(&mut self) {
        while let Some(first) = self.resting.first_entry().filter(|first| *first.key() <= self.frame) {
            for number in first.remove() {
                let flags = self.flags(number);
                if flags != self.instances.flags(number) {
                    self.versions += 1;
                    self.static_changes.add(self.versions, self.caster_bounds(number));
                    self.instances.set_flags(number, flags);
                }
            }
        }
    }

    /// Gives the trees the new bounds, and the instances their flags. Sorts all where too many are out of order.
    fn follow_bounds(&mut self, Edits { bounds, caster_bounds }: Edits) {
        self.versions += 1;
        for &(number, bounds) in &caster_bounds {
            if !self.instances.flags(number).contains(CullFlags::MOVING) {
                self.static_changes.add(self.versions, self.caster_bounds(number));
            }
            if !self.is_moving(number) {
                self.static_changes.add(self.versions, bounds);
            }
        }
        for &(number, bounds) in &bounds {
            self.bounds[number as usize] = bounds;
        }
        if self.unsorted > self.slots.len() / 4 + MIN_UNSORTED || self.frame == 1 {
            let mut all: Vec<_> =
                (0..self.slots.len() as u32).map(|number| self.caster_bounds(number)).collect();
            caster_bounds.into_iter().for_each(|(number, bounds)| all[number as usize] = bounds);
            self.sort(&all);
            (0..self.slots.len() as u32)
                .for_each(|number| self.instances.set_flags(number, self.flags(number)));
            return;
        }
        let changed: Vec<u32> = bounds.iter().map(|(number, _)| *number).collect();
        self.refit(bounds, caster_bounds);
        for number in changed {
            self.instances.set_flags(number, self.flags(number));
        }
    }

    /// Gives the trees new bounds by number; builds them again where they are too small or degraded.
    fn refit(&mut self, bounds: Vec<(u32, Aabb)>, caster_bounds: Vec<(u32, Aabb)>) {
        let count = self.slots.len();
        for (tree, changed) in [(&mut self.tree, bounds), (&mut self.caster_tree, caster_bounds)] {
            if count > tree.len() {
                let mut all: Vec<_> = (0..tree.len() as u32).map(|item| tree.item_bounds(item)).collect();
                // A tree that grew once is likely to grow again.
                let reserve = if tree.is_empty() { 0 } else { count / 2 + MIN_UNSORTED };
                all.resize(count + reserve, Aabb::EMPTY);
                changed.into_iter().for_each(|(number, bounds)| all[number as usize] = bounds);
                *tree = CullTree::new(&all);
                continue;
            }
            tree.refit(changed);
            if tree.is_degraded() {
                tree.rebuild();
            }
        }
    }

    /// Numbers all instances in the order of draws, and builds the trees. `caster_bounds` are those by number.
    fn sort(&mut self, caster_bounds: &[Aabb]) {
        let mut slots: Vec<Slot> = std::mem::take(&mut self.slots).into_iter().flatten().collect();
        slots.sort_unstable_by_key(|slot| slot.draw);
        let order: Vec<u32> = slots.iter().map(|slot| slot.draw.instance).collect();
        self.instances.reorder(&order);
        self.bounds = order.iter().map(|number| self.bounds[*number as usize]).collect();
        let caster_bounds: Vec<_> = order.iter().map(|number| caster_bounds[*number as usize]).collect();
        self.tree = CullTree::new(&self.bounds);
        self.caster_tree = match caster_bounds == self.bounds {
            true => self.tree.clone(),
            false => CullTree::new(&caster_bounds),
        };
        self.numbers = Numbers::default();
        for slot in &mut slots {
            let number = self.numbers.insert(slot.key);
            if std::mem::replace(&mut slot.draw.instance, number) != number {
                self.versions += 1;
                slot.version = self.versions;
            }
        }
        let of_kind = |is_kind: fn(&Draw) -> bool| {
            slots
                .iter()
                .map(|slot| &slot.draw)
                .filter(|draw| is_kind(draw))
                .map(|draw| draw.instance)
                .collect()
        };
        self.blended = of_kind(|draw| draw.key.alpha == AlphaKey::Blend);
        self.tinting = of_kind(|draw| draw.casts == CasterMode::Tint);
        self.resting = BTreeMap::new();
        for slot in slots.iter().filter(|slot| self.frame < slot.stands_from) {
            self.resting.entry(slot.stands_from).or_default().push(slot.draw.instance);
        }
        self.slots = slots.into_iter().map(Some).collect();
        self.unsorted = 0;
        self.batches.is_stale = true;
    }
}

/// New bounds of instances, by number: those that cameras see, and those that cast shadows.
#[derive(Default)]
struct Edits {
    bounds: Vec<(u32, Aabb)>,
    caster_bounds: Vec<(u32, Aabb)>,
}

impl Edits {
    fn set(&mut self, number: u32, [bounds, caster_bounds]: [Aabb; 2]) {
        self.bounds.push((number, bounds));
        self.caster_bounds.push((number, caster_bounds));
    }
}

#[cfg(test)]
mod tests;
