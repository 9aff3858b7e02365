//! Making the technique of a method.

use glam::DVec3;
use shadowgraph_scene::Scene;
use shadowgraph_shadows::rays::GpuRayScene;
use shadowgraph_shadows::{ShadowTechnique, TechniqueContext};

use crate::{Error, Gpu, Method, ray_scene};

/// Makes a technique for a scene whose GPU positions are relative to `origin_world`.
pub(crate) fn make(
    method: &Method,
    gpu: &Gpu,
    scene: &Scene,
    origin_world: DVec3,
) -> Result<Box<dyn ShadowTechnique>, Error> {
    let rays = || {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        Ok(GpuRayScene::new(&ray_scene(scene, origin_world)?, limit)?)
    };
    let technique = method.technique();
    let technique = if method.pipeline.collects_shadows() { technique.collected() } else { technique };
    Ok(technique.make(&TechniqueContext::new(&gpu.device).with_rays(&rays))?)
}
