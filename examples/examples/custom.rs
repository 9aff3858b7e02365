//! The graph in an application with its own device, queue, encoder and textures.
//!
//! The application clears its canvas, the graph draws into it, and the application copies the canvas out: all in one encoder and one
//! submission. `cargo run -p shadowgraph-examples --example custom` writes out/custom.png.
#![allow(clippy::print_stdout, reason = "an example is a program")]

use shadowgraph::core::{Bind, Contents, Format, Frame, Graph, Texture, TextureDesc, wgpu};
use shadowgraph::output::{Pixels, write_png};

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 320, height: 180, depth_or_array_layers: 1 };
const CANVAS: Format = Format::Rgba8UnormSrgb;
const SHADER: &str = "
@vertex fn fullscreen(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32((i << 1u) & 2u) * 2.0 - 1.0, f32(i & 2u) * 2.0 - 1.0, 0.0, 1.0);
}
@fragment fn rings(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let ring = u32(distance(at.xy, vec2f(160.0, 90.0)) / 14.0) % 2u;
    return select(vec4f(1.0, 0.5, 0.0, 1.0), vec4f(0.0, 0.25, 1.0, 1.0), ring == 1u);
}
@group(0) @binding(0) var image: texture_2d<f32>;
@fragment fn lens(@builtin(position) at: vec4f) -> @location(0) vec4f {
    if distance(at.xy, vec2f(160.0, 90.0)) > 70.0 { discard; } // keeps what the application drew
    return textureLoad(image, vec2u(at.xy), 0);
}";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The application, independent of the graph.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let canvas = canvas(&device);
    let size = u64::from(SIZE.width * SIZE.height * 4);
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let copied = wgpu::BufferDescriptor { label: Some("copied"), size, usage, mapped_at_creation: false };
    let copied = device.create_buffer(&copied);
    let pipelines = Pipelines::new(&device);
    // Keeps plans, transient textures and bind groups from frame to frame: one graph per device.
    let mut graph = Graph::new();

    // Work of the application before the graph.
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    clear(&mut encoder, &canvas);

    // Declare, compile, and record into the existing encoder. The graph submits nothing.
    let mut frame = graph.frame();
    // `true`: the canvas has defined contents, so a pass may preserve them.
    let mut target = frame.import_texture("canvas", &canvas, true);
    rings_under_a_lens(&mut frame, &pipelines, &mut target);
    let executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    print!("{}", executed.plan().to_text());

    // Work of the application after the graph. Rows of 320 pixels with 4 bytes need no padding.
    let layout = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(SIZE.width * 4), ..Default::default() };
    let into = wgpu::TexelCopyBufferInfo { buffer: &copied, layout };
    encoder.copy_texture_to_buffer(canvas.as_image_copy(), into, SIZE);
    queue.submit([encoder.finish()]);

    copied.slice(..).map_async(wgpu::MapMode::Read, |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let pixels = copied.get_mapped_range(..)?;
    write_png("out/custom.png".as_ref(), SIZE.width, SIZE.height, Pixels::Rgba, &pixels)?;
    Ok(())
}

/// Adds two passes to a frame: any function can be a node. The second draws over `canvas`.
fn rings_under_a_lens<'f>(frame: &mut Frame<'f>, pipelines: &'f Pipelines, canvas: &mut Texture) {
    // A transient texture: the graph allocates it, with the usage flags that the accesses below need.
    let desc = TextureDesc::d2(SIZE.width, SIZE.height, Format::Rgba16Float);
    let mut rings = frame.create_texture("rings", desc);
    let mut pass = frame.render_pass("rings");
    // The triangle covers every pixel, so the earlier contents are not loaded.
    pass.color(&mut rings, Contents::Overwrite);
    pass.body(|ctx| {
        ctx.pass.set_pipeline(&pipelines.rings);
        ctx.pass.draw(0..3, 0..1);
        Ok(())
    });

    let mut pass = frame.render_pass("lens");
    // The read orders this pass after the one above, and returns the token that its body needs.
    let image = pass.sample(&rings);
    // Outside the lens the application's colours are kept, so the load op is `Load`.
    pass.color(canvas, Contents::Preserve);
    pass.body(move |ctx| {
        // Created once and cached for later frames, as long as the token resolves to the same texture.
        let group = ctx.bind_group(&pipelines.lens_layout, &[Bind::Texture(image)])?;
        ctx.pass.set_pipeline(&pipelines.lens);
        ctx.pass.set_bind_group(0, &group, &[]);
        ctx.pass.draw(0..3, 0..1);
        Ok(())
    });
}

struct Pipelines {
    rings: wgpu::RenderPipeline,
    lens: wgpu::RenderPipeline,
    /// Kept because bind groups are cached by layout.
    lens_layout: wgpu::BindGroupLayout,
}

impl Pipelines {
    fn new(device: &wgpu::Device) -> Self {
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let stage = wgpu::PipelineCompilationOptions::default;
        let pipeline = |entry_point, format: Format| {
            let (module, targets) = (&module, &[Some(format.into())]);
            let fragment = wgpu::FragmentState { module, entry_point, compilation_options: stage(), targets };
            // The module's only vertex entry point needs no name.
            let vertex =
                wgpu::VertexState { module, entry_point: None, compilation_options: stage(), buffers: &[] };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: entry_point,
                layout: None,
                vertex,
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(fragment),
                multiview_mask: None,
                cache: None,
            })
        };
        let (rings, lens) = (pipeline(Some("rings"), Format::Rgba16Float), pipeline(Some("lens"), CANVAS));
        Self { lens_layout: lens.get_bind_group_layout(0), rings, lens }
    }
}

fn canvas(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("canvas"),
        size: SIZE,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: CANVAS,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn clear(encoder: &mut wgpu::CommandEncoder, canvas: &wgpu::Texture) {
    let view = &canvas.create_view(&wgpu::TextureViewDescriptor::default());
    let green = wgpu::Color { r: 0.0, g: 0.2, b: 0.05, a: 1.0 };
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(green), store: wgpu::StoreOp::Store };
    let color = wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
    let color_attachments = &[Some(color)];
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor { color_attachments, ..Default::default() });
}
