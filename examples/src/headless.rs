//! Images without a window.

use crate::{Arguments, Canvas, Example, Failure, target};
use indicatif::ProgressBar;
use shadowgraph::core::{Graph, Subresource};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::{Gpu, wgpu};

pub(crate) fn run<E: Example>(gpu: &Gpu, arguments: &Arguments) -> Result<(), Failure> {
    let mut example = E::new(gpu, arguments.argument.as_deref())?;
    let frames = arguments.frames.unwrap_or(E::FRAMES);
    let image = target(&gpu.device, arguments.size_px);
    let progress = if frames > 1 { ProgressBar::new(frames.into()) } else { ProgressBar::hidden() };
    for number in 0..frames {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        example.draw(Canvas { gpu, encoder: &mut encoder, target: &image, number, server: None })?;
        gpu.queue.submit([encoder.finish()]);
        let file = match E::SEQUENCE {
            true => format!("out/{}/{number:02}.png", E::NAME),
            false => format!("out/{}.png", E::NAME),
        };
        if E::SEQUENCE || number + 1 == frames {
            let [width, height] = arguments.size_px;
            write_png(file.as_ref(), width, height, Pixels::Rgba, &texels(gpu, &image)?)?;
        }
        progress.inc(1);
    }
    progress.finish();
    Ok(())
}

/// Reads a texture back with a separate graph.
fn texels(gpu: &Gpu, image: &wgpu::Texture) -> Result<Vec<u8>, Failure> {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let image = frame.import_texture("image", image, true);
    let request = frame.read_back_texture(&image, Subresource::FULL);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
    gpu.queue.submit([encoder.finish()]);
    Ok(executed.read_back(request).ok_or("nothing was read back")?.wait(&gpu.device)?)
}
