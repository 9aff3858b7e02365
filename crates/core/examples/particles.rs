//! A compute chain: particles that move for some steps in a buffer of the graph, then are drawn.
//!
//! `cargo run -p shadowgraph-core --example particles` writes `out/particles.png`.
#![allow(clippy::print_stdout, missing_docs, reason = "an example is a program")]

mod common;

use shadowgraph_core::{
    Bind, BufferDesc, ComputeShader, Contents, Format, Graph, Subresource, TextureDesc, wgpu,
};

const SIDE: u32 = 360;
const PARTICLES: u32 = 32 * 1024;
const STEPS: u32 = 60;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (device, queue) = common::open()?;
    let shader = |entry| ComputeShader::wgsl(entry, include_str!("particles.wgsl")).entry_point(entry);
    let (scatter, advance) = (shader("scatter"), shader("advance"));
    let pipeline = pipeline(&device);
    let layout = pipeline.get_bind_group_layout(0);

    let mut graph = Graph::new();
    let mut frame = graph.frame();
    // Two floats of position and two of velocity each.
    let mut particles = frame.create_buffer("particles", BufferDesc::new(u64::from(PARTICLES) * 16));
    let groups = [PARTICLES / 64, 1, 1];
    frame.compute("scatter", &scatter).storage_mut(&mut particles, Contents::Overwrite).dispatch(groups);
    for step in 0..STEPS {
        // Each step reads the result of the previous one: `Preserve` declares this and orders them.
        let pass = frame.compute(format_args!("step {step}"), &advance);
        pass.storage_mut(&mut particles, Contents::Preserve).dispatch(groups);
    }

    let mut image = frame.create_texture("image", TextureDesc::d2(SIDE, SIDE, Format::Rgba8UnormSrgb));
    let mut draw = frame.render_pass("draw");
    let particles = draw.storage_buffer(&particles);
    draw.color(&mut image, Contents::clear_color([0.0, 0.0, 0.0, 1.0]));
    draw.body(move |ctx| {
        let group = ctx.bind_group(&layout, &[Bind::Buffer(particles)])?;
        ctx.pass.set_pipeline(&pipeline);
        ctx.pass.set_bind_group(0, &group, &[]);
        ctx.pass.draw(0..4, 0..PARTICLES);
        Ok(())
    });
    let pixels = frame.read_back_texture(&image, Subresource::FULL);

    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    queue.submit([encoder.finish()]);
    println!("{} passes, {} bytes of slots", executed.plan().order().len(), executed.plan().slot_bytes());
    let pixels = executed.read_back(pixels).ok_or("nothing was read back")?.wait(&device)?;
    common::save("particles", SIDE, SIDE, &pixels)
}

/// Dots that add up where they overlap.
fn pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("particles_draw.wgsl"));
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let target = wgpu::ColorTargetState {
        format: Format::Rgba8UnormSrgb,
        blend: Some(wgpu::BlendState { color: add, alpha: add }),
        write_mask: wgpu::ColorWrites::ALL,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("dots"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(target)],
        }),
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: Default::default(),
        multiview_mask: None,
        cache: None,
    })
}
