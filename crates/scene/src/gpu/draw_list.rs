//! Draws, and the order in which they are recorded.

use glam::DVec3;

use super::key::{AlphaKey, PipelineKey};
use crate::bounds::Aabb;
use crate::material::CasterMode;

/// The draw of one instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Draw {
    /// The key of the pipeline.
    pub key: PipelineKey,
    /// Kind of shadow that it casts.
    pub casts: CasterMode,
    /// Index of the material.
    pub material: u32,
    /// Index of the mesh.
    pub mesh: u32,
    /// The first vertex of a deformed mesh among those that [`pose_inputs`](super::GpuScene::pose_inputs) deforms.
    pub posed: Option<u32>,
    /// Number of the instance: see [`GpuScene`](super::GpuScene).
    pub instance: u32,
}

impl Draw {
    /// Returns whether this draw equals `first` but for its instance number, which is `instance`.
    pub(super) fn continues(&self, first: &Self, instance: u32) -> bool {
        *self == Self { instance, ..*first }
    }
}

/// The pipeline of a draw.
#[derive(Clone, Copy, Debug)]
pub struct DrawPipeline<'p> {
    /// The pipeline.
    pub pipeline: &'p wgpu::RenderPipeline,
    /// What the pipeline reads from group 2.
    pub material: MaterialUse,
}

/// What a pipeline reads of the material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaterialUse {
    /// Nothing: group 2 can be unset.
    None,
    /// Its alpha: the texture of the base colour has one channel. Other textures are white.
    Alpha,
    /// All of it.
    All,
}

/// The draws of the visible instances.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawList {
    /// Opaque and alpha-tested draws, ordered by key, material and mesh, for few state changes.
    pub solid: Vec<Draw>,
    /// Blended draws, the farthest first.
    pub blend: Vec<Draw>,
}

impl DrawList {
    /// Replaces the contents by these draws; solid ones keep their order. `distance` returns the distance of a blended
    /// instance, in any monotonic unit.
    pub(super) fn fill(&mut self, draws: impl Iterator<Item = Draw>, distance: impl Fn(u32) -> f64) {
        let Self { solid, blend } = self;
        solid.clear();
        blend.clear();
        for draw in draws {
            if draw.key.alpha == AlphaKey::Blend { blend.push(draw) } else { solid.push(draw) }
        }
        // At equal distance the smaller number is first.
        blend.sort_unstable_by(|a, b| {
            let by_distance = distance(b.instance).total_cmp(&distance(a.instance));
            by_distance.then(a.instance.cmp(&b.instance))
        });
    }

    /// Returns all draws, the solid ones first.
    pub fn iter(&self) -> impl Iterator<Item = &Draw> {
        self.solid.iter().chain(&self.blend)
    }
}

/// Returns the squared distance from the centre of the bounds to the eye; 0 for empty bounds.
pub(super) fn squared_distance(bounds: &Aabb, eye_world: DVec3) -> f64 {
    if bounds.is_empty() { 0.0 } else { bounds.center().distance_squared(eye_world) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(alpha: AlphaKey, material: u32, mesh: u32, instance: u32) -> Draw {
        let key = PipelineKey { alpha, double_sided: false, mirrored: false };
        Draw { key, casts: CasterMode::On, material, mesh, posed: None, instance }
    }

    fn list(draws: impl Iterator<Item = Draw>, distance: impl Fn(u32) -> f64) -> DrawList {
        let mut list = DrawList::default();
        list.fill(draws, distance);
        list
    }

    #[test]
    fn draws_are_ordered_by_key_then_material_then_mesh() {
        use AlphaKey::{Mask, Opaque};
        let ordered = [
            draw(Opaque, 0, 5, 7),
            draw(Opaque, 1, 0, 3),
            draw(Opaque, 1, 2, 1),
            draw(Opaque, 1, 2, 4),
            draw(Mask, 0, 0, 0),
        ];
        assert!(ordered.is_sorted());
        let list = list(ordered.into_iter(), |_| 0.0);
        assert_eq!(list.solid, ordered);
        assert!(list.blend.is_empty());
    }

    #[test]
    fn consecutive_instances_of_the_same_mesh_and_material_share_a_draw_call() {
        use AlphaKey::Opaque;
        let first = draw(Opaque, 1, 2, 4);
        assert!(draw(Opaque, 1, 2, 5).continues(&first, 5) && draw(Opaque, 1, 2, 6).continues(&first, 6));
        for other in [draw(Opaque, 1, 2, 6), draw(Opaque, 0, 2, 5), draw(Opaque, 1, 3, 5)] {
            assert!(!other.continues(&first, 5));
        }
    }

    #[test]
    fn mirrored_and_double_sided_draws_are_grouped() {
        let mut keys: Vec<PipelineKey> = PipelineKey::all().collect();
        keys.sort();
        assert!(keys.iter().copied().eq(PipelineKey::all()));
    }

    #[test]
    fn blended_draws_are_separate_and_the_farthest_is_first() {
        let draws = [(0, 4.0), (1, 9.0), (2, 1.0), (3, 9.0)].map(|(i, _)| draw(AlphaKey::Blend, i, 0, i));
        let solid = draw(AlphaKey::Opaque, 0, 0, 4);
        let distances = [4.0, 9.0, 1.0, 9.0, f64::NAN];
        let list = list(draws.into_iter().chain([solid]), |i| distances[i as usize]);
        assert_eq!(list.solid, [solid]);
        assert_eq!(list.blend.iter().map(|draw| draw.instance).collect::<Vec<_>>(), [1, 3, 0, 2]);
        assert_eq!(list.iter().count(), 5);
    }
}
