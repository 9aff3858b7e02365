//! In how many permutations the shaders of lit passes come.

use glam::DVec3;
use shadowgraph_scene::Scene;

use shadowgraph_shadows::Technique;

use crate::{Error, Gpu, Method, Pipeline, techniques};

/// How many variants of the lit shader a technique can make a frame ask for. Each of them is compiled for those of the
/// [material keys](shadowgraph_scene::gpu::MaterialKey) that are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Permutations {
    /// Where each pixel asks for its shadows.
    pub asked: u32,
    /// Where shadows are collected on the screen, and the mask tells everything.
    pub collected: u32,
    /// Where shadows are collected on the screen, and something is blended or there are more lights than layers.
    pub collected_and_asked: u32,
}

/// Counts the permutations of a technique.
///
/// # Errors
/// If its WGSL does not compose.
pub fn permutations(technique: Technique) -> Result<Permutations, Error> {
    let gpu = Gpu::noop()?;
    let count = |pipeline| -> Result<u32, Error> {
        let method = Method { technique: Some(technique), pipeline, ..Method::default() };
        Ok(techniques::make(&method, &gpu, &Scene::default(), DVec3::ZERO)?.variant_count())
    };
    let (asked, all) = (count(Pipeline::forward())?, count(Pipeline::screen_shadows())?);
    // The mask alone needs nothing of the technique.
    Ok(Permutations { asked, collected: all - asked, collected_and_asked: asked })
}
