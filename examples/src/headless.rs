//! Pictures without a window.

use crate::{Arguments, Canvas, Example, Failure, target};
use indicatif::ProgressBar;
use shadowgraph::core::{Graph, Subresource};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::{Gpu, wgpu};

pub(crate) fn run<E: Example>(gpu: &Gpu, arguments: &Arguments) -> Result<(), Failure> {
    let mut example = E::new(gpu, arguments.word.as_deref())?;
    let frames = arguments.frames.unwrap_or(E::FRAMES);
    let picture = target(&gpu.device, E::SIZE_PX);
    let progress = if frames > 1 { ProgressBar::new(frames.into()) } else { ProgressBar::hidden() };
    for number in 0..frames {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        example.draw(Canvas { gpu, encoder: &mut encoder, target: &picture, number })?;
        gpu.queue.submit([encoder.finish()]);
        let file = match E::SEQUENCE {
            true => format!("out/{}/{number:02}.png", E::NAME),
            false => format!("out/{}.png", E::NAME),
        };
        if E::SEQUENCE || number + 1 == frames {
            let [width, height] = E::SIZE_PX;
            write_png(file.as_ref(), width, height, Pixels::Rgba, &texels(gpu, &picture)?)?;
        }
        progress.inc(1);
    }
    progress.finish();
    Ok(())
}

/// Reads a texture back, by a graph that does nothing else.
fn texels(gpu: &Gpu, picture: &wgpu::Texture) -> Result<Vec<u8>, Failure> {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let picture = frame.import_texture("picture", picture, true);
    let request = frame.read_back_texture(&picture, Subresource::FULL);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
    gpu.queue.submit([encoder.finish()]);
    Ok(executed.read_back(request).ok_or("nothing was read back")?.wait(&gpu.device)?)
}
