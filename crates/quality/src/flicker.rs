//! Flicker: change of a technique's shadows while the camera moves.

use super::metrics::flicker;
use super::motion::{FAR_OFFSET_M, camera_for_frame, translated};
use super::report::{Flicker, Motion};
use shadowgraph_shadows::Technique;

use super::{Comparator, Points, Probe, Query};
use shadowgraph::options::Aov;
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// Size of the image whose surface points are evaluated, pixels.
pub const FLICKER_SIZE_PX: [u32; 2] = [320, 180];

/// Measures a technique's flicker in a view of a renderer's scene, for a light: all motions, at the original
/// location of the scene and ten kilometres away, each over `frames` frames.
///
/// # Errors
/// Settings out of range, or a failure of the GPU.
pub fn measure_flicker(
    gpu: &Gpu,
    renderer: &mut Renderer,
    technique: Technique,
    options: &ViewOptions,
    light: usize,
    frames: u32,
) -> Result<Vec<Flicker>, Error> {
    let mut flickers = measure_motions(gpu, renderer, options, light, frames, false)?;
    let mut far = options.clone();
    far.camera.world_from_view.translation += FAR_OFFSET_M;
    let scene = translated(renderer.scene(), FAR_OFFSET_M)?;
    let aov = Aov::Visibility(light as u32);
    let mut renderer = Renderer::with_config(gpu, scene, &far.camera, aov, technique)?;
    flickers.extend(measure_motions(gpu, &mut renderer, &far, light, frames, true)?);
    Ok(flickers)
}

fn measure_motions(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    light: usize,
    frames: u32,
    far_out: bool,
) -> Result<Vec<Flicker>, Error> {
    let options = ViewOptions { size_px: FLICKER_SIZE_PX, ..options.clone() };
    let reference = Comparator::new(gpu, renderer, light)?.reference(renderer, &options, 0)?;
    let (probe, points) = (Probe::new(gpu, renderer)?, Points::new(gpu, &reference.surfaces));
    let Some(distance_m) = reference.median_depth_m() else { return Ok(Vec::new()) };
    let truth = reference.receiver_values(&reference.truth.hard);
    let query = Query { light: light as u32, coarser: false };
    let change = |motion| {
        let visibilities = (0..frames).map(|frame| {
            let camera = camera_for_frame(&options.camera, motion, frame, options.size_px[1], distance_m);
            let view = ViewOptions { camera, ..options.clone() };
            let results = probe.evaluate(gpu, renderer, &view, &points, query)?;
            Ok(reference.receiver_values(&results.visibility))
        });
        let visibilities = visibilities.collect::<Result<Vec<_>, Error>>()?;
        // Neither the scene nor the light moves, so the reference at a world point is constant.
        Ok(Flicker {
            motion,
            far_out,
            change: flicker(&visibilities, &vec![truth.clone(); visibilities.len()])?,
        })
    };
    [Motion::Translate, Motion::Rotate, Motion::Zoom].into_iter().map(change).collect()
}
