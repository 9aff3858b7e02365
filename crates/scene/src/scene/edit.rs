//! Edits of a scene: each checks its arguments, changes the scene and logs the change, or changes nothing.

use glam::DAffine3;

use super::error::EditError;
use super::{ByName, Instance, MaterialShadows, ObjectShadows, Scene, ShadowModes};
use crate::keys::{ImageKey, InstanceKey, LightKey, MaterialKey, MeshKey};
use crate::light::Light;
use crate::material::{Image, Material};
use crate::mesh::{Mesh, MeshPose};

impl Scene {
    /// Inserts a mesh. It is drawn once instances use it.
    pub fn insert_mesh(&mut self, mesh: Mesh) -> MeshKey {
        self.meshes.insert(mesh)
    }

    /// Replaces a mesh for all its instances, and returns the previous one.
    ///
    /// # Errors
    /// [`EditError::StaleKey`].
    pub fn replace_mesh(&mut self, key: MeshKey, mesh: Mesh) -> Result<Mesh, EditError> {
        self.meshes.edit(key).map(|entry| std::mem::replace(entry, mesh)).ok_or(stale("mesh"))
    }

    /// Removes a mesh that no instance uses.
    ///
    /// # Errors
    /// [`EditError::StaleKey`]; [`EditError::InUse`] if an instance uses it.
    pub fn remove_mesh(&mut self, key: MeshKey) -> Result<Mesh, EditError> {
        let mesh = self.mesh(key).ok_or(stale("mesh"))?;
        unused("mesh", &mesh.name, self.meshes.users(key), "instances")?;
        self.meshes.remove(key).ok_or(stale("mesh"))
    }

    /// Inserts a material.
    ///
    /// # Errors
    /// [`EditError::StaleKey`] if it refers to an image that does not exist.
    pub fn insert_material(&mut self, material: Material) -> Result<MaterialKey, EditError> {
        self.check_images(&material)?;
        image_keys(&material).for_each(|image| self.images.add_user(image));
        let key = self.materials.insert(material);
        self.materials.edit(key).into_iter().for_each(|material| self.material_modes.apply_to(key, material));
        Ok(key)
    }

    /// Replaces a material for all its instances, and returns the previous one, without [shadow modes](Self::set_shadow_modes).
    ///
    /// # Errors
    /// [`EditError::StaleKey`], also if the new material refers to an image that does not exist.
    pub fn replace_material(&mut self, key: MaterialKey, material: Material) -> Result<Material, EditError> {
        self.check_images(&material)?;
        let entry = self.materials.edit(key).ok_or(stale("material"))?;
        image_keys(&material).for_each(|image| self.images.add_user(image));
        let mut previous = std::mem::replace(entry, material);
        self.material_modes.restore(key, &mut previous);
        self.material_modes.apply_to(key, entry);
        image_keys(&previous).for_each(|image| self.images.remove_user(image));
        Ok(previous)
    }

    /// Edits a material, without [shadow modes](Self::set_shadow_modes).
    ///
    /// # Errors
    /// As [`replace_material`](Self::replace_material).
    pub fn edit_material(
        &mut self,
        key: MaterialKey,
        edit: impl FnOnce(&mut Material),
    ) -> Result<(), EditError> {
        let mut material = self.own_material(key).ok_or(stale("material"))?;
        edit(&mut material);
        self.replace_material(key, material).map(drop)
    }

    /// Removes a material that no instance uses.
    ///
    /// # Errors
    /// [`EditError::StaleKey`]; [`EditError::InUse`] if an instance uses it.
    pub fn remove_material(&mut self, key: MaterialKey) -> Result<Material, EditError> {
        let material = self.material(key).ok_or(stale("material"))?;
        unused("material", &material.name, self.materials.users(key), "instances")?;
        let mut removed = self.materials.remove(key).ok_or(stale("material"))?;
        self.material_modes.restore(key, &mut removed);
        image_keys(&removed).for_each(|image| self.images.remove_user(image));
        Ok(removed)
    }

    /// Inserts an image. It is uploaded once materials use it.
    ///
    /// # Errors
    /// [`EditError::ImageSize`].
    pub fn insert_image(&mut self, image: Image) -> Result<ImageKey, EditError> {
        check_size(&image)?;
        Ok(self.images.insert(image))
    }

    /// Replaces an image for all materials that use it, and returns the previous one.
    ///
    /// # Errors
    /// [`EditError::StaleKey`] and [`EditError::ImageSize`].
    pub fn replace_image(&mut self, key: ImageKey, image: Image) -> Result<Image, EditError> {
        check_size(&image)?;
        self.images.edit(key).map(|entry| std::mem::replace(entry, image)).ok_or(stale("image"))
    }

    /// Removes an image that no material uses.
    ///
    /// # Errors
    /// [`EditError::StaleKey`]; [`EditError::InUse`] if a material uses it.
    pub fn remove_image(&mut self, key: ImageKey) -> Result<Image, EditError> {
        let image = self.image(key).ok_or(stale("image"))?;
        unused("image", &image.name, self.images.users(key), "textures of materials")?;
        self.images.remove(key).ok_or(stale("image"))
    }

    /// Inserts an instance.
    ///
    /// # Errors
    /// [`EditError::StaleKey`] if its mesh or its material does not exist; [`EditError::NotFinite`].
    pub fn insert_instance(&mut self, instance: Instance) -> Result<InstanceKey, EditError> {
        self.check_instance(&instance)?;
        self.add_uses(&instance);
        let key = self.instances.insert(instance);
        self.instances.edit(key).into_iter().for_each(|instance| self.object_modes.apply_to(key, instance));
        Ok(key)
    }

    /// Inserts an instance together with its own mesh and material.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use shadowgraph_scene::{Material, Mesh, Scene};
    /// let mut scene = Scene::default();
    /// let cube = Mesh::cuboid(DVec3::ZERO, DVec3::ONE);
    /// scene.add(cube, Material::default(), DAffine3::from_translation(DVec3::X))?;
    /// assert_eq!(scene.bounds().max.x, 2.0);
    /// # Ok::<(), shadowgraph_scene::EditError>(())
    /// ```
    ///
    /// # Errors
    /// [`EditError::StaleKey`] if the material refers to an image that does not exist; [`EditError::NotFinite`].
    pub fn add(
        &mut self,
        mesh: Mesh,
        material: Material,
        world_from_local: DAffine3,
    ) -> Result<InstanceKey, EditError> {
        check_finite(&mesh.name, &world_from_local, None)?;
        let name = mesh.name.clone();
        let material = self.insert_material(material)?;
        let mesh = self.insert_mesh(mesh);
        self.insert_instance(Instance::new(mesh, material, world_from_local).with_name(name))
    }

    /// Gives an instance another transform.
    ///
    /// # Errors
    /// [`EditError::StaleKey`] and [`EditError::NotFinite`].
    pub fn move_instance(&mut self, key: InstanceKey, world_from_local: DAffine3) -> Result<(), EditError> {
        let instance = self.instance(key).ok_or(stale("instance"))?;
        check_finite(&instance.name, &world_from_local, None)?;
        if let Some(instance) = self.instances.edit(key) {
            instance.world_from_local = world_from_local;
        }
        Ok(())
    }

    /// Gives an instance another transform and another deformation of its mesh, if it is deformed.
    ///
    /// # Errors
    /// [`EditError::StaleKey`]; [`EditError::NotFinite`], also for the pose; [`EditError::TooFewJoints`].
    pub fn pose_instance(
        &mut self,
        key: InstanceKey,
        world_from_local: DAffine3,
        pose: Option<MeshPose>,
    ) -> Result<(), EditError> {
        let instance = self.instance(key).ok_or(stale("instance"))?;
        check_finite(&instance.name, &world_from_local, pose.as_ref())?;
        self.check_joints(&instance.name, instance.mesh, pose.as_ref())?;
        if let Some(instance) = self.instances.edit(key) {
            (instance.world_from_local, instance.pose) = (world_from_local, pose);
        }
        Ok(())
    }

    /// Replaces an instance, and returns the previous one, without [shadow modes](Self::set_shadow_modes).
    ///
    /// # Errors
    /// [`EditError::StaleKey`], also for its mesh and its material; [`EditError::NotFinite`].
    pub fn replace_instance(&mut self, key: InstanceKey, instance: Instance) -> Result<Instance, EditError> {
        self.check_instance(&instance)?;
        let (mesh, material) = (instance.mesh, instance.material);
        let entry = self.instances.edit(key).ok_or(stale("instance"))?;
        let mut previous = std::mem::replace(entry, instance);
        self.object_modes.restore(key, &mut previous);
        self.object_modes.apply_to(key, entry);
        self.meshes.add_user(mesh);
        self.materials.add_user(material);
        self.remove_uses(&previous);
        Ok(previous)
    }

    /// Returns a copy of an instance without [shadow modes](Self::set_shadow_modes).
    #[must_use]
    pub fn own_instance(&self, key: InstanceKey) -> Option<Instance> {
        let mut instance = self.instance(key)?.clone();
        self.object_modes.give_own(key, &mut instance);
        Some(instance)
    }

    /// Returns a copy of a material without [shadow modes](Self::set_shadow_modes).
    #[must_use]
    pub fn own_material(&self, key: MaterialKey) -> Option<Material> {
        let mut material = self.material(key)?.clone();
        self.material_modes.give_own(key, &mut material);
        Some(material)
    }

    /// Edits an instance, for example its flags, without [shadow modes](Self::set_shadow_modes).
    ///
    /// # Errors
    /// As [`replace_instance`](Self::replace_instance).
    pub fn edit_instance(
        &mut self,
        key: InstanceKey,
        edit: impl FnOnce(&mut Instance),
    ) -> Result<(), EditError> {
        let mut instance = self.own_instance(key).ok_or(stale("instance"))?;
        edit(&mut instance);
        self.replace_instance(key, instance).map(drop)
    }

    /// Removes an instance. Its mesh and its material stay.
    ///
    /// # Errors
    /// [`EditError::StaleKey`].
    pub fn remove_instance(&mut self, key: InstanceKey) -> Result<Instance, EditError> {
        let mut removed = self.instances.remove(key).ok_or(stale("instance"))?;
        self.object_modes.restore(key, &mut removed);
        self.remove_uses(&removed);
        Ok(removed)
    }

    /// Inserts a light after the others of its kind.
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use shadowgraph_scene::{Light, LightKind, Scene};
    /// let light = |kind| Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true };
    /// let mut scene = Scene::default();
    /// scene.insert_light(light(LightKind::Point { position_world: DVec3::Y, range: None }));
    /// let sun = scene.insert_light(light(LightKind::Directional { direction: DVec3::NEG_Y }));
    /// assert_eq!(scene.light_index(sun), Some(0));
    /// ```
    pub fn insert_light(&mut self, light: Light) -> LightKey {
        self.lights.insert(light)
    }

    /// Replaces a light, and returns the previous one. A light of another kind is moved after the others of that kind.
    ///
    /// # Errors
    /// [`EditError::StaleKey`].
    pub fn replace_light(&mut self, key: LightKey, light: Light) -> Result<Light, EditError> {
        self.lights.replace(key, light).ok_or(stale("light"))
    }

    /// Removes a light.
    ///
    /// # Errors
    /// [`EditError::StaleKey`].
    pub fn remove_light(&mut self, key: LightKey) -> Result<Light, EditError> {
        self.lights.remove(key).ok_or(stale("light"))
    }

    /// Replaces all lights, ordered by kind. Keys of the previous lights become stale.
    pub fn set_lights(&mut self, lights: impl IntoIterator<Item = Light>) {
        for key in self.lights.keys().to_vec() {
            self.lights.remove(key);
        }
        for light in lights {
            self.lights.insert(light);
        }
    }

    /// Returns the shadow modes of materials and of instances by name.
    #[must_use]
    pub fn shadow_modes(&self) -> (&ByName<MaterialShadows>, &ByName<ObjectShadows>) {
        (&self.material_modes.modes, &self.object_modes.modes)
    }

    /// Gives shadow modes to the materials and instances with these names, present and future ones, until they are replaced. What
    /// [`material`](Self::material) and [`instance`](Self::instance) return has them; edits see and change the own modes of a material or
    /// an instance, which return once no name matches. A renderer of the crate `shadowgraph` sets those of its shadow settings in each frame.
    ///
    /// ```
    /// use shadowgraph_scene::{ByName, Material, MaterialCasts, MaterialShadows, Scene, ShadowModes};
    /// let mut scene = Scene::default();
    /// let leaf = scene.insert_material(Material { name: "leaf".into(), ..Material::default() })?;
    /// let casts = MaterialShadows { casts: Some(MaterialCasts::Clip(0.3)), receives: Some(false) };
    /// let materials = ByName(vec![("lea*".into(), casts)]);
    /// scene.set_shadow_modes(ShadowModes { materials, ..ShadowModes::default() });
    /// assert_eq!(scene.material(leaf).unwrap().shadow_cutoff, Some(0.3));
    /// scene.set_shadow_modes(ShadowModes::default());
    /// assert_eq!(scene.material(leaf).unwrap().shadow_cutoff, None);
    /// # Ok::<(), shadowgraph_scene::EditError>(())
    /// ```
    pub fn set_shadow_modes(&mut self, modes: ShadowModes) {
        self.material_modes.replace(modes.materials, &mut self.materials);
        self.object_modes.replace(modes.objects, &mut self.instances);
    }

    fn check_instance(&self, instance: &Instance) -> Result<(), EditError> {
        self.mesh(instance.mesh).ok_or(stale("mesh"))?;
        self.material(instance.material).ok_or(stale("material"))?;
        check_finite(&instance.name, &instance.world_from_local, instance.pose.as_ref())?;
        self.check_joints(&instance.name, instance.mesh, instance.pose.as_ref())
    }

    fn check_joints(&self, name: &str, mesh: MeshKey, pose: Option<&MeshPose>) -> Result<(), EditError> {
        let skin = self.mesh(mesh).and_then(|mesh| mesh.skin.as_ref());
        let needed = skin.map_or(0, |skin| skin.joint_bounds().len());
        match pose.map(|pose| pose.joints.len()).filter(|joints| (1..needed).contains(joints)) {
            None => Ok(()),
            Some(joints) => {
                Err(EditError::TooFewJoints { what: format!("instance \"{name}\""), joints, needed })
            }
        }
    }

    fn check_images(&self, material: &Material) -> Result<(), EditError> {
        image_keys(material).try_for_each(|image| self.image(image).map(drop).ok_or(stale("image")))
    }

    fn add_uses(&mut self, instance: &Instance) {
        self.meshes.add_user(instance.mesh);
        self.materials.add_user(instance.material);
    }

    fn remove_uses(&mut self, instance: &Instance) {
        self.meshes.remove_user(instance.mesh);
        self.materials.remove_user(instance.material);
    }
}

fn stale(kind: &'static str) -> EditError {
    EditError::StaleKey { kind }
}

fn unused(kind: &str, name: &str, users: u32, by: &'static str) -> Result<(), EditError> {
    if users == 0 { Ok(()) } else { Err(EditError::InUse { what: format!("{kind} \"{name}\""), users, by }) }
}

fn check_finite(name: &str, transform: &DAffine3, pose: Option<&MeshPose>) -> Result<(), EditError> {
    if transform.is_finite() && pose.is_none_or(MeshPose::is_finite) {
        Ok(())
    } else {
        Err(EditError::NotFinite { what: format!("instance \"{name}\"") })
    }
}

fn check_size(image: &Image) -> Result<(), EditError> {
    let Image { width, height, .. } = *image;
    let pixels = u64::from(width) * u64::from(height);
    if pixels > 0 && pixels.checked_mul(4) == Some(image.rgba8.len() as u64) {
        return Ok(());
    }
    Err(EditError::ImageSize {
        what: format!("image \"{}\"", image.name),
        width,
        height,
        bytes: image.rgba8.len(),
    })
}

fn image_keys(material: &Material) -> impl Iterator<Item = ImageKey> {
    material.textures().into_iter().flatten().map(|texture| texture.image)
}
