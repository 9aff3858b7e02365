//! A scene: meshes, materials and images, their instances, lights and cameras.

use glam::DAffine3;

use crate::bounds::{Aabb, ConvexVolume};
use crate::camera::Camera;
use crate::light::Light;
use crate::material::{Image, Material};
use crate::mesh::Mesh;

/// One drawn copy of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The name of the node in the file; empty if it has none.
    pub name: String,
    /// Index into the scene's meshes.
    pub mesh: usize,
    /// Index into the scene's materials.
    pub material: usize,
    /// The transform, in f64, absolute.
    pub world_from_local: DAffine3,
}

/// Everything that a renderer needs to draw an image, as plain data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Geometry; instances refer to it by index.
    pub meshes: Vec<Mesh>,
    /// Materials; instances refer to them by index.
    pub materials: Vec<Material>,
    /// Images; materials refer to them by index.
    pub images: Vec<Image>,
    /// The drawn copies of meshes.
    pub instances: Vec<Instance>,
    /// Directional lights, then spot lights, then point lights.
    pub lights: Vec<Light>,
    /// The cameras of the file.
    pub cameras: Vec<Camera>,
    /// The contents of the file that are not drawn as it says, one line each.
    pub notes: Vec<String>,
}

/// Returns the instances whose bounds intersect the volume, ascending.
///
/// `bounds` are the world bounds of the scene's instances, one each (the caller keeps them, so that they are
/// not recomputed for every volume). Instances without bounds are skipped.
#[must_use]
pub fn visible_instances(scene: &Scene, bounds: &[Aabb], volume: &ConvexVolume) -> Vec<u32> {
    let bounds = bounds.iter().take(scene.instances.len());
    (0u32..).zip(bounds).filter(|(_, bounds)| volume.intersects(bounds)).map(|(index, _)| index).collect()
}

impl Scene {
    /// Returns the bounds of all instances; empty without any.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        (0..self.instances.len()).fold(Aabb::EMPTY, |bounds, i| bounds.union(&self.instance_bounds(i)))
    }

    /// Returns the world bounds of an instance; empty if there is no such instance or mesh.
    #[must_use]
    pub fn instance_bounds(&self, instance: usize) -> Aabb {
        let bounds = self.instances.get(instance).and_then(|instance| {
            let mesh = self.meshes.get(instance.mesh)?;
            Some(mesh.bounds.transformed(&instance.world_from_local))
        });
        bounds.unwrap_or(Aabb::EMPTY)
    }

    /// Adds an instance of a mesh with a material and a transform, and returns the index of the instance.
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use shadowgraph_scene::{Material, Mesh, Scene};
    /// let mut scene = Scene::default();
    /// let cube = Mesh::cuboid(DVec3::ZERO, DVec3::ONE);
    /// scene.add(cube, Material::default(), DAffine3::from_translation(DVec3::X));
    /// assert_eq!(scene.bounds().max.x, 2.0);
    /// ```
    pub fn add(&mut self, mesh: Mesh, material: Material, world_from_local: DAffine3) -> usize {
        let name = mesh.name.clone();
        self.meshes.push(mesh);
        self.materials.push(material);
        let (mesh, material) = (self.meshes.len() - 1, self.materials.len() - 1);
        self.instances.push(Instance { name, mesh, material, world_from_local });
        self.instances.len() - 1
    }

    /// Adds a light after the others of its kind, and returns its index.
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use shadowgraph_scene::{Light, LightKind, Scene};
    /// let light = |kind| Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true };
    /// let mut scene = Scene::default();
    /// scene.add_light(light(LightKind::Point { position_world: DVec3::Y, range: None }));
    /// let sun = scene.add_light(light(LightKind::Directional { direction: DVec3::NEG_Y }));
    /// assert_eq!(sun, 0);
    /// ```
    pub fn add_light(&mut self, light: Light) -> usize {
        let index = self.lights.partition_point(|other| other.kind.order() <= light.kind.order());
        self.lights.insert(index, light);
        index
    }

    /// Returns a camera that frames the bounds from the front, the right and above.
    ///
    /// `aspect` is the image's width over its height, above 0.
    #[must_use]
    pub fn framing_camera(&self, aspect: f64) -> Camera {
        Camera::framing(&self.bounds(), aspect)
    }

    /// Returns the number of triangles over all instances.
    #[must_use]
    pub fn triangle_count(&self) -> u64 {
        let triangles = |mesh: usize| self.meshes.get(mesh).map_or(0, |mesh| mesh.indices.len() as u64 / 3);
        self.instances.iter().map(|instance| triangles(instance.mesh)).sum()
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::light::LightKind;
    use crate::mesh::Vertex;

    fn light(name: &str, kind: LightKind) -> Light {
        Light { name: Some(name.into()), kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true }
    }

    #[test]
    fn lights_are_ordered_by_kind_and_then_as_added() {
        let sun = LightKind::Directional { direction: DVec3::NEG_Y };
        let point = LightKind::Point { position_world: DVec3::ZERO, range: None };
        let spot = LightKind::Spot {
            position_world: DVec3::ZERO,
            direction: DVec3::NEG_Y,
            range: None,
            inner_angle: 0.0,
            outer_angle: 0.5,
        };
        let mut scene = Scene::default();
        for (name, kind) in [("a", point), ("b", spot), ("c", point), ("d", sun), ("e", spot), ("f", sun)] {
            let index = scene.add_light(light(name, kind));
            assert_eq!(scene.lights[index].name.as_deref(), Some(name));
        }
        let names: String = scene.lights.iter().filter_map(|light| light.name.as_deref()).collect();
        assert_eq!(names, "dfbeac");
    }

    #[test]
    fn bounds_and_triangles_count_every_instance() {
        let corner = |x, y| Vertex { position: [x, y, 0.0], ..Vertex::default() };
        let vertices = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
        let instance = |mesh, x| Instance {
            name: String::new(),
            mesh,
            material: 0,
            world_from_local: DAffine3::from_translation(DVec3::X * x),
        };
        let scene = Scene {
            meshes: vec![Mesh::new("triangle", vertices, vec![0, 1, 2])],
            instances: vec![instance(0, 0.0), instance(0, 1e7), instance(7, 0.0)],
            ..Scene::default()
        };
        assert_eq!(scene.bounds(), Aabb { min: DVec3::ZERO, max: DVec3::new(1e7 + 1.0, 1.0, 0.0) });
        assert_eq!(scene.triangle_count(), 2);
        assert!(scene.instance_bounds(2).is_empty() && scene.instance_bounds(9).is_empty());
    }

    #[test]
    fn culling_keeps_what_the_framing_camera_shows_and_drops_what_is_behind_it() {
        let corner = |x, y| Vertex { position: [x, y, 0.0], ..Vertex::default() };
        let vertices = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
        let instance = |translation| Instance {
            name: String::new(),
            mesh: 0,
            material: 0,
            world_from_local: DAffine3::from_translation(translation),
        };
        let mut scene = Scene {
            meshes: vec![Mesh::new("triangle", vertices, vec![0, 1, 2])],
            instances: vec![instance(DVec3::ZERO), instance(DVec3::X * 3.0)],
            ..Scene::default()
        };
        let camera = scene.framing_camera(1.5);
        scene.instances.insert(1, instance(camera.position_world() * 3.0));
        let bounds: Vec<Aabb> = (0..3).map(|i| scene.instance_bounds(i)).collect();
        assert_eq!(visible_instances(&scene, &bounds, &camera.frustum(1.5)), [0, 2]);
    }
}
