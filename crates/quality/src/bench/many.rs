//! CPU time of frames of many objects, with a camera that moves.

use std::time::{Duration, Instant};

use glam::{DAffine3, DVec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::{Culling, Gpu, RenderConfig, Renderer, ViewOptions};
use shadowgraph_scene::{Camera, Instance, Light, Material, Mesh, Projection, Scene};
use shadowgraph_shadows::ShadowSettings;

use super::{graph_frame, idle, target};
use crate::Error;

/// Boxes in a row.
const ROW: usize = 1000;
/// Distance between boxes, metres.
const SPACING_M: f64 = 2.0;
/// Number of materials.
pub const MATERIALS: usize = 64;

/// Frames of a number of boxes.
#[derive(Clone, Debug)]
pub struct ManyFrames {
    /// The number of boxes.
    pub boxes: usize,
    /// What culls them.
    pub culling: Culling,
    /// CPU time of each frame: following the scene, culling, declaring, compiling, recording and submitting.
    pub frames: Vec<Duration>,
}

/// Measures frames of boxes of one mesh and [`MATERIALS`] materials, with a sun and a camera that moves among them, with each kind of
/// culling if the configuration does not choose one. The kinds do not take turns: one fills the caches that the other needs. Times are CPU times, best measured on [`Gpu::noop`].
///
/// # Errors
/// For a configuration that cannot be drawn, and for more boxes than the device's buffers can hold.
pub fn frames_of_many(
    gpu: &Gpu,
    config: &RenderConfig,
    size_px: [u32; 2],
    counts: &[usize],
    frames: u32,
) -> Result<Vec<ManyFrames>, Error> {
    let kinds = match config.culling {
        Culling::Auto => vec![Culling::Cpu, Culling::Gpu],
        culling => vec![culling],
    };
    let mut all = Vec::new();
    for &boxes in counts {
        let scene = scene(boxes)?;
        for &culling in &kinds {
            let config = RenderConfig { culling, ..config.clone() };
            let mut renderer = Renderer::with_config(gpu, scene.clone(), &camera(0), Aov::Color, config)?;
            let frames = flying_frames(gpu, &mut renderer, (size_px, &Default::default()), frames, camera)?;
            all.push(ManyFrames { boxes, culling, frames });
        }
    }
    Ok(all)
}

/// Measures frames of a scene with a camera that moves: `camera` returns that of a frame. A tenth as many frames warm up.
///
/// # Errors
/// For settings out of range.
pub fn flying_frames(
    gpu: &Gpu,
    renderer: &mut Renderer,
    (size_px, shadows): ([u32; 2], &ShadowSettings),
    frames: u32,
    camera: impl Fn(u32) -> Camera,
) -> Result<Vec<Duration>, Error> {
    let target = target(&gpu.device, size_px)?;
    let mut times = Vec::new();
    for frame in 0..frames / 10 + 1 + frames {
        let options = ViewOptions { camera: camera(frame), size_px, shadows: shadows.clone() };
        let start = Instant::now();
        renderer.begin_frame(gpu, &options)?;
        let view = renderer.view(&options, Some(&target));
        graph_frame(gpu, renderer, &view, &mut renderer.graph())?;
        if frame > frames / 10 {
            times.push(start.elapsed());
        }
        idle(gpu)?;
    }
    Ok(times)
}

fn scene(boxes: usize) -> Result<Scene, Error> {
    let mut scene = Scene::default();
    let mesh = scene.insert_mesh(Mesh::cuboid(DVec3::splat(-0.4), DVec3::splat(0.4)));
    let material = |number: usize| {
        let base_color = Vec4::new(number as f32 / MATERIALS as f32, 0.5, 0.5, 1.0);
        scene.insert_material(Material { base_color, ..Material::default() })
    };
    let materials = (0..MATERIALS).map(material).collect::<Result<Vec<_>, _>>()?;
    for number in 0..boxes {
        let at = DVec3::new((number % ROW) as f64, 0.0, (number / ROW) as f64) * SPACING_M;
        let material = materials[number * 7 % MATERIALS];
        scene.insert_instance(Instance::new(mesh, material, DAffine3::from_translation(at)))?;
    }
    scene.insert_light(Light::sun(DVec3::new(0.5, -1.0, 0.3), 50_000.0));
    Ok(scene)
}

/// Returns the camera of a frame, which walks along the boxes.
fn camera(frame: u32) -> Camera {
    let eye = DVec3::new(ROW as f64 * 0.5 * SPACING_M, 3.0, -5.0)
        + DVec3::new(0.3, 0.0, 0.5) * (f64::from(frame) * 0.1);
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
    Camera::look_at(eye, eye + DVec3::new(0.1, -0.1, 1.0), DVec3::Y, projection)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn both_kinds_of_culling_are_measured_for_every_number() {
        let gpu = Gpu::noop().unwrap();
        let runs = frames_of_many(&gpu, &RenderConfig::default(), [64, 36], &[10, 2000], 3).unwrap();
        let kinds: Vec<_> = runs.iter().map(|run| (run.boxes, run.culling, run.frames.len())).collect();
        let expected = [(10, Culling::Cpu), (10, Culling::Gpu), (2000, Culling::Cpu), (2000, Culling::Gpu)];
        assert_eq!(kinds, expected.map(|(boxes, culling)| (boxes, culling, 3)));
    }
}
