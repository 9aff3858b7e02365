//! The depth pyramid that instances are tested against.

use crate::stage::gpu;
use shadowgraph::core::{Format, Frame, FullscreenShader, Graph, Subresource, TextureDesc};
use shadowgraph::lighting::OccluderPyramid;

#[test]
fn each_texel_of_the_occluder_pyramid_has_the_farthest_depth_of_its_pixels() {
    let Some(gpu) = gpu() else { return };
    let noise = FullscreenShader::wgsl(
        "noise",
        "@fragment fn noise(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
            return f32((u32(at.x) * 7919u + u32(at.y) * 104729u) % 1021u + 1u) / 1024.0;
        }",
    );
    let depth_of = |x: u32, y: u32| ((x * 7919 + y * 104_729) % 1021 + 1) as f32 / 1024.0;
    let pyramid = OccluderPyramid::new(&gpu.device).unwrap();
    for size_px in [[1, 1], [5, 3], [64, 64], [65, 1], [1, 300], [150, 70], [333, 257]] {
        let mut graph = Graph::new();
        let mut frame: Frame<'_> = graph.frame();
        let desc = TextureDesc::d2(size_px[0], size_px[1], Format::Depth32Float);
        let mut depth = frame.create_texture("depth", desc);
        frame.fullscreen("noise", &noise).draw_depth(&mut depth);
        let texels = pyramid.add_to(&mut frame, &depth);
        let request = frame.read_back_buffer(&texels, Subresource::FULL);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut executed =
            graph.compile(frame).unwrap().execute(&mut graph, &gpu.device, &mut encoder).unwrap();
        gpu.queue.submit([encoder.finish()]);
        let bytes = executed.read_back(request).unwrap().wait(&gpu.device).unwrap();
        let texels: Vec<f32> =
            bytes.chunks_exact(4).map(|texel| f32::from_le_bytes(texel.try_into().unwrap())).collect();
        for level in OccluderPyramid::FINEST..=OccluderPyramid::top_level(size_px) {
            let [width, height] = size_px.map(|px: u32| px.div_ceil(1 << level));
            for [x, y] in (0..width * height).map(|texel| [texel % width, texel / width]) {
                let pixels = |texel: u32, size: u32| (texel << level)..((texel + 1) << level).min(size);
                let below =
                    pixels(y, size_px[1]).flat_map(|y| pixels(x, size_px[0]).map(move |x| depth_of(x, y)));
                let found = texels[OccluderPyramid::texel_index(size_px, level, [x, y]) as usize];
                assert_eq!(found, below.fold(1.0, f32::min), "{size_px:?}, level {level}, texel {x}, {y}");
            }
        }
    }
}
