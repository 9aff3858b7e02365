//! Errors that need a device.

use super::{Failure, square};
use shadowgraph_core::{
    Contents, Error, Format, Frame, FullscreenShader, Graph, Subresource, TextureDesc, wgpu,
};

/// Declares, compiles and executes on a device that draws nothing.
fn failure(
    code: &'static str,
    words: &'static [&'static str],
    declare: impl FnOnce(&mut Frame<'_>),
) -> Failure {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    failure_on(&device, code, words, declare)
}

fn failure_on(
    device: &wgpu::Device,
    code: &'static str,
    words: &'static [&'static str],
    declare: impl FnOnce(&mut Frame<'_>),
) -> Failure {
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    declare(&mut frame);
    let compiled = graph.compile(frame);
    let error = match compiled {
        Ok(compiled) => compiled.execute(&mut graph, device, &mut encoder).err(),
        Err(error) => Some(error),
    };
    Failure { code, error: error.expect("a failure"), words }
}

/// A quarter of a TiB: within the default limits, but more than any device has. `None` if the driver cannot report it.
fn out_of_memory() -> Option<Failure> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).ok()?;
    let (device, _queue) = pollster::block_on(adapter.request_device(&Default::default())).ok()?;
    let desc = TextureDesc::d2(8192, 8192, Format::Rgba32Float).layers(256);
    let words = &["out of device memory", "`voxels` (274877906944 bytes)", "make it smaller"];
    Some(failure_on(&device, "SG0607", words, |frame| {
        let mut voxels = frame.create_texture("voxels", desc);
        let mut pass = frame.compute_pass("voxelize");
        pass.storage_texture_mut(&mut voxels, Contents::Overwrite);
        pass.keep();
    }))
}

fn lost() -> Failure {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    device.destroy();
    failure_on(&device, "SG0608", &["device is lost", "create another one"], |frame| {
        let mut image = frame.create_texture("image", square());
        frame.render_pass("clear").color(&mut image, Contents::clear_color([0.0; 4]));
        frame.export_texture(&image);
    })
}

/// A pass in a node that draws without a pipeline, which only wgpu detects.
fn refused() -> Failure {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut color = frame.create_texture("color", square());
    frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0; 4]));
    frame.node("post", |frame| {
        let mut other = frame.create_texture("other", square());
        let mut pass = frame.render_pass("blur");
        pass.sample(&color);
        pass.color(&mut other, Contents::Overwrite);
        pass.body(|ctx| {
            ctx.pass.draw(0..3, 0..1);
            Ok(())
        });
        frame.export_texture(&other);
    });
    let compiled = graph.compile(frame).expect("the frame is valid");
    let failed =
        compiled.execute_checked(&mut graph, &device, &queue).err().expect("a wgpu validation error");
    assert!(failed.plan.find_pass("blur").is_some(), "the plan comes with the error");
    Failure { code: "SG0606", error: failed.error, words: &["in `post/blur`", "pipeline"] }
}

pub(crate) fn failures() -> Vec<Failure> {
    let mut failures = vec![
        refused(),
        lost(),
        failure(
            "SG0104",
            &[
                "pass `b` uses `a` without",
                "belongs to `first`",
                "declare the access on the pass that uses it",
            ],
            |frame| {
                let mut a = frame.create_texture("a", square());
                let token = frame.render_pass("first").color(&mut a, Contents::clear_color([0.0; 4]));
                frame.export_texture(&a);
                let mut pass = frame.compute_pass("b");
                pass.keep();
                pass.body(move |ctx| ctx.view(token).map(drop));
            },
        ),
        failure("SG0404", &["`window` was declared as an import", "use `import_texture`"], |frame| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
            let mut window = frame.declare_import_texture("window", square(), usage, false);
            frame.render_pass("draw").color(&mut window, Contents::Overwrite);
        }),
        failure("SG0601", &["`wide` needs 100000", "max_texture_dimension_2d", "make it smaller"], |frame| {
            let mut wide = frame.create_texture("wide", TextureDesc::d2(100_000, 4, Format::Rgba8Unorm));
            frame.render_pass("draw").color(&mut wide, Contents::Overwrite);
            frame.export_texture(&wide);
        }),
        failure("SG0602", &["pass `draw`: no paint"], |frame| {
            let mut pass = frame.encoder_pass("draw");
            pass.keep();
            pass.body(|_| Err(Error::body("no paint")));
        }),
        failure("SG0603", &["`samples` cannot be read back", "resolve"], |frame| {
            let mut samples = frame.create_texture("samples", TextureDesc { samples: 4, ..square() });
            frame.render_pass("draw").color(&mut samples, Contents::Overwrite);
            frame.read_back_texture(&samples, Subresource::FULL);
        }),
        failure(
            "SG0605",
            &["`image` has the format Rgba8UnormSrgb", "STORAGE_BINDING", "such as Rgba8Unorm"],
            |frame| {
                let desc = TextureDesc { format: Format::Rgba8UnormSrgb, ..square() };
                let mut image = frame.create_texture("image", desc);
                frame.compute_pass("draw").storage_texture_mut(&mut image, Contents::Overwrite);
                frame.export_texture(&image);
            },
        ),
        failure("SG0604", &["shader `red`", "does not match its pass"], |frame| {
            let red = FullscreenShader::wgsl("red", "@fragment fn red() -> @location(0) vec4f { return 1; }");
            let mut image = frame.create_texture("image", square());
            frame.fullscreen("red", &red).draw(&mut image);
            frame.export_texture(&image);
        }),
    ];
    failures.extend(out_of_memory());
    failures
}
