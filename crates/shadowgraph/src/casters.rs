//! A scene's instances as shadow casters.

use shadowgraph_scene::gpu::{CullFaces, DepthPipelines, DepthTarget, Draw, GpuScene};
use shadowgraph_scene::{Aabb, ConvexVolume};
use shadowgraph_shadows::{CasterTarget, DepthFormat, ShadowCasters};

use crate::Error;

/// The instances of a scene on the GPU, as casters. They are numbered in the order in which they are drawn with few
/// changes of state, so that culling gives draws that need no sorting. What is alpha-cut casts the shadow of what is
/// left; what is blended, of what is more than half opaque.
pub struct SceneCasters {
    /// The scene.
    pub scene: GpuScene,
    /// By number.
    draws: Vec<Draw>,
    /// For each format of a map.
    pipelines: Vec<(wgpu::TextureFormat, DepthPipelines)>,
}

impl SceneCasters {
    /// Makes the pipelines that draw the casters.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device, scene: GpuScene) -> Result<Self, Error> {
        let target = DepthTarget { clamp_near: true, ..DepthTarget::default() };
        Self::with_target(device, scene, &target)
    }

    /// Draws the casters in another way than usual; format and faces of `target` are not looked at.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn with_target(device: &wgpu::Device, scene: GpuScene, target: &DepthTarget) -> Result<Self, Error> {
        let pipelines = |depth: DepthFormat| {
            let format = depth.texture_format();
            // Both faces: a wall without a back casts a shadow to either side.
            let target = DepthTarget { format, faces: CullFaces::None, ..*target };
            Ok((format, DepthPipelines::new(device, scene.layouts(), &target)?))
        };
        let pipelines = DepthFormat::ALL.into_iter().map(pipelines).collect::<Result<_, Error>>()?;
        let all: Vec<u32> = (0..scene.bounds().len() as u32).collect();
        let draws = scene.draw_list(&all, scene.origin_world()).iter().copied().collect();
        Ok(Self { scene, draws, pipelines })
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

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, target: CasterTarget, casters: &[u32]) {
        let made = self.pipelines.iter().find(|(format, _)| *format == target.format);
        // Maps have no other formats.
        let Some((_, pipelines)) = made else { return };
        let draws: Vec<Draw> =
            casters.iter().filter_map(|&number| self.draws.get(number as usize)).copied().collect();
        self.scene.draw(pass, &draws, false, &|key| pipelines.get(key));
    }
}
