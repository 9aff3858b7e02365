//! Culling of instances on the GPU.

mod first_instance;
mod lists;
mod occlusion;
mod pyramid;

use crate::stage::{box_mesh, material};
use glam::{DAffine3, DQuat, DVec3, Vec4};
use shadowgraph::scene::{Instance, Material, Scene};

/// Pseudo-random numbers.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Returns a number from 0 to 1.
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        ((self.next() * count as f64) as usize).min(count - 1)
    }
}

/// Returns turned and stretched boxes of four meshes and three materials.
fn boxes(random: &mut Random, count: usize) -> Scene {
    let mut scene = Scene::default();
    let meshes: Vec<_> = (0..4)
        .map(|_| {
            let half =
                DVec3::new(random.between(0.1, 1.0), random.between(0.1, 2.0), random.between(0.1, 1.0));
            let offset = DVec3::Y * random.between(-1.0, 1.0);
            scene.insert_mesh(box_mesh(offset - half, offset + half))
        })
        .collect();
    let materials: Vec<_> = (0..3)
        .map(|index| {
            let base_color = Vec4::new(0.3 * index as f32, 0.5, 0.9 - 0.3 * index as f32, 1.0);
            scene.insert_material(Material { base_color, ..material() }).unwrap()
        })
        .collect();
    for _ in 0..count {
        let mesh = meshes[random.below(meshes.len())];
        let material = materials[random.below(materials.len())];
        scene.insert_instance(Instance::new(mesh, material, transform(random))).unwrap();
    }
    scene
}

/// Returns a random turn, stretch and position.
fn transform(random: &mut Random) -> DAffine3 {
    let mut axis = |reach: f64| random.between(-reach, reach);
    let at = DVec3::new(axis(30.0), axis(6.0) + 4.0, axis(30.0));
    let turn = DQuat::from_scaled_axis(DVec3::new(axis(3.0), axis(3.0), axis(3.0)));
    let scale = DVec3::new(axis(1.0), axis(1.0), axis(1.0)).map(|size| size.signum() * (0.2 + size.abs()));
    DAffine3::from_scale_rotation_translation(scale, turn, at)
}
