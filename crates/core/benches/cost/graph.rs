//! The graph's side.

use crate::frames::Change;
use crate::frames::chain::Chain;
use crate::frames::real;
use shadowgraph_core::{Graph, Texture};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Bytes that the real frame uploads.
static BYTES: [u8; 256] = [0; 256];

/// What is declared and compiled frame by frame.
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

    /// Declares and compiles a frame, and returns the time of the compiling alone.
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
        let start = Instant::now();
        let compiled = black_box(self.graph.compile(frame).expect("the frame has no mistake"));
        let time = start.elapsed();
        drop(compiled);
        time
    }
}
