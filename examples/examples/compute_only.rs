//! A graph without a single draw: Conway's game of life, a hundred generations in one frame. Two buffers take turns, and the graph
//! finds out that two are enough.
//!
//! `cargo run -p shadowgraph-examples --example compute_only` writes out/compute_only.png and tells of the memory.

#![allow(clippy::print_stdout, reason = "an example is a program")]

use shadowgraph::Gpu;
use shadowgraph::core::{BufferDesc, ComputeShader, Contents, Graph, Part};
use shadowgraph::options::AdapterChoice;
use shadowgraph::output::{Pixels, write_png};

const SIDE: u32 = 128;
const GENERATIONS: u32 = 100;

const LIFE: &str = "
    @group(0) @binding(0) var<storage, read> before: array<u32>;
    @group(0) @binding(1) var<storage, read_write> after: array<u32>;
    const SIDE: i32 = 128;

    fn alive(x: i32, y: i32) -> u32 {
        return before[((y + SIDE) % SIDE) * SIDE + (x + SIDE) % SIDE];
    }

    @compute @workgroup_size(8, 8)
    fn live(@builtin(global_invocation_id) id: vec3u) {
        let x = i32(id.x);
        let y = i32(id.y);
        var neighbours = 0u;
        for (var dy = -1; dy <= 1; dy++) {
            for (var dx = -1; dx <= 1; dx++) {
                neighbours += select(alive(x + dx, y + dy), 0u, dx == 0 && dy == 0);
            }
        }
        let lives = neighbours == 3u || (neighbours == 2u && alive(x, y) == 1u);
        after[y * SIDE + x] = u32(lives);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let life = ComputeShader::wgsl("life", LIFE);
    let cells = SIDE * SIDE;
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    // Any pattern will do: the bits of a multiplied number.
    let first: Vec<u8> =
        (0..cells).flat_map(|i| (i.wrapping_mul(2_654_435_761) >> 30 & 1).to_le_bytes()).collect();
    let mut now = frame.upload_buffer("first", first);
    for generation in 1..=GENERATIONS {
        let bytes = u64::from(cells) * 4;
        let mut next = frame.create_buffer(format_args!("generation {generation}"), BufferDesc { bytes });
        let pass = frame.compute(format_args!("live {generation}"), &life).storage(&now);
        pass.storage_mut(&mut next, Contents::Cover).dispatch([SIDE / 8, SIDE / 8, 1]);
        now = next;
    }
    let read = frame.read_back_buffer(&now, Part::WHOLE);

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
    let read = executed.read_back(read).ok_or("nothing was read")?;
    gpu.queue.submit([encoder.finish()]);
    let cells = read.wait(&gpu.device)?;
    println!("{}", executed.plan().to_text().lines().next().unwrap_or_default());
    let grey: Vec<u8> = cells.chunks_exact(4).flat_map(|cell| [cell[0] * 255; 3]).collect();
    Ok(write_png("out/compute_only.png".as_ref(), SIDE, SIDE, Pixels::Rgb, &grey)?)
}
