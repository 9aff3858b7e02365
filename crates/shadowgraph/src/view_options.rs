//! Options of a view.

use shadowgraph_scene::{Camera, Scene};
use shadowgraph_shadows::ShadowSettings;

use crate::options::distance::ShadowDistance;

/// The options of a view.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the image, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings. The default shadow distance is 150 m; the program sets another one by
    /// [`with_shadow_distance`](Self::with_shadow_distance).
    pub shadows: ShadowSettings,
}

impl ViewOptions {
    /// Sets the shadow distance. `Auto`, the program's default, is so large that the fade begins behind the visible part of the
    /// scene, and at most the far plane.
    pub fn with_shadow_distance(mut self, distance: ShadowDistance, scene: &Scene) -> Self {
        self.shadows.distance_m = match distance {
            ShadowDistance::Metres(metres) => metres as f32,
            ShadowDistance::Auto => self.automatic_distance_m(scene) as f32,
        };
        self
    }

    /// Returns the width of the image divided by its height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size_px[0]) / f64::from(self.size_px[1])
    }

    fn automatic_distance_m(&self, scene: &Scene) -> f64 {
        let view_from_world = self.camera.view_from_world();
        let volume = self.camera.frustum(self.aspect());
        let corners = scene.visible_instances(&volume).flat_map(|key| scene.instance_bounds(key).corners());
        let farthest = corners.map(|corner| -view_from_world.transform_point3(corner).z).fold(0.0, f64::max);
        let with_fade = farthest / (1.0 - f64::from(self.shadows.fade_fraction)).max(0.1);
        let near = self.camera.near();
        with_fade.min(self.camera.far().unwrap_or(f64::INFINITY)).clamp(near * 1.001 + 0.001, 1.0e6)
    }
}
