//! One watched version of a texture.

use super::gpu::Gpu;
use crate::capture::TextureSnapshot;
use crate::test_device::valid;
use crate::{Contents, Format, Frame, Graph, Subresource, TextureDesc, WatchedTexture};

fn gray(value: f64) -> Contents {
    Contents::clear_color([value; 4])
}

/// Declares merged passes, a depth attachment that nothing reads, and mips and layers.
fn declare<'f>(frame: &mut Frame<'f>) {
    let mut scene = frame.create_texture("scene", TextureDesc::d2(8, 8, Format::Rgba8Unorm));
    let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth32Float));
    let mut pass = frame.render_pass("first");
    pass.color(&mut scene, gray(0.2));
    pass.depth(&mut depth, Contents::clear_depth(0.25));
    for name in ["second", "third"] {
        let mut pass = frame.render_pass(name);
        pass.color(&mut scene, Contents::Preserve);
        pass.depth(&mut depth, Contents::Preserve);
    }
    let desc = TextureDesc { mip_levels: 2, ..TextureDesc::d2(8, 8, Format::R32Float).layers(2) };
    let mut layers = frame.create_texture("layers", desc);
    for (number, (mip, layer)) in [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().enumerate() {
        let mut pass = frame.render_pass("clear");
        pass.subresource(Subresource::FULL.mip(mip).layer(layer)).color(&mut layers, gray(number as f64));
    }
    frame.export_texture(&scene);
    frame.export_texture(&layers);
}

/// Draws the frame twice, with the plan of the first in the second, and returns what was watched.
fn watched(gpu: &Gpu, watch: Option<WatchedTexture>) -> Option<TextureSnapshot> {
    let mut graph = Graph::new();
    graph.watch(watch);
    let mut last = None;
    for _ in 0..2 {
        let mut frame = graph.frame();
        declare(&mut frame);
        let mut encoder = gpu.encoder();
        last = valid(&gpu.device, || {
            let compiled = graph.compile(frame).unwrap();
            let mut executed = compiled.execute(&mut graph, &gpu.device, &mut encoder).unwrap();
            gpu.queue.submit([encoder.finish()]);
            let steps = executed.plan().steps().len();
            assert_eq!(steps, 5, "the plan is the frame's own, with the first three passes merged");
            executed.take_watched().map(|watched| watched.wait(&gpu.device).unwrap())
        });
    }
    last
}

#[test]
fn a_watched_version_is_the_one_that_a_capture_shows() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        declare(&mut frame);
        let mut encoder = gpu.encoder();
        let compiled = graph.compile(frame).unwrap();
        let (executed, capture) = compiled.execute_captured(&mut graph, &gpu.device, &mut encoder).unwrap();
        gpu.queue.submit([encoder.finish()]);
        let captured = capture.wait(&gpu.device).unwrap().textures;
        assert_eq!(captured.len(), 3 + 3 + 4);
        for snapshot in captured {
            let part = snapshot.subresource;
            let watch = WatchedTexture {
                texture: executed.plan().resource_path(snapshot.resource),
                version: Some(snapshot.version),
                mip: part.mips.map_or(0, |(mip, _)| mip),
                layer: part.layers.map_or(0, |(layer, _)| layer),
            };
            assert_eq!(watched(&gpu, Some(watch)).as_ref(), Some(&snapshot));
        }
    }
}

#[test]
fn without_a_version_the_last_one_is_watched_and_missing_ones_are_not() {
    for gpu in Gpu::all() {
        let last = watched(&gpu, Some(WatchedTexture::last("scene"))).unwrap();
        assert_eq!((last.version, last.full_px), (3, [8, 8]));
        assert!(watched(&gpu, None).is_none());
        assert!(watched(&gpu, Some(WatchedTexture::last("sky"))).is_none());
        assert!(
            watched(&gpu, Some(WatchedTexture { version: Some(4), ..WatchedTexture::last("scene") }))
                .is_none()
        );
        for beyond in [
            WatchedTexture { mip: 2, ..WatchedTexture::last("layers") },
            WatchedTexture { layer: u32::MAX, ..WatchedTexture::last("layers") },
            WatchedTexture { mip: u32::MAX, ..WatchedTexture::last("layers") },
            WatchedTexture { layer: 2, ..WatchedTexture::last("layers") },
        ] {
            assert!(watched(&gpu, Some(beyond)).is_none());
        }
    }
}
