//! Counts allocations of declaring and compiling: none once a graph has compiled the frame.
#![allow(clippy::expect_used, reason = "a test")]

#[allow(dead_code, reason = "shared with the benchmark")]
mod frames;

use allocation_counter::measure;
use frames::chain::Chain;
use frames::real;
use shadowgraph_core::{Frame, Graph, Texture};

/// Uploaded bytes of the real frame.
static BYTES: [u8; 256] = [0; 256];

/// Declares and compiles a frame until everything is cached, and counts the allocations of one more.
fn allocations<'f>(mut declare: impl FnMut(&mut Frame<'f>)) -> u64 {
    let mut graph = Graph::new();
    let mut frame = || {
        let mut frame = graph.frame();
        declare(&mut frame);
        graph.compile(frame).expect("the frame is valid");
    };
    for _ in 0..3 {
        frame();
    }
    let counted = measure(frame).count_total;
    assert_eq!(graph.plan_counts().reused, 3, "the frame is to be unchanged");
    counted
}

#[test]
fn an_unchanged_chain_of_passes_allocates_nothing() {
    let chain = Chain::new(100);
    let mut handles: Vec<Texture> = Vec::new();
    let counted = allocations(|frame| {
        let import = |frame: &mut _, texture| chain.import(frame, texture);
        chain.declare(frame, &mut handles, 0.5, import, |_, _, _| {});
    });
    assert_eq!(counted, 0);
}

#[test]
fn an_unchanged_frame_of_a_real_one_s_size_allocates_nothing() {
    assert_eq!(allocations(|frame| real::declare(frame, &BYTES, 0.5)), 0);
}

#[test]
fn a_changed_frame_allocates() {
    let mut red = 0.0;
    let mut graph = Graph::new();
    let mut frame = || {
        red += 0.001;
        let mut frame = graph.frame();
        real::declare(&mut frame, &BYTES, red);
        graph.compile(frame).expect("the frame is valid");
    };
    frame();
    assert!(measure(frame).count_total > 0, "the counter counts nothing");
}

#[cfg(feature = "gpu")]
mod bodies {
    use super::{Chain, allocations};
    use allocation_counter::measure;
    use shadowgraph_core::{Contents, Format, Frame, FullscreenShader, Graph, Texture, TextureDesc, wgpu};

    #[test]
    fn a_pass_body_is_one_allocation_and_only_where_it_captures_much() {
        let chain = Chain::new(100);
        let mut handles: Vec<Texture> = Vec::new();
        let mut counted = |captures_much: bool| {
            allocations(|frame| {
                let import = |frame: &mut _, texture| chain.import(frame, texture);
                chain.declare(frame, &mut handles, 0.5, import, |pass, _, tokens| {
                    if captures_much {
                        let much = [tokens; 3];
                        pass.body(move |context| context.texture(much[2][0]).map(|_| ()));
                    } else {
                        pass.body(move |context| context.texture(tokens[0]).map(|_| ()));
                    }
                });
            })
        };
        assert_eq!((counted(true), counted(false)), (100, 0));
    }

    #[test]
    fn a_fullscreen_pass_in_one_line_allocates_nothing() {
        let shader =
            FullscreenShader::wgsl("copy", "@fragment fn copy() -> @location(0) vec4f { return vec4f(); }");
        let counted = allocations(|frame| {
            let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
            frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0; 4]));
            frame.fullscreen("draw", &shader).draw_over(&mut color, None);
            frame.export_texture(&color);
        });
        assert_eq!(counted, 0);
    }

    /// Passes that draw, read the result, and read that.
    fn three_passes(frame: &mut Frame<'_>) {
        let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
        let mut image = frame.create_texture("image", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
        frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
        let mut pass = frame.render_pass("read");
        pass.sample(&scene);
        pass.color(&mut image, Contents::Overwrite);
        frame.render_pass("go on").color(&mut image, Contents::Preserve);
        frame.export_texture(&image);
    }

    /// Returns the allocations of recording a frame in the steady state, including wgpu's.
    fn recorded(device: &wgpu::Device, queue: &wgpu::Queue, graph: &mut Graph) -> u64 {
        let mut frame = || {
            let mut frame = graph.frame();
            three_passes(&mut frame);
            let mut encoder = device.create_command_encoder(&Default::default());
            let compiled = graph.compile(frame).expect("the frame is valid");
            compiled.execute(graph, device, &mut encoder).expect("it records");
            queue.submit([encoder.finish()]);
        };
        (0..20).for_each(|_| frame());
        // wgpu's pools grow now and then.
        (0..10).map(|_| measure(&mut frame).count_total).min().unwrap_or_default()
    }

    #[test]
    fn a_capture_leaves_later_frames_as_cheap_as_without() {
        let (device, queue) = wgpu::Device::noop(&Default::default());
        let mut graph = Graph::new();
        recorded(&device, &queue, &mut graph);
        let mut frame = graph.frame();
        three_passes(&mut frame);
        let mut encoder = device.create_command_encoder(&Default::default());
        let compiled = graph.compile(frame).expect("the frame is valid");
        let (_, capture) = compiled.execute_captured(&mut graph, &device, &mut encoder).expect("it records");
        queue.submit([encoder.finish()]);
        assert_eq!(capture.wait(&device).expect("a capture").textures.len(), 3);
        // Of the same device: what it has seen may cost wgpu something.
        assert_eq!(recorded(&device, &queue, &mut graph), recorded(&device, &queue, &mut Graph::new()));
    }
}
