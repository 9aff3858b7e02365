//! Features of the graph, a test for each, using only the public API. Other tests are thorough; these can be read and
//! copied.
#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use shadowgraph_core::wgpu::{self, TextureUsages};
use shadowgraph_core::{
    Bind, BufferDesc, ClearValue, Compiled, ComputeShader, Contents, CullReason, DependencyKind, Error,
    Executed, Format, Frame, FullscreenShader, Graph, LoadAction, MergeReason, Options, OrderPolicy, Plan,
    Rect, Resize, SlotReason, StoreAction, Subresource, Texture, TextureDesc,
};

const BLACK: Contents = Contents::Clear(ClearValue::Color([0.0; 4]));

fn color(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(64, 64, Format::Rgba8Unorm))
}

/// Reads `from` and overwrites a new texture.
fn filter(frame: &mut Frame<'_>, name: &str, from: &Texture) -> Texture {
    let mut to = color(frame, name);
    let mut pass = frame.render_pass(name);
    pass.sample(from);
    pass.color(&mut to, Contents::Overwrite);
    to
}

fn plan(frame: Frame<'_>) -> Plan {
    frame.compile().unwrap().into_plan()
}

fn noop() -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor::default())
}

fn run(graph: &mut Graph, compiled: Compiled<'_>, (device, queue): &(wgpu::Device, wgpu::Queue)) -> Executed {
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let executed = compiled.execute(graph, device, &mut encoder).unwrap();
    queue.submit([encoder.finish()]);
    executed
}

/// An atlas of two tiles, each drawn by its own pass.
fn atlas(frame: &mut Frame<'_>) -> Texture {
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(128, 64, Format::Depth32Float));
    for (name, x) in [("left", 0), ("right", 64)] {
        let mut pass = frame.render_pass(name);
        pass.subresource(Subresource::FULL.rect(Rect::new(x, 0, 64, 64)))
            .depth(&mut atlas, Contents::clear_depth(0.0));
    }
    atlas
}

#[test]
fn contents() {
    let mut frame = Frame::new();
    let mut chain = frame
        .create_texture("chain", TextureDesc { mip_levels: 2, ..TextureDesc::d2(8, 8, Format::R8Unorm) });
    frame.render_pass("mip 0").subresource(Subresource::FULL.mip(0)).color(&mut chain, BLACK);
    let mut reader = frame.compute_pass("reads mip 1");
    reader.subresource(Subresource::FULL.mip(1)).sample(&chain);
    reader.keep();
    let error = frame.compile().err().unwrap();
    assert!(matches!(&error, Error::UndefinedRead { subresource, .. } if subresource == "mip 1"), "{error}");

    let mut frame = Frame::new();
    let atlas = atlas(&mut frame);
    frame.export_texture(&atlas);
    assert!(plan(frame).dependencies().is_empty(), "tiles do not order each other");

    let mut frame = Frame::new();
    let mut bytes = frame.create_buffer("bytes", BufferDesc::new(512));
    for (name, range) in [("low", 0..256), ("high", 256..512)] {
        let mut pass = frame.compute_pass(name);
        pass.subresource(Subresource::FULL.bytes(range)).storage_buffer_mut(&mut bytes, Contents::Overwrite);
    }
    frame.export_buffer(&bytes);
    assert!(plan(frame).dependencies().is_empty(), "ranges do not order each other");
}

#[test]
fn derived() {
    let mut frame = Frame::new();
    let multisampled = |format| TextureDesc { samples: 4, ..TextureDesc::d2(64, 64, format) };
    let mut samples = frame.create_texture("samples", multisampled(Format::Rgba8Unorm));
    let mut depth = frame.create_texture("depth", multisampled(Format::Depth32Float));
    let mut resolved = color(&mut frame, "resolved");
    let mut pass = frame.render_pass("draw");
    pass.color(&mut samples, BLACK);
    pass.resolve(&mut resolved);
    pass.depth(&mut depth, Contents::clear_depth(0.0));
    frame.export_texture(&resolved);
    let plan = plan(frame);
    for name in ["samples", "depth"] {
        let resource = plan.resource(plan.find_resource(name).unwrap());
        let transient = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TRANSIENT_ATTACHMENT;
        assert_eq!(resource.texture_usage, transient, "{name} never leaves the pass");
    }
    let ops = plan.accesses(plan.find_pass("draw").unwrap()).next().unwrap().ops.unwrap();
    assert_eq!((ops.load, ops.store), (LoadAction::Clear(ClearValue::Color([0.0; 4])), StoreAction::Discard));
}

#[test]
fn order() {
    let declare = |frame: &mut Frame<'_>| {
        // Two chains; running one to its end frees its memory before the other begins.
        let (mut a, mut b) = (color(frame, "a"), color(frame, "b"));
        frame.render_pass("a").color(&mut a, BLACK);
        frame.render_pass("b").color(&mut b, BLACK);
        for (from, to) in [(&a, "from a"), (&b, "from b")] {
            let mut sum = frame.create_buffer(to, BufferDesc::new(4));
            let mut pass = frame.compute_pass(to);
            pass.sample(from);
            pass.storage_buffer_mut(&mut sum, Contents::Overwrite);
            frame.export_buffer(&sum);
        }
    };
    let names = |plan: &Plan| plan.order().iter().map(|&p| plan.pass(p).name.to_owned()).collect::<Vec<_>>();
    let mut frame = Frame::new();
    declare(&mut frame);
    let chosen = plan(frame);
    assert_eq!(names(&chosen), ["a", "from a", "b", "from b"]);
    let mut frame = Frame::new();
    declare(&mut frame);
    frame.fix_order();
    let fixed = plan(frame);
    assert_eq!(names(&fixed), ["a", "b", "from a", "from b"]);
    assert!(chosen.slot_bytes() < fixed.slot_bytes());

    let mut frame = Frame::new();
    let mut late = frame.encoder_pass("late");
    late.keep();
    let late = late.id();
    let mut last = frame.encoder_pass("last");
    last.keep();
    last.after(late);
    let last = last.id();
    let plan = plan(frame);
    assert_eq!(names(&plan), ["late", "last"]);
    let why = plan.why_before(late, last).unwrap();
    assert_eq!(why[0].kind, DependencyKind::Explicit, "nothing else orders them");
}

#[test]
fn merge() {
    let mut frame = Frame::new();
    let mut scene = color(&mut frame, "scene");
    frame.render_pass("solid").color(&mut scene, BLACK);
    frame.render_pass("glass").color(&mut scene, Contents::Preserve);
    let blurred = filter(&mut frame, "blur", &scene);
    frame.export_texture(&blurred);
    let plan = plan(frame);
    assert_eq!(plan.steps().map(|step| step.passes.len()).collect::<Vec<_>>(), [2, 1]);
    assert_eq!(plan.merge_reason(plan.find_pass("glass").unwrap()), Some(MergeReason::Merged));
    assert_eq!(plan.merge_reason(plan.find_pass("blur").unwrap()), Some(MergeReason::Attachments));
}

#[test]
fn reuse() {
    let mut frame = Frame::new();
    let mut at = color(&mut frame, "first");
    frame.render_pass("first").color(&mut at, BLACK);
    for name in ["second", "third", "fourth"] {
        at = filter(&mut frame, name, &at);
    }
    frame.export_texture(&at);
    let plan = plan(frame);
    assert_eq!(plan.slots().len(), 2, "a chain needs two textures, however long it is");
    assert_eq!(plan.saved_bytes(), 2 * 64 * 64 * 4);
    let third = plan.resource(plan.find_resource("third").unwrap());
    assert_eq!(third.slot_reason, SlotReason::After(plan.find_resource("first").unwrap()));
}

#[test]
fn history() {
    let (gpu, mut graph) = (noop(), Graph::new());
    let mut validity = Vec::new();
    for size in [64, 64, 64, 32, 32] {
        let mut frame = graph.frame();
        let desc = TextureDesc::d2(size, size, Format::Rgba16Float);
        let mut mean = frame.history("mean", desc, Resize::Reset);
        validity.push(mean.valid);
        let mut pass = frame.render_pass("accumulate");
        pass.sample(&mean.previous);
        pass.color(&mut mean.current, Contents::Overwrite);
        let compiled = graph.compile(frame).unwrap();
        run(&mut graph, compiled, &gpu);
    }
    assert_eq!(validity, [false, true, true, false, true], "the first frame and the resize have no past");
}

#[test]
fn frames() {
    let mut graph = Graph::new();
    for size in [64, 64, 64, 32] {
        let mut frame = graph.frame();
        let mut scene = frame.create_texture("scene", TextureDesc::d2(size, size, Format::Rgba8Unorm));
        frame.render_pass("draw").color(&mut scene, BLACK);
        frame.export_texture(&scene);
        graph.compile(frame).unwrap();
    }
    let counts = graph.plan_counts();
    assert_eq!((counts.compiled, counts.reused, counts.resized), (1, 2, 1));
}

#[test]
fn conditions() {
    for on in [false, true] {
        let mut frame = Frame::new();
        let glow = frame.when(on, |frame| {
            frame.node("glow", |frame| {
                let mut glow = color(frame, "glow");
                frame.render_pass("glow").color(&mut glow, BLACK);
                glow
            })
        });
        let nothing = frame.node("declares nothing", |_frame| 1);
        assert_eq!(nothing, 1);
        let glow = frame.or_placeholder(glow.as_ref(), Format::Rgba8Unorm, ClearValue::Color([0.0; 4]));
        let image = filter(&mut frame, "combine", &glow);
        frame.export_texture(&image);
        let plan = plan(frame);
        assert_eq!(plan.nodes().len(), usize::from(on), "a node that declares nothing leaves nothing");
        assert_eq!(plan.order().len(), 2);
    }
}

#[test]
fn recording() {
    let ((device, queue), mut graph) = (noop(), Graph::new());
    let ran = std::sync::atomic::AtomicU32::new(0);
    let mut frame = graph.frame();
    for index in 0..8 {
        let mut pass = frame.encoder_pass(format_args!("pass {index}"));
        pass.keep();
        pass.body(|_| {
            ran.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            Ok(())
        });
    }
    let compiled = graph.compile(frame).unwrap();
    let (_executed, buffers) = compiled.execute_on_threads(&mut graph, &device, 2).unwrap();
    assert_eq!(buffers.len(), 2);
    queue.submit(buffers);
    assert_eq!(ran.into_inner(), 8);
}

#[test]
fn composition() {
    struct Scene(Texture);
    let mut frame = Frame::new();
    for eye in ["left", "right"] {
        frame.view(eye, |frame| {
            frame.node("scene", |frame| {
                let mut scene = color(frame, "scene");
                frame.render_pass("draw").color(&mut scene, BLACK);
                frame.publish(Scene(scene));
            });
            let Scene(scene) = frame.published::<Scene>().unwrap();
            let scene = scene.clone();
            frame.export_texture(&scene);
        });
    }
    let plan = plan(frame);
    let paths: Vec<_> = plan.order().iter().map(|&pass| plan.pass_path(pass)).collect();
    assert_eq!(paths, ["left/scene/draw", "right/scene/draw"]);
}

#[test]
fn errors() {
    let mut frame = Frame::new();
    let mut scene = color(&mut frame, "scene");
    let before = scene.clone();
    frame.render_pass("draw").color(&mut scene, BLACK);
    frame.render_pass("late").sample(&before);
    let error = frame.compile().err().unwrap();
    assert_eq!(error.code(), "SG0101");
    let words = error.to_string();
    assert!(["`late`", "`scene`", "`draw`", "version 0"].iter().all(|word| words.contains(word)), "{words}");
}

#[test]
fn reasons() {
    let mut frame = Frame::new();
    let (mut scene, mut unread) = (color(&mut frame, "scene"), color(&mut frame, "unread"));
    frame.render_pass("draw").color(&mut scene, BLACK);
    frame.render_pass("waste").color(&mut unread, BLACK);
    frame.export_texture(&scene);
    let plan = plan(frame);
    let waste = plan.pass(plan.find_pass("waste").unwrap());
    assert_eq!(waste.culled, Some(CullReason::Unread(unread.id())));
    assert_eq!(plan.describe_cull(waste.culled.unwrap()), "nothing reads `unread`");
}

#[test]
fn graph_access() {
    let mut frame = Frame::new();
    let mut scene = color(&mut frame, "scene");
    frame.render_pass("draw").color(&mut scene, BLACK);
    let bright = filter(&mut frame, "bright", &scene);
    let blurred = filter(&mut frame, "blur", &bright);
    frame.export_texture(&blurred);
    let plan = plan(frame);
    let pass = |name| plan.find_pass(name).unwrap();
    let why = plan.why_before(pass("draw"), pass("blur")).unwrap();
    assert_eq!(why.iter().map(|edge| edge.after).collect::<Vec<_>>(), [pass("bright"), pass("blur")]);
    assert_eq!(plan.critical_path(|_| 1.0).len(), 3);
    assert!(!petgraph::algo::is_cyclic_directed(&plan.graph()));
}

#[test]
fn options() {
    let mut frame = Frame::new();
    let mut scene = color(&mut frame, "scene");
    frame.render_pass("solid").color(&mut scene, BLACK);
    frame.render_pass("glass").color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    frame.set_options(Options { merge: false, order: OrderPolicy::Memory, ..Options::default() });
    assert_eq!(plan(frame).steps().len(), 2);
}

#[test]
fn bind_groups() {
    let (gpu, mut graph) = (noop(), Graph::new());
    let invert = FullscreenShader::wgsl(
        "invert",
        "@group(0) @binding(0) var scene: texture_2d<f32>;
        @group(0) @binding(1) var<uniform> strength: vec4f;
        @fragment fn invert(@builtin(position) at: vec4f) -> @location(0) vec4f {
            return strength * (1.0 - textureLoad(scene, vec2u(at.xy), 0));
        }",
    );
    for strength in [0.5f32, 1.0] {
        let mut frame = graph.frame();
        let (mut scene, mut image) = (color(&mut frame, "scene"), color(&mut frame, "image"));
        frame.render_pass("draw").color(&mut scene, BLACK);
        let strength = [strength; 4].map(f32::to_le_bytes).concat();
        frame.fullscreen("invert", &invert).sample(&scene).uniform(&strength[..]).draw(&mut image);
        frame.export_texture(&image);
        let compiled = graph.compile(frame).unwrap();
        run(&mut graph, compiled, &gpu);
    }
    assert_eq!(graph.plan_counts().reused, 1, "a uniform's value is no part of what is declared");

    // A compute pass in one line, and a bind group from tokens.
    let double = ComputeShader::wgsl(
        "double",
        "@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;
        @compute @workgroup_size(64) fn double(@builtin(global_invocation_id) at: vec3u) {
            numbers[at.x] *= 2;
        }",
    );
    let (device, _queue) = &gpu;
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let mut groups = Vec::new();
    for _ in 0..2 {
        let mut frame = graph.frame();
        let mut numbers = frame.upload_buffer("numbers", vec![1u8; 256]);
        frame.compute("double", &double).storage_mut(&mut numbers, Contents::Preserve).dispatch([1, 1, 1]);
        let mut pass = frame.compute_pass("yours");
        let token = pass.storage_buffer(&numbers);
        pass.keep();
        let (layout, bound) = (&layout, &mut groups);
        pass.body(move |ctx| {
            bound.push(ctx.bind_group(layout, &[Bind::Buffer(token)])?);
            ctx.pass.set_bind_group(0, bound.last(), &[]);
            Ok(())
        });
        let compiled = graph.compile(frame).unwrap();
        run(&mut graph, compiled, &gpu);
    }
    assert_eq!(groups[0], groups[1], "the same buffer, the same group");
}

#[test]
fn outside() {
    let (gpu, mut graph) = (noop(), Graph::new());
    let mut frame = graph.frame();
    let numbers = frame.upload_buffer("numbers", &[1u8, 2, 3, 4][..]);
    let request = frame.read_back_buffer(&numbers, Subresource::FULL);
    let compiled = graph.compile(frame).unwrap();
    let mut executed = run(&mut graph, compiled, &gpu);
    // A future; `wait` blocks instead.
    let bytes = executed.read_back(request).unwrap().wait(&gpu.0).unwrap();
    assert_eq!(bytes, [1, 2, 3, 4]);
}

#[test]
fn poison() {
    for on in [false, true] {
        let (gpu, mut graph) = (noop(), Graph::new());
        graph.set_poison(on);
        let mut frame = graph.frame();
        let mut bytes = frame.create_buffer("bytes", BufferDesc::new(16));
        // It declares that it overwrites the buffer, but writes nothing.
        frame.encoder_pass("liar").copy_target_buffer(&mut bytes, Contents::Overwrite);
        let request = frame.read_back_buffer(&bytes, Subresource::FULL);
        let compiled = graph.compile(frame).unwrap();
        let mut executed = run(&mut graph, compiled, &gpu);
        let bytes = executed.read_back(request).unwrap().wait(&gpu.0).unwrap();
        assert_eq!(bytes.iter().any(|&byte| byte != 0), on, "{bytes:?}");
    }
}
