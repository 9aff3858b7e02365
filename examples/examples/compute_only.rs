//! A graph without draws: Conway's game of life, a hundred generations in one frame. The graph finds out that two buffers are enough
//! and aliases the rest.
//!
//! `cargo run -p shadowgraph-examples --example compute_only` writes out/compute_only.png and prints the memory; with `-- --window`
//! each frame draws a hundred generations.
#![allow(clippy::print_stdout, reason = "an example is a program")]

use shadowgraph::Gpu;
use shadowgraph::core::{BufferDesc, ComputeShader, Contents, Format, Graph, TextureDesc};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::process::ExitCode;

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

const SHOW: &str = "
    @group(0) @binding(0) var<storage, read> cells: array<u32>;
    @group(0) @binding(1) var image: texture_storage_2d<rgba8unorm, write>;

    @compute @workgroup_size(8, 8)
    fn show(@builtin(global_invocation_id) id: vec3u) {
        let cell = id.xy * 128u / textureDimensions(image);
        textureStore(image, id.xy, vec4f(vec3f(f32(cells[cell.y * 128u + cell.x])), 1.0));
    }";

struct Life {
    graph: Graph,
    live: ComputeShader,
    show: ComputeShader,
}

impl Example for Life {
    const NAME: &'static str = "compute_only";
    const SIZE_PX: [u32; 2] = [SIDE; 2];

    fn new(_gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        let (live, show) = (ComputeShader::wgsl("life", LIFE), ComputeShader::wgsl("show", SHOW));
        Ok(Self { graph: Graph::new(), live, show })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number, .. }: Canvas<'_>) -> Result<(), Failure> {
        let mut frame = self.graph.frame();
        // Any pattern works: bits of a multiplied integer.
        let cell = |i: u32| (i + number).wrapping_mul(2_654_435_761) >> 30 & 1;
        let first: Vec<u8> = (0..SIDE * SIDE).flat_map(|i| cell(i).to_le_bytes()).collect();
        let mut now = frame.upload_buffer("first", first);
        for generation in 1..=GENERATIONS {
            let bytes = u64::from(SIDE * SIDE) * 4;
            let mut next =
                frame.create_buffer(format_args!("generation {generation}"), BufferDesc::new(bytes));
            let pass = frame.compute(format_args!("live {generation}"), &self.live).storage(&now);
            pass.storage_mut(&mut next, Contents::Overwrite).dispatch([SIDE / 8, SIDE / 8, 1]);
            now = next;
        }
        let (width, height) = (target.width(), target.height());
        let mut cells = frame.create_texture("cells", TextureDesc::d2(width, height, Format::Rgba8Unorm));
        let pass = frame
            .compute("show", &self.show)
            .storage(&now)
            .storage_texture_mut(&mut cells, Contents::Overwrite);
        pass.dispatch([width.div_ceil(8), height.div_ceil(8), 1]);
        let mut image = frame.import_texture("image", target, false);
        frame.copy_pass("copy").texture(&cells, &mut image);

        let executed = self.graph.compile(frame)?.execute(&mut self.graph, &gpu.device, encoder)?;
        if number == 0 {
            println!("{}", executed.plan().to_text().lines().next().unwrap_or_default());
        }
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Life>()
}
