//! Culling of instances.

use crate::{Aabb, ConvexVolume, Scene};

/// Returns the instances whose bounds touch the volume, ascending.
///
/// `bounds` are the world bounds of the scene's instances, one each (kept by the caller, so that they are
/// not computed anew for every volume). Instances without bounds are left out.
#[must_use]
pub fn visible_instances(scene: &Scene, bounds: &[Aabb], volume: &ConvexVolume) -> Vec<u32> {
    let bounds = bounds.iter().take(scene.instances.len());
    (0u32..).zip(bounds).filter(|(_, bounds)| volume.intersects(bounds)).map(|(index, _)| index).collect()
}
