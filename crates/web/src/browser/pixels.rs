//! Reading of images.

use shadowgraph::core::{Graph, ReadBack, Subresource};
use shadowgraph::{Error, Gpu, wgpu};

/// Begins to read the texels of an image, which arrive some time after the caller has returned to the browser.
pub(super) fn read(gpu: &Gpu, image: &wgpu::Texture) -> Result<ReadBack, Error> {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let imported = frame.import_texture("image", image, true);
    let request = frame.read_back_texture(&imported, Subresource::FULL);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
    gpu.queue.submit([encoder.finish()]);
    executed.read_back(request).ok_or_else(|| Error::Gpu("the image was not read".into()))
}

/// Joins the columns of two images of this width from `split` on: the first image to the left of it, the second to the right.
pub(super) fn join(mut left: Vec<u8>, right: &[u8], width: u32, split: u32) -> Vec<u8> {
    let row = width as usize * 4;
    let start = split.min(width) as usize * 4;
    for (left, right) in left.chunks_exact_mut(row).zip(right.chunks_exact(row)) {
        left[start..].copy_from_slice(&right[start..]);
    }
    left
}
