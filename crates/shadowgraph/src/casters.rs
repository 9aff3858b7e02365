//! A scene's instances as shadow casters.

use shadowgraph_scene::gpu::{CullFaces, DepthPipelines, DepthTarget, GpuScene};
use shadowgraph_scene::{Aabb, CullVolume};
use shadowgraph_shadows::{CasterTarget, DepthFormat, ShadowCasters};

use crate::Error;

/// The instances of a scene on the GPU, as casters, with the numbers that they have there. What is alpha-cut casts the shadow of what is
/// left; what is blended, of what is more than half opaque.
pub struct SceneCasters {
    /// The scene.
    pub scene: GpuScene,
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
        Ok(Self { scene, pipelines })
    }

    /// Returns how many triangles some casters have.
    pub fn triangle_count(&self, casters: &[u32]) -> u64 {
        let draws = casters.iter().filter_map(|&number| self.scene.draw_of(number));
        draws.map(|draw| u64::from(self.scene.triangle_count(draw))).sum()
    }
}

impl ShadowCasters for SceneCasters {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        self.scene.cull(volume, casters);
    }

    fn bounds(&self) -> Aabb {
        self.scene.all_bounds()
    }

    fn bounds_of(&self, caster: u32) -> Aabb {
        self.scene.bounds().get(caster as usize).copied().unwrap_or(Aabb::EMPTY)
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, target: CasterTarget, casters: &[u32]) {
        let made = self.pipelines.iter().find(|(format, _)| *format == target.format);
        // Maps have no other formats.
        let Some((_, pipelines)) = made else { return };
        let draws = casters.iter().filter_map(|&number| self.scene.draw_of(number));
        self.scene.draw(pass, draws, false, &|key| pipelines.get(key));
    }
}
