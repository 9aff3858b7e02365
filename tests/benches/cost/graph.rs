//! Frames drawn with the graph.

use crate::drawing::Drawing;
use crate::frames::Change;
use crate::frames::chain::{Chain, SOURCE};
use crate::frames::real;
use shadowgraph_core::{Bind, Frame, Graph, Texture};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Uploaded bytes of the real frame.
static BYTES: [u8; 256] = [0; 256];

/// A frame to declare and compile.
pub(crate) struct Declared<'c> {
    graph: Graph,
    source: Source<'c>,
    change: Change,
    number: u32,
    handles: Vec<Texture>,
}

#[derive(Clone, Copy)]
pub(crate) enum Source<'c> {
    Chain(&'c Chain),
    Real,
}

impl<'c> Declared<'c> {
    pub(crate) fn new(source: Source<'c>, change: Change) -> Self {
        Self { graph: Graph::new(), source, change, number: 0, handles: Vec::new() }
    }

    /// Declares and compiles a frame, and returns only the time of compiling.
    pub(crate) fn frame(&mut self) -> Duration {
        self.number += 1;
        let red = self.change.red(self.number);
        let mut frame = self.graph.frame();
        match self.source {
            Source::Chain(chain) => {
                let import = |frame: &mut _, texture| chain.import(frame, texture);
                chain.declare(&mut frame, &mut self.handles, red, import, |_, _, _| {});
            }
            Source::Real => real::declare(&mut frame, &BYTES, red),
        }
        self.change.declare(&mut frame, self.number);
        let start = Instant::now();
        let compiled = black_box(self.graph.compile(frame).expect("the frame is valid"));
        let time = start.elapsed();
        drop(compiled);
        time
    }
}

/// The chain's frame from its declaration to its submission.
pub(crate) struct Whole<'d> {
    graph: Graph,
    drawing: &'d Drawing,
    chain: &'d Chain,
    change: Change,
    draws: u32,
    threads: usize,
    number: u32,
    handles: Vec<Texture>,
}

impl<'d> Whole<'d> {
    pub(crate) fn new(drawing: &'d Drawing, chain: &'d Chain, change: Change) -> Self {
        let (graph, handles) = (Graph::new(), Vec::new());
        Self { graph, drawing, chain, change, draws: 1, threads: 1, number: 0, handles }
    }

    /// Sets the draws of each pass and the number of recording threads.
    pub(crate) fn with_draws(self, draws: u32, threads: usize) -> Self {
        Self { draws, threads, ..self }
    }

    /// Declares, compiles, records and submits a frame.
    pub(crate) fn frame(&mut self) {
        self.number += 1;
        let (drawing, chain, draws, red) =
            (self.drawing, self.chain, self.draws, self.change.red(self.number));
        let mut frame = self.graph.frame();
        let import = |frame: &mut Frame<'d>, index: usize| {
            frame.import_texture(&chain.textures[index], &drawing.ends[index], index == SOURCE)
        };
        chain.declare(&mut frame, &mut self.handles, red, import, |pass, index, tokens| {
            let count = chain.passes[index].samples.len();
            let program = drawing.program(count);
            pass.body(move |context| {
                let group = context.bind_group(&program.layout, &tokens.map(Bind::Texture)[..count])?;
                context.pass.set_pipeline(&program.pipeline);
                context.pass.set_bind_group(0, &group, &[]);
                (0..draws).for_each(|_| context.pass.draw(0..3, 0..1));
                Ok(())
            });
        });
        self.change.declare(&mut frame, self.number);
        let compiled = self.graph.compile(frame).expect("the frame is valid");
        if self.threads > 1 {
            let executed = compiled.execute_on_threads(&mut self.graph, &drawing.device, self.threads);
            let (_, buffers) = executed.expect("the device has what the frame needs");
            drawing.queue.submit(buffers);
        } else {
            let mut encoder = drawing.device.create_command_encoder(&Default::default());
            let executed = compiled.execute(&mut self.graph, &drawing.device, &mut encoder);
            executed.expect("the device has what the frame needs");
            drawing.queue.submit([encoder.finish()]);
        }
    }
}
