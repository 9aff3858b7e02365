//! A scene's instances as shadow casters.

use shadowgraph_scene::gpu::{CullFaces, DepthPipelines, DepthTarget, Draw, GpuScene};
use shadowgraph_scene::{Aabb, ConvexVolume};
use shadowgraph_shadows::{CasterTarget, ShadowCasters};
use wgpu::TextureFormat;

use crate::Error;

/// The instances of a scene on the GPU, as casters. They are numbered in the order in which they are drawn with few
/// changes of state, so that culling gives draws that need no sorting. What is alpha-cut casts the shadow of what is
/// left; what is blended, of what is more than half opaque.
pub struct SceneCasters {
    /// The scene.
    pub scene: GpuScene,
    /// By number.
    draws: Vec<Draw>,
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
        let all: Vec<u32> = (0..scene.bounds().len() as u32).collect();
        let draws = scene.draw_list(&all, scene.origin_world()).iter().copied().collect();
        Self { scene, draws, pipelines }
    }

    /// Returns how many triangles some casters have.
    pub fn triangle_count(&self, casters: &[u32]) -> u64 {
        let draws = casters.iter().filter_map(|&number| self.draws.get(number as usize));
        draws.map(|draw| u64::from(self.scene.triangle_count(draw))).sum()
    }
}

impl ShadowCasters for SceneCasters {
    fn cull(&self, volume: &ConvexVolume, casters: &mut Vec<u32>) {
        let bounds = self.scene.bounds();
        let touches = |draw: &Draw| volume.intersects(&bounds[draw.instance as usize]);
        casters.extend((0u32..).zip(&self.draws).filter(|(_, draw)| touches(draw)).map(|(number, _)| number));
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds().iter().fold(Aabb::EMPTY, |all, bounds| all.union(bounds))
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _target: CasterTarget, casters: &[u32]) {
        let draws: Vec<Draw> =
            casters.iter().filter_map(|&number| self.draws.get(number as usize)).copied().collect();
        self.scene.draw(pass, &draws, false, &|key| self.pipelines.get(key));
    }
}
