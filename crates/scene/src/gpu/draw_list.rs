//! What is drawn, in which order.

use glam::DVec3;

use super::MaterialKey;

/// The draw of one instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Draw {
    /// What decides the pipeline.
    pub key: MaterialKey,
    /// Index of the material.
    pub material: u32,
    /// Index of the mesh.
    pub mesh: u32,
    /// Index of the instance.
    pub instance: u32,
}

/// The draws of the instances that are seen.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawList {
    /// Opaque and alpha-cut, ordered by key, material and mesh: few changes of state.
    pub solid: Vec<Draw>,
    /// Blended, the farthest first.
    pub blend: Vec<Draw>,
}

impl DrawList {
    /// Sorts draws. `distance` is asked for the blended ones: how far an instance is, in any unit that grows.
    pub(super) fn sorted(draws: impl Iterator<Item = Draw>, distance: impl Fn(u32) -> f64) -> Self {
        let is_blend = |draw: &Draw| draw.key.alpha == super::AlphaKey::Blend;
        let (mut blend, mut solid): (Vec<Draw>, Vec<Draw>) = draws.partition(is_blend);
        solid.sort_unstable();
        // Equally far: in the order of the scene.
        blend.sort_by(|a, b| {
            let nearer = distance(b.instance).total_cmp(&distance(a.instance));
            nearer.then(a.instance.cmp(&b.instance))
        });
        Self { solid, blend }
    }

    /// Returns every draw, the solid ones first.
    pub fn iter(&self) -> impl Iterator<Item = &Draw> {
        self.solid.iter().chain(&self.blend)
    }
}

/// How far the middle of the bounds is from the eye, squared; bounds of nothing are at the eye.
pub(super) fn squared_distance(bounds: &crate::Aabb, eye_world: DVec3) -> f64 {
    if bounds.is_empty() { 0.0 } else { bounds.center().distance_squared(eye_world) }
}

#[cfg(test)]
mod tests {
    use super::super::AlphaKey;
    use super::*;

    fn draw(alpha: AlphaKey, material: u32, mesh: u32, instance: u32) -> Draw {
        Draw { key: MaterialKey { alpha, double_sided: false, mirrored: false }, material, mesh, instance }
    }

    #[test]
    fn solid_draws_are_ordered_by_key_then_material_then_mesh() {
        use AlphaKey::{Mask, Opaque};
        let ordered = [
            draw(Opaque, 0, 5, 7),
            draw(Opaque, 1, 0, 3),
            draw(Opaque, 1, 2, 1),
            draw(Opaque, 1, 2, 4),
            draw(Mask, 0, 0, 0),
        ];
        for start in 0..ordered.len() {
            let shuffled = ordered.iter().cycle().skip(start).take(ordered.len());
            let list = DrawList::sorted(shuffled.copied(), |_| 0.0);
            assert_eq!(list.solid, ordered);
            assert!(list.blend.is_empty());
        }
    }

    #[test]
    fn mirrored_and_double_sided_draws_are_grouped() {
        let mut keys: Vec<MaterialKey> = MaterialKey::all().collect();
        keys.sort();
        assert!(keys.iter().copied().eq(MaterialKey::all()));
    }

    #[test]
    fn blended_draws_are_apart_and_the_farthest_is_first() {
        let draws = [(0, 4.0), (1, 9.0), (2, 1.0), (3, 9.0)].map(|(i, _)| draw(AlphaKey::Blend, i, 0, i));
        let solid = draw(AlphaKey::Opaque, 0, 0, 4);
        let distances = [4.0, 9.0, 1.0, 9.0, f64::NAN];
        let list = DrawList::sorted(draws.into_iter().chain([solid]), |i| distances[i as usize]);
        assert_eq!(list.solid, [solid]);
        assert_eq!(list.blend.iter().map(|draw| draw.instance).collect::<Vec<_>>(), [1, 3, 0, 2]);
        assert_eq!(list.iter().count(), 5);
    }
}
