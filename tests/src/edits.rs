//! Random edits of a scene.

use glam::{DAffine3, DVec3, Vec4};
use shadowgraph::scene::{EditError, Image, Instance, Mesh, Scene, ShadowCasting};

use crate::random::Random;

/// Returns a transform within some metres of the origin.
pub fn transform(random: &mut Random) -> DAffine3 {
    let at = DVec3::new(random.unit() * 8.0 - 4.0, random.unit() + 0.01, random.unit() * 8.0 - 4.0);
    DAffine3::from_translation(at)
        * DAffine3::from_rotation_y(random.unit() * 6.0)
        * DAffine3::from_scale(DVec3::splat(0.4 + random.unit() * 0.6))
}

/// Makes a random edit of a scene with an instance that stays where it is, the first, and others.
///
/// # Errors
/// If the scene refuses the edit.
pub fn edit(scene: &mut Scene, random: &mut Random) -> Result<(), EditError> {
    let count = scene.instances().len();
    let nth = 1 + random.below(count.max(2) as u64 - 1) as usize;
    let Some((key, instance)) = scene.instances().nth(nth).map(|(key, instance)| (key, instance.clone()))
    else {
        return Ok(());
    };
    let flag = random.flip();
    match random.below(12) {
        0..4 => scene.move_instance(key, transform(random))?,
        4 => {
            let world_from_local = transform(random);
            scene.insert_instance(Instance { world_from_local, ..instance })?;
        }
        5 if count > 4 => {
            let removed = scene.remove_instance(key)?;
            // Refused while other instances use it.
            let _ = scene.remove_mesh(removed.mesh);
        }
        6 => scene.edit_instance(key, |instance| instance.visible = flag)?,
        7 => {
            let casts = [ShadowCasting::On, ShadowCasting::Off, ShadowCasting::ShadowOnly];
            let casts = casts[random.below(3) as usize];
            scene.edit_instance(key, |instance| instance.casts = casts)?;
        }
        8 => {
            let first = scene.instances().next().map(|(key, _)| key).unwrap_or_default();
            scene.edit_instance(first, |first| first.receives_shadows = flag)?;
        }
        9 => {
            let number = random.below(scene.materials().len() as u64) as usize;
            let material = scene.materials().nth(number).map_or(instance.material, |(key, _)| key);
            let mesh = scene.insert_mesh(Mesh::cuboid(DVec3::ZERO, DVec3::new(0.5, 1.5, 0.7)));
            scene.edit_instance(key, |instance| (instance.mesh, instance.material) = (mesh, material))?;
            let _ = scene.remove_mesh(instance.mesh);
        }
        10 => {
            let color = Vec4::new(random.unit() as f32, 0.5, 0.4, 0.6);
            scene.edit_material(instance.material, |material| material.base_color = color)?;
        }
        _ => {
            let Some(image) = scene.images().next().map(|(key, _)| key) else { return Ok(()) };
            let value = random.below(256) as u8;
            let rgba8 = vec![value, 255, 255, 255, 255, 255, value, 0];
            scene.replace_image(image, Image::new("two", 2, 1, rgba8))?;
        }
    }
    Ok(())
}
