//! A scene's instances as shadow casters.

use shadowgraph_scene::gpu::{CasterPipelines, DepthTarget, GpuScene};
use shadowgraph_scene::{Aabb, CasterMode, CullVolume};
use shadowgraph_shadows::rays::GpuRayScene;
use shadowgraph_shadows::{CasterPass, CasterView, DepthFormat, Mobility, ShadowCasters, TINT_FORMAT};

use crate::error::Error;
use crate::scene_rays::UploadedRays;

/// The instances of a scene on the GPU as casters, by the same numbers. Their flags and materials decide how they cast shadows.
pub struct SceneCasters {
    /// The scene.
    pub scene: GpuScene,
    /// Pipelines by map format.
    pipelines: Vec<(wgpu::TextureFormat, CasterPipelines)>,
    /// The triangles, if the technique traces rays.
    pub(crate) rays: Option<UploadedRays>,
}

impl SceneCasters {
    /// Creates the pipelines that draw the casters.
    ///
    /// # Errors
    /// For a shader that does not compose.
    pub fn new(device: &wgpu::Device, scene: GpuScene) -> Result<Self, Error> {
        let target = DepthTarget { clamp_near: true, ..DepthTarget::default() };
        Self::with_target(device, scene, &target)
    }

    /// Creates pipelines with another depth target than the default; the formats of `target` are ignored.
    ///
    /// # Errors
    /// For a shader that does not compose.
    pub fn with_target(device: &wgpu::Device, scene: GpuScene, target: &DepthTarget) -> Result<Self, Error> {
        let pipelines = |depth: DepthFormat| {
            let format = depth.texture_format();
            let target = DepthTarget { format, tint_format: TINT_FORMAT, ..*target };
            Ok((format, CasterPipelines::new(device, scene.layouts(), &target)?))
        };
        let pipelines = DepthFormat::ALL.into_iter().map(pipelines).collect::<Result<_, Error>>()?;
        Ok(Self { scene, pipelines, rays: None })
    }

    /// Returns the number of triangles of some casters.
    pub fn triangle_count(&self, casters: &[u32]) -> u64 {
        let draws = casters.iter().filter_map(|&number| self.scene.draw_for(number));
        draws.map(|draw| u64::from(self.scene.triangle_count(draw))).sum()
    }
}

impl ShadowCasters for SceneCasters {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        self.scene.cull_casters(volume, casters);
    }

    fn bounds(&self) -> Aabb {
        self.scene.all_caster_bounds()
    }

    fn version(&self, caster: u32) -> Option<u64> {
        self.scene.version(caster)
    }

    fn mobility(&self, caster: u32) -> Mobility {
        if self.scene.is_moving(caster) { Mobility::Moving } else { Mobility::Static }
    }

    fn tints(&self, caster: u32) -> bool {
        self.scene.draw_for(caster).is_some_and(|draw| draw.casts == CasterMode::Tint)
    }

    fn receivers(&self) -> Aabb {
        self.scene.all_bounds()
    }

    fn caster_bounds(&self, caster: u32) -> Aabb {
        self.scene.caster_bounds(caster)
    }

    fn rays(&self) -> Option<&GpuRayScene> {
        self.rays.as_ref().map(UploadedRays::gpu)
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32 {
        let pipelines = self.pipelines.iter().find(|(format, _)| *format == view.target.format);
        // Maps have no other formats.
        let Some((_, pipelines)) = pipelines else { return 0 };
        let draws = casters.iter().filter_map(|&number| self.scene.draw_for(number));
        self.scene.draw(pass, draws, &|draw| match view.target.pass {
            CasterPass::Depth => pipelines.get(draw.casts),
            CasterPass::TintDepth => Some(pipelines.solid()),
            CasterPass::Tint => Some(pipelines.tint()),
        })
    }
}
