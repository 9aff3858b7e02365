//! Creating the technique of a configuration.

use glam::DVec3;
use shadowgraph_scene::Scene;
use shadowgraph_shadows::rays::GpuRayScene;
use shadowgraph_shadows::{ShadowTechnique, TechniqueContext};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::occluders::ray_scene;
use crate::render_config::RenderConfig;

/// Creates a technique for a scene whose GPU positions are relative to `origin_world`.
pub(crate) fn create(
    config: &RenderConfig,
    gpu: &Gpu,
    scene: &Scene,
    origin_world: DVec3,
) -> Result<Box<dyn ShadowTechnique>, Error> {
    let rays = || {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        Ok(GpuRayScene::new(&ray_scene(scene, origin_world)?, limit)?)
    };
    let technique = config.technique();
    let technique = if config.pipeline.has_screen_shadows() { technique.with_screen() } else { technique };
    Ok(technique.make(&TechniqueContext::new(&gpu.device).with_rays(&rays))?)
}
