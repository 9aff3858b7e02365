//! The shadow techniques by name.

use glam::DVec3;
use shadowgraph_scene::Scene;
use shadowgraph_shadows::rays::GpuRayScene;
use shadowgraph_shadows::{NoShadows, Pcf, Pcss, Raytraced, ScreenShadows, ShadowTechnique};

use crate::options::{Pipeline, Technique};
use crate::{Error, Gpu, Method, ray_scene};

/// Makes a technique for a scene whose GPU positions are relative to `origin_world`.
pub(crate) fn make(
    method: Method,
    gpu: &Gpu,
    scene: &Scene,
    origin_world: DVec3,
) -> Result<Box<dyn ShadowTechnique>, Error> {
    let device = &gpu.device;
    let technique: Box<dyn ShadowTechnique> = match method.technique {
        Technique::Pcf => Box::new(Pcf::new(device)),
        Technique::Pcss => Box::new(Pcss::new(device)),
        Technique::None => Box::new(NoShadows::new(device)),
        Technique::Raytraced => {
            let limit = device.limits().max_storage_buffer_binding_size;
            let rays = GpuRayScene::new(&ray_scene(scene, origin_world)?, limit);
            Box::new(Raytraced::new(device, &rays.map_err(shadowgraph_shadows::Error::from)?)?)
        }
    };
    Ok(match method.pipeline {
        Pipeline::ScreenShadows => Box::new(ScreenShadows::new(device, technique)?),
        Pipeline::Forward | Pipeline::Minimal => technique,
    })
}
