//! CPU time of frames in which instances move.

use std::time::Duration;

use glam::{DAffine3, DVec3};
use shadowgraph::options::Aov;
use shadowgraph::{Gpu, RenderConfig, Renderer, ViewOptions};
use shadowgraph_scene::{Camera, Instance, InstanceKey, Light, Material, Mesh, Projection, Scene};

use super::{Clock, graph_frame, idle, target};
use crate::Error;

/// The number of instances of the scene, without its floor.
pub const INSTANCES: usize = 10_000;
/// Instances per row; the rows are [`SPACING_M`] apart, as are the instances of a row.
const ROW: usize = 100;
const SPACING_M: f64 = 2.0;

/// Frames in which as many instances move.
#[derive(Clone, Debug)]
pub struct MovingFrames {
    /// The number of instances that move in each frame.
    pub moving: usize,
    /// The time of each frame.
    pub frames: Vec<MovingFrameTime>,
}

/// CPU time of the steps of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MovingFrameTime {
    /// Moving the instances of the scene.
    pub edit: Duration,
    /// Following the edits: the GPU's transforms and the culling trees.
    pub follow: Duration,
    /// Culling, declaring, compiling, recording and submitting the frame.
    pub draw: Duration,
}

/// Measures frames of [`INSTANCES`] boxes on a floor, `counts` of which move in each frame (at most all), after a tenth as many to warm
/// up. The counts take turns, so that a busy machine affects them alike. Times are CPU times, best measured on [`Gpu::noop`].
///
/// # Errors
/// For a configuration that cannot be drawn.
pub fn moving_frames(
    gpu: &Gpu,
    config: &RenderConfig,
    size_px: [u32; 2],
    counts: &[usize],
    frames: u32,
) -> Result<Vec<MovingFrames>, Error> {
    let (scene, keys) = boxes()?;
    let target = target(&gpu.device, size_px)?;
    let options = ViewOptions { camera: camera(), size_px, shadows: Default::default() };
    // Each count has its own renderer: what moves in one stands in the others.
    let create = |&moving: &usize| {
        let renderer =
            Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, config.clone())?;
        Ok((renderer, MovingFrames { moving: moving.min(keys.len()), frames: Vec::new() }))
    };
    let mut runs = counts.iter().map(create).collect::<Result<Vec<_>, Error>>()?;
    for frame in 0..frames / 10 + 1 + frames {
        for (renderer, run) in &mut runs {
            let time = moving_frame(gpu, renderer, (&options, &target), &keys[..run.moving], frame)?;
            if frame > frames / 10 {
                run.frames.push(time);
            }
            idle(gpu)?;
        }
    }
    Ok(runs.into_iter().map(|(_, run)| run).collect())
}

fn moving_frame(
    gpu: &Gpu,
    renderer: &mut Renderer,
    (options, target): (&ViewOptions, &wgpu::Texture),
    moving: &[InstanceKey],
    frame: u32,
) -> Result<MovingFrameTime, Error> {
    let mut clock = Clock::start();
    let up = 0.2 * (f64::from(frame) * 0.1).sin();
    for (number, &key) in moving.iter().enumerate() {
        let transform = DAffine3::from_translation(position(number) + DVec3::Y * up);
        renderer.scene_mut().move_instance(key, transform)?;
    }
    let edit = clock.lap();
    renderer.begin_frame(gpu, options)?;
    let follow = clock.lap();
    let view = renderer.view(options, Some(target));
    graph_frame(gpu, renderer, &view, &mut renderer.graph())?;
    Ok(MovingFrameTime { edit, follow, draw: clock.lap() })
}

/// Returns the position of a box.
fn position(number: usize) -> DVec3 {
    DVec3::new((number % ROW) as f64, 0.0, (number / ROW) as f64) * SPACING_M
}

/// Creates the boxes on their floor in a sun.
fn boxes() -> Result<(Scene, Vec<InstanceKey>), Error> {
    let mut scene = Scene::default();
    let end = position(INSTANCES - 1) + SPACING_M;
    let floor = Mesh::cuboid(DVec3::new(-SPACING_M, -1.0, -SPACING_M), DVec3::new(end.x, -0.5, end.z));
    scene.add(floor, Material::default(), DAffine3::IDENTITY)?;
    let mesh = scene.insert_mesh(Mesh::cuboid(DVec3::splat(-0.4), DVec3::splat(0.4)));
    let material = scene.insert_material(Material::default())?;
    let insert = |number: usize| {
        scene.insert_instance(Instance::new(mesh, material, DAffine3::from_translation(position(number))))
    };
    let keys = (0..INSTANCES).map(insert).collect::<Result<_, _>>()?;
    scene.insert_light(Light::sun(DVec3::new(0.5, -1.0, 0.3), 50_000.0));
    Ok((scene, keys))
}

/// Returns a camera that sees all boxes.
fn camera() -> Camera {
    let center = position(INSTANCES - 1) * 0.5;
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: Some(1_000.0) };
    Camera::look_at(center + DVec3::new(0.0, 120.0, 200.0), center, DVec3::Y, projection)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn every_count_is_measured_and_at_most_all_boxes_move() {
        let gpu = Gpu::noop().unwrap();
        let runs = moving_frames(&gpu, &RenderConfig::default(), [64, 36], &[0, 1, 20_000], 2).unwrap();
        assert_eq!(runs.iter().map(|run| run.moving).collect::<Vec<_>>(), [0, 1, INSTANCES]);
        assert!(runs.iter().all(|run| run.frames.len() == 2));
        let edit = |run: &MovingFrames| run.frames.iter().map(|time| time.edit).min().unwrap();
        assert!(edit(&runs[2]) > 100 * edit(&runs[0]), "{runs:?}");
    }
}
