//! Stability: how much shadows change while the camera, the sun or objects move, beyond what the soft reference changes.

use glam::{DAffine3, DVec3};
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_scene::{InstanceKey, Light, LightKind, Scene};
use shadowgraph_shadows::{ShadowSettings, Technique};

use super::comparator::pixel_m_at_1m;
use super::metrics::{Truths, stability};
use super::motion::{STEP_PX, camera_walk, turned_sun};
use super::report::{MotionCase, Moving};
use super::{Comparator, MeasuredLight, MeasuredScene, Points, Probe, Query, Reference};
use crate::Error;

/// Default size of the images of [`measure_motion`], pixels.
pub const MOTION_SIZE_PX: [u32; 2] = [480, 270];

/// Number of frames of a path.
pub const MOTION_FRAMES: u32 = 32;

/// Default number of rays of the soft reference of [`measure_motion`]. They are the same in each frame, and one more or less is far below
/// [`CHANGE`](super::metrics::CHANGE).
pub const MOTION_RAYS: u32 = 256;

/// Excess per step that is drawn in full red.
const FULL_RED: f32 = 0.1;

/// Options of [`measure_motion`].
#[derive(Clone, Debug)]
pub struct MotionTask {
    /// The techniques.
    pub techniques: Vec<Technique>,
    /// Width and height of the images, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings.
    pub settings: ShadowSettings,
    /// Shadow distance, which overrides that of the settings.
    pub distance: Option<ShadowDistance>,
    /// What moves, each on its own path.
    pub moving: Vec<Moving>,
    /// Number of frames of a path, at least 2.
    pub frames: u32,
    /// Number of rays per pixel of the soft reference, at least 1.
    pub soft_rays: u32,
}

/// Result of one technique along one path.
#[derive(Clone, Debug)]
pub struct MotionMeasured {
    /// The numbers.
    pub report: MotionCase,
    /// Where shadows change too much, four bytes per pixel: grey is the visibility in the first frame, red the excess, full red an
    /// excess of 0.1 per step. Pixels that do not count are black.
    pub image_rgba8: Vec<u8>,
}

/// Measures how much a scene's shadows change along paths of the camera, of each measured sun and of objects. Each result is passed to
/// `on_result` immediately; an error that it returns ends the measurement.
///
/// Visibilities are evaluated at the surfaces of the first frame's pixels; where objects move, at those of each frame. Pixels count
/// that are receivers in all frames.
///
/// # Errors
/// As [`measure`](super::measure).
pub fn measure_motion<E: From<Error>>(
    gpu: &Gpu,
    measured_scene: &MeasuredScene,
    task: &MotionTask,
    on_result: &mut dyn FnMut(MotionMeasured) -> Result<(), E>,
) -> Result<(), E> {
    for light in &measured_scene.lights {
        let mut run = Run::new(gpu, measured_scene, task, light)?;
        for view in 0..measured_scene.views.len() {
            for &moving in &task.moving {
                for measured in run.measure(view, moving)? {
                    on_result(measured)?;
                }
            }
        }
    }
    Ok(())
}

/// The renderers of a light's visibility, one for each technique.
struct Run<'a> {
    gpu: &'a Gpu,
    measured_scene: &'a MeasuredScene,
    task: &'a MotionTask,
    light: &'a MeasuredLight,
    renderers: Vec<(Technique, Renderer, Probe)>,
}

/// A moment of a path.
struct Moment {
    options: ViewOptions,
    lights: Vec<Light>,
    /// Instances that are moved, and their transforms.
    moved: Vec<(InstanceKey, DAffine3)>,
}

impl Moment {
    /// Moves a renderer's lights and instances.
    fn apply(&self, gpu: &Gpu, renderer: &mut Renderer) -> Result<(), Error> {
        let scene = renderer.scene_mut();
        scene.set_lights(self.lights.iter().cloned());
        for &(key, world_from_local) in &self.moved {
            scene.move_instance(key, world_from_local)?;
        }
        Ok(renderer.begin_frame(gpu, &self.options)?)
    }
}

impl<'a> Run<'a> {
    fn new(
        gpu: &'a Gpu,
        measured_scene: &'a MeasuredScene,
        task: &'a MotionTask,
        light: &'a MeasuredLight,
    ) -> Result<Self, Error> {
        let mut run = Self { gpu, measured_scene, task, light, renderers: Vec::new() };
        let Some((_, eye)) = measured_scene.views.first() else { return Ok(run) };
        let mut scene = measured_scene.scene.clone();
        scene.set_lights(light.all.iter().cloned());
        for &technique in &task.techniques {
            let aov = Aov::Visibility(light.index as u32);
            let renderer = Renderer::with_config(gpu, scene.clone(), eye, aov, technique)?;
            let probe = Probe::new(gpu, &renderer)?;
            run.renderers.push((technique, renderer, probe));
        }
        Ok(run)
    }

    /// Measures all techniques on a path; none if it does not suit the light.
    fn measure(&mut self, view: usize, moving: Moving) -> Result<Vec<MotionMeasured>, Error> {
        let Some((view_name, camera)) = self.measured_scene.views.get(view) else { return Ok(Vec::new()) };
        let MotionTask { size_px, settings, distance, .. } = self.task;
        let options = ViewOptions { camera: camera.clone(), size_px: *size_px, shadows: settings.clone() };
        let options = match distance {
            Some(distance) => options.with_shadow_distance(*distance, &self.measured_scene.scene),
            None => options,
        };
        let Some((_, first, _)) = self.renderers.first_mut() else { return Ok(Vec::new()) };
        let mut comparator = Comparator::new(self.gpu, first, self.light.index)?;
        first.scene_mut().set_lights(self.light.all.iter().cloned());
        let start = comparator.reference(first, &options, 0)?;
        let path = path(moving, &options, self.light, &start, &self.measured_scene.scene, self.task.frames);
        let Some(origin) = path.first() else { return Ok(Vec::new()) };
        let mut truths = Truths::default();
        let mut points = vec![Points::new(self.gpu, &start.surfaces)];
        let mut counts: Vec<bool> =
            (0..start.truth.hard.len()).map(|pixel| start.is_receiver(pixel)).collect();
        for moment in &path {
            // While only the camera moves, the truth at a world point is constant.
            if moving == Moving::Camera {
                truths.soft.push(start.truth.hard.clone());
                truths.hard.push(start.truth.hard.clone());
                continue;
            }
            moment.apply(self.gpu, first)?;
            let reference = comparator.reference(first, &moment.options, self.task.soft_rays)?;
            for (pixel, counts) in counts.iter_mut().enumerate() {
                *counts &= reference.is_receiver(pixel);
            }
            if moving == Moving::Objects {
                points.push(Points::new(self.gpu, &reference.surfaces));
            }
            truths.soft.extend(reference.soft);
            truths.hard.push(reference.truth.hard);
        }
        if moving == Moving::Objects {
            points.remove(0);
        }
        let pixels: Vec<usize> = (0..counts.len()).filter(|&pixel| counts[pixel]).collect();
        let chosen = |values: &Vec<f32>| pixels.iter().map(|&pixel| values[pixel]).collect::<Vec<_>>();
        let truths = Truths {
            soft: truths.soft.iter().map(chosen).collect(),
            hard: truths.hard.iter().map(chosen).collect(),
        };
        let mut results = Vec::with_capacity(self.renderers.len());
        for (technique, renderer, probe) in &mut self.renderers {
            let visibilities = visibilities(self.gpu, renderer, probe, &path, &points, self.light.index)?;
            // For the next path.
            origin.apply(self.gpu, renderer)?;
            let frames: Vec<Vec<f32>> = visibilities.iter().map(chosen).collect();
            let (stability, excess) = stability(&frames, &truths)?;
            let report = MotionCase {
                scene: self.measured_scene.name.clone(),
                light: self.light.name.clone(),
                view: view_name.clone(),
                technique: technique.name(),
                moving,
                stability,
            };
            let image_rgba8 = image(&visibilities[0], &pixels, &excess);
            results.push(MotionMeasured { report, image_rgba8 });
        }
        Ok(results)
    }
}

/// Evaluates the visibility at all points in every frame of a path.
fn visibilities(
    gpu: &Gpu,
    renderer: &mut Renderer,
    probe: &Probe,
    path: &[Moment],
    points: &[Points],
    light: usize,
) -> Result<Vec<Vec<f32>>, Error> {
    let query = Query { light: light as u32, coarser: false };
    let mut visibilities = Vec::with_capacity(path.len());
    // The same points in every frame, or others in each.
    for (moment, points) in path.iter().zip(points.iter().chain(std::iter::repeat(&points[points.len() - 1])))
    {
        moment.apply(gpu, renderer)?;
        visibilities.push(probe.evaluate(gpu, renderer, &moment.options, points, query)?.visibility);
    }
    Ok(visibilities)
}

/// Returns the frames of a path; none if it does not suit the light.
fn path(
    moving: Moving,
    options: &ViewOptions,
    light: &MeasuredLight,
    start: &Reference,
    scene: &Scene,
    frames: u32,
) -> Vec<Moment> {
    let moment = |frame| {
        let (mut options, mut lights, mut moved) = (options.clone(), light.all.clone(), Vec::new());
        match moving {
            Moving::Camera => {
                let distance_m = start.median_depth_m()?;
                options.camera = camera_walk(&options.camera, frame, options.size_px[1], distance_m);
            }
            Moving::Sun => {
                let LightKind::Directional { direction } = &mut lights.get_mut(light.index)?.kind else {
                    return None;
                };
                *direction = turned_sun(*direction, frame);
            }
            Moving::Objects => {
                let pixel_m =
                    f64::from(pixel_m_at_1m(&options.camera, options.size_px[1])) * start.median_depth_m()?;
                moved =
                    moved_objects(scene, DVec3::new(0.8, 0.0, 0.6) * (STEP_PX * pixel_m * f64::from(frame)));
                if moved.is_empty() {
                    return None;
                }
            }
        }
        Some(Moment { options, lights, moved })
    };
    (0..frames).map_while(moment).collect()
}

/// Returns the instances that are smaller than half of the scene, moved by an offset.
fn moved_objects(scene: &Scene, offset_m: DVec3) -> Vec<(InstanceKey, DAffine3)> {
    let largest_m = 0.5 * scene.bounds().radius();
    let small = scene.instances().filter(|(key, _)| scene.instance_bounds(*key).radius() < largest_m);
    small
        .map(|(key, instance)| (key, DAffine3::from_translation(offset_m) * instance.world_from_local))
        .collect()
}

fn image(visibility: &[f32], pixels: &[usize], excess: &[f32]) -> Vec<u8> {
    let mut rgba8: Vec<u8> = visibility.iter().flat_map(|_| [0, 0, 0, 255]).collect();
    for (&pixel, excess) in pixels.iter().zip(excess) {
        let (red, grey) = ((excess / FULL_RED).min(1.0), 0.2 + 0.5 * visibility[pixel]);
        let color = [grey + (1.0 - grey) * red, grey * (1.0 - red), grey * (1.0 - red)];
        rgba8[4 * pixel..4 * pixel + 3].copy_from_slice(&color.map(|value| (value * 255.0) as u8));
    }
    rgba8
}
