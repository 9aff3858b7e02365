//! What one view needs.

use shadowgraph_scene::{Camera, Scene, visible_instances};
use shadowgraph_shadows::ShadowSettings;

use crate::options::ShadowDistance;

/// What a view shows, and how.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// Who looks.
    pub camera: Camera,
    /// Width and height of the picture, pixels.
    pub size_px: [u32; 2],
    /// What the user chose of shadows. They reach 150 m by default; the program sets another distance, see
    /// [`with_shadow_distance`](Self::with_shadow_distance).
    pub shadows: ShadowSettings,
}

impl ViewOptions {
    /// Sets how far shadows reach. `Auto` is so far that all that is seen of the scene lies before their fade, at
    /// most the far plane, and what the program does by default.
    pub fn with_shadow_distance(mut self, distance: ShadowDistance, scene: &Scene) -> Self {
        self.shadows.distance_m = match distance {
            ShadowDistance::Metres(metres) => metres as f32,
            ShadowDistance::Auto => self.automatic_distance_m(scene) as f32,
        };
        self
    }

    pub(crate) fn aspect(&self) -> f64 {
        f64::from(self.size_px[0]) / f64::from(self.size_px[1])
    }

    fn automatic_distance_m(&self, scene: &Scene) -> f64 {
        let bounds: Vec<_> = (0..scene.instances.len()).map(|i| scene.instance_bounds(i)).collect();
        let view_from_world = self.camera.view_from_world();
        let seen = visible_instances(scene, &bounds, &self.camera.frustum(self.aspect()));
        let corners = seen.iter().flat_map(|&instance| bounds[instance as usize].corners());
        let farthest = corners.map(|corner| -view_from_world.transform_point3(corner).z).fold(0.0, f64::max);
        let with_fade = farthest / (1.0 - f64::from(self.shadows.fade_fraction)).max(0.1);
        let near = self.camera.near();
        with_fade.min(self.camera.far().unwrap_or(f64::INFINITY)).clamp(near * 1.001 + 0.001, 1.0e6)
    }
}
