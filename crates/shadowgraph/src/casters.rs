//! A scene's instances as shadow casters.

use shadowgraph_scene::gpu::{CullFaces, DepthPipelines, DepthTarget, GpuScene};
use shadowgraph_scene::{Aabb, ConvexVolume};
use shadowgraph_shadows::{CasterTarget, ShadowCasters};
use wgpu::TextureFormat;

use crate::Error;

/// The instances of a scene on the GPU, as casters: numbered as the scene numbers them. What is alpha-cut casts the
/// shadow of what is left; what is blended, of what is more than half opaque.
pub struct SceneCasters {
    /// The scene.
    pub scene: GpuScene,
    pipelines: DepthPipelines,
}

impl SceneCasters {
    /// Makes the pipelines that draw the casters.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device, scene: GpuScene) -> Result<Self, Error> {
        // Both faces: a wall without a back casts a shadow to either side.
        let target = DepthTarget {
            format: TextureFormat::Depth32Float,
            clamp_near: true,
            faces: CullFaces::None,
            ..DepthTarget::default()
        };
        let pipelines = DepthPipelines::new(device, scene.layouts(), &target)?;
        Ok(Self::with_pipelines(scene, pipelines))
    }

    /// Draws the casters with pipelines of your own, made for `Depth32Float`.
    pub fn with_pipelines(scene: GpuScene, pipelines: DepthPipelines) -> Self {
        Self { scene, pipelines }
    }
}

impl ShadowCasters for SceneCasters {
    fn cull(&self, volume: &ConvexVolume, casters: &mut Vec<u32>) {
        let touching = (0u32..).zip(self.scene.bounds()).filter(|(_, bounds)| volume.intersects(bounds));
        casters.extend(touching.map(|(index, _)| index));
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds().iter().fold(Aabb::EMPTY, |all, bounds| all.union(bounds))
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _target: CasterTarget, casters: &[u32]) {
        let draws = self.scene.draw_list(casters, self.scene.origin_world());
        for draws in [&draws.solid, &draws.blend] {
            self.scene.draw(pass, draws, false, &|key| self.pipelines.get(key));
        }
    }
}
