//! Options of a view.

use glam::DVec3;
use shadowgraph_scene::{Camera, Scene};
use shadowgraph_shadows::{DistanceMeasure, ShadowSettings};

use crate::error::Error;
use crate::options::distance::ShadowDistance;

/// Number of steps per factor of two of the automatic shadow distance.
const DISTANCE_STEPS: f64 = 8.0;

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
    /// scene, and at most the far plane. It changes in eight steps per factor of two, and stays as it is where it is a step larger
    /// than needed: set it in every frame from the options of the frame before, and cascades are rarely fitted again as the camera
    /// moves.
    ///
    /// ```
    /// use shadowgraph::ViewOptions;
    /// use shadowgraph::options::ShadowDistance;
    /// let scene = shadowgraph_samples::demo::demo_scene();
    /// let options = ViewOptions { camera: scene.cameras[0].clone(), size_px: [64, 36], shadows: Default::default() };
    /// let mut options = options.with_shadow_distance(ShadowDistance::Auto, &scene);
    /// let before_m = options.shadows.distance_m;
    /// options.camera.world_from_view.translation.y += 0.01;
    /// options = options.with_shadow_distance(ShadowDistance::Auto, &scene);
    /// assert_eq!(options.shadows.distance_m, before_m);
    /// ```
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

    /// Returns the index of a pixel, column and row from the top left, in the rows of the image.
    ///
    /// # Errors
    /// [`Error::PixelOutside`].
    pub fn pixel_index(&self, pixel: [u32; 2]) -> Result<usize, Error> {
        let ([x, y], size_px @ [width, height]) = (pixel, self.size_px);
        if x >= width || y >= height {
            return Err(Error::PixelOutside { pixel, size_px });
        }
        Ok(y as usize * width as usize + x as usize)
    }

    fn automatic_distance_m(&self, scene: &Scene) -> f64 {
        let view_from_world = self.camera.view_from_world();
        let volume = self.camera.frustum(self.aspect());
        let corners = scene.visible_instances(&volume).flat_map(|key| scene.instance_bounds(key).corners());
        let on_ground = scene.ground.map(|ground| ground.shadow_bounds(&scene.bounds(), scene.lights()));
        let on_ground = on_ground.filter(|shadows| volume.intersects(shadows));
        let corners = corners.chain(on_ground.into_iter().flat_map(|shadows| shadows.corners()));
        let distance = |corner: DVec3| {
            let in_view = view_from_world.transform_point3(corner);
            match self.shadows.measure {
                DistanceMeasure::ViewDepth => -in_view.z,
                DistanceMeasure::Radius => in_view.length(),
            }
        };
        let farthest = corners.map(distance).fold(0.0, f64::max);
        let with_fade = farthest / (1.0 - f64::from(self.shadows.fade_fraction)).max(0.1);
        let step = (with_fade.log2() * DISTANCE_STEPS).ceil();
        let [needed_m, spare_m] = [step, step + 1.0].map(|step| (step / DISTANCE_STEPS).exp2());
        let stays = self.shadows.distance_m == spare_m as f32;
        let near = self.camera.near();
        (if stays { spare_m } else { needed_m })
            .min(self.camera.far().unwrap_or(f64::INFINITY))
            .clamp(near * 1.001 + 0.001, 1.0e6)
    }
}
