//! How often declaring and compiling allocate, counted: not at all once a graph has seen the frame.
#![allow(clippy::expect_used, reason = "a test")]

#[path = "../benches/cost/frames/mod.rs"]
#[allow(dead_code, reason = "shared with the benchmark")]
mod frames;

use allocation_counter::measure;
use frames::chain::Chain;
use frames::real;
use shadowgraph_core::{Frame, Graph, Texture};

/// Bytes that the real frame uploads.
static BYTES: [u8; 256] = [0; 256];

/// Declares and compiles a frame until nothing of it is new, and counts the allocations of one more.
fn allocations<'f>(mut declare: impl FnMut(&mut Frame<'f>)) -> u64 {
    let mut graph = Graph::new();
    let mut frame = || {
        let mut frame = graph.frame();
        declare(&mut frame);
        graph.compile(frame).expect("the frame has no mistake");
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
fn a_changed_frame_is_seen_to_allocate() {
    let mut red = 0.0;
    let mut graph = Graph::new();
    let mut frame = || {
        red += 0.001;
        let mut frame = graph.frame();
        real::declare(&mut frame, &BYTES, red);
        graph.compile(frame).expect("the frame has no mistake");
    };
    frame();
    assert!(measure(frame).count_total > 0, "the counter counts nothing");
}

#[cfg(feature = "gpu")]
mod bodies {
    use super::{Chain, allocations};
    use shadowgraph_core::{Contents, Format, FullscreenShader, Texture, TextureDesc};

    #[test]
    fn a_pass_body_is_one_allocation_and_only_where_it_borrows_something() {
        let chain = Chain::new(100);
        let mut handles: Vec<Texture> = Vec::new();
        let mut counted = |captures: bool| {
            allocations(|frame| {
                let import = |frame: &mut _, texture| chain.import(frame, texture);
                chain.declare(frame, &mut handles, 0.5, import, |pass, _, tokens| {
                    if captures {
                        pass.body(move |context| context.texture(tokens[0]).map(|_| ()));
                    } else {
                        pass.body(|_| Ok(()));
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
}
