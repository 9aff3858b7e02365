//! The time of whole frames.

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use shadowgraph::{Gpu, Renderer, ViewOptions};

use super::{drawing_maps, idle, require_color, target};
use crate::Error;

/// Number of frames that are drawn before those that are measured. Software drivers compile shaders at the first draws.
const WARM_UP: u32 = 3;

/// The time of a whole frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WholeFrame {
    /// From its beginning until the GPU has finished.
    pub wall: Duration,
    /// Processor time of the thread that draws it, without that of the driver's threads.
    pub thread: Duration,
}

/// Draws `frames` frames, one after the other, and waits for each. Shadow maps are drawn in each frame.
///
/// # Errors
/// Settings out of range, a target over the device's limits, an output that is not `Aov::Color`, a system without a clock
/// for the processor time of a thread, or a failure of the GPU.
pub fn whole_frames(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    frames: u32,
) -> Result<Vec<WholeFrame>, Error> {
    warm_up(gpu, renderer, options)?;
    consecutive(gpu, renderer, options, frames)
}

/// Draws the first frames, in which drivers compile shaders.
///
/// # Errors
/// As [`whole_frames`].
pub fn warm_up(gpu: &Gpu, renderer: &mut Renderer, options: &ViewOptions) -> Result<(), Error> {
    consecutive(gpu, renderer, options, WARM_UP).map(|_| ())
}

/// Draws `frames` frames of each renderer in turns, so that what else the machine does affects all alike, and waits for each. Shadow
/// maps are drawn in each frame. [Warm up](warm_up) each renderer before.
///
/// # Errors
/// As [`whole_frames`].
pub fn whole_frames_in_turn(
    gpu: &Gpu,
    renderers: &mut [(Renderer, ViewOptions)],
    frames: u32,
) -> Result<Vec<Vec<WholeFrame>>, Error> {
    let mut times = vec![Vec::with_capacity(frames as usize); renderers.len()];
    for _ in 0..frames {
        for ((renderer, options), times) in renderers.iter_mut().zip(&mut times) {
            times.extend(consecutive(gpu, renderer, options, 1)?);
        }
    }
    Ok(times)
}

fn consecutive(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    frames: u32,
) -> Result<Vec<WholeFrame>, Error> {
    require_color(renderer)?;
    let options = &drawing_maps(options);
    let target = target(&gpu.device, options.size_px)?;
    gpu.checked(|| {
        let frame = |_| {
            let (begin, thread) = (Instant::now(), ThreadTime::try_now().map_err(Error::Clock)?);
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            renderer.record(gpu, &mut encoder, &target, options)?;
            gpu.queue.submit([encoder.finish()]);
            idle(gpu)?;
            let thread = thread.try_elapsed().map_err(Error::Clock)?;
            Ok(WholeFrame { wall: begin.elapsed(), thread })
        };
        (0..frames).map(frame).collect()
    })
}
