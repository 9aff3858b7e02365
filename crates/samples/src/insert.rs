//! Insertion of what is known to fit: keys of the same scene, finite transforms, whole images.
#![expect(clippy::expect_used, reason = "the procedural scenes are constants, which tests create")]

use glam::DAffine3;
use shadowgraph_scene::animation::{Curve, Interpolation};
use shadowgraph_scene::{Image, ImageKey, Instance, InstanceKey, Material, MaterialKey, MeshKey, Scene};

/// Inserts a material.
pub(crate) fn insert_material(scene: &mut Scene, material: Material) -> MaterialKey {
    scene.insert_material(material).expect("images of the scene")
}

/// Inserts an image.
pub(crate) fn insert_image(scene: &mut Scene, image: Image) -> ImageKey {
    scene.insert_image(image).expect("a whole image")
}

/// Inserts an instance.
pub(crate) fn insert_instance(
    scene: &mut Scene,
    name: &str,
    mesh: MeshKey,
    material: MaterialKey,
    world_from_local: DAffine3,
) -> InstanceKey {
    let instance = Instance::new(mesh, material, world_from_local).with_name(name);
    scene.insert_instance(instance).expect("a mesh and a material of the scene, and a finite transform")
}

/// Creates a curve of rotations (quaternions x, y, z, w) between which it is linear.
pub(crate) fn rotation_curve(times_s: Vec<f32>, values: Vec<f32>) -> Curve {
    Curve::new(times_s, values, 4, Interpolation::Linear).expect("finite values at ascending times")
}

/// Creates a curve of translations between which it is linear.
pub(crate) fn translation_curve(times_s: Vec<f32>, values: Vec<f32>) -> Curve {
    Curve::new(times_s, values, 3, Interpolation::Linear).expect("finite values at ascending times")
}
