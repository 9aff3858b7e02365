//! Read-backs requested in a frame: textures on a device that draws, the rest on wgpu's noop device.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::test_device::{block_on, drawing, noop, valid};
use crate::{
    Aspect, BufferDesc, Contents, Error, Executed, Format, Frame, Graph, ReadBack, ReadBackRequest, Rect,
    Subresource, Texture, TextureDesc, TextureUsages,
};

type Gpu = (wgpu::Device, wgpu::Queue);

fn execute(gpu: &Gpu, graph: &mut Graph, frame: Frame<'_>) -> Executed {
    let mut encoder = gpu.0.create_command_encoder(&Default::default());
    let compiled = graph.compile(frame).unwrap();
    let executed = compiled.execute(graph, &gpu.0, &mut encoder).unwrap();
    valid(&gpu.0, || gpu.1.submit([encoder.finish()]));
    executed
}

/// Runs a frame and returns what it reads back.
fn read(gpu: &Gpu, declare: impl FnOnce(&mut Frame<'_>) -> ReadBackRequest) -> Vec<u8> {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let request = declare(&mut frame);
    execute(gpu, &mut graph, frame).read_back(request).unwrap().wait(&gpu.0).unwrap()
}

fn refusal(declare: impl FnOnce(&mut Frame<'_>)) -> Error {
    let mut frame = Frame::new();
    declare(&mut frame);
    frame.compile().err().unwrap()
}

/// A texture whose mips and layers are cleared to ten times the mip plus the layer.
fn numbered(frame: &mut Frame<'_>, desc: TextureDesc) -> Texture {
    let mut texture = frame.create_texture("texture", desc);
    for mip in 0..desc.mip_levels {
        for layer in 0..desc.size.depth_or_array_layers {
            let mut pass = frame.render_pass(format_args!("mip {mip} layer {layer}"));
            let value = f64::from(10 * mip + layer);
            let part = Subresource::FULL.mip(mip).layer(layer);
            pass.subresource(part).color(&mut texture, Contents::clear_color([value; 4]));
        }
    }
    texture
}

fn layered(width: u32, height: u32, mip_levels: u32) -> TextureDesc {
    TextureDesc { mip_levels, ..TextureDesc::d2(width, height, Format::R32Uint).layers(3) }
}

fn words(words: impl IntoIterator<Item = u32>) -> Vec<u8> {
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

#[test]
fn a_texture_of_odd_width_is_read_without_padding() {
    let Some(gpu) = drawing() else { return };
    let bytes = read(&gpu, |frame| {
        let mut image = frame.create_texture("image", TextureDesc::d2(3, 5, Format::Rgba8Unorm));
        frame.render_pass("clear").color(&mut image, Contents::clear_color([0.2, 0.4, 0.6, 1.0]));
        frame.read_back_texture(&image, Subresource::FULL)
    });
    assert_eq!(bytes, [51, 102, 153, 255].repeat(15));
}

#[test]
fn depth_and_stencil_are_read_by_their_aspect() {
    let Some(gpu) = drawing() else { return };
    let depth = read(&gpu, |frame| {
        let mut depth = frame.create_texture("depth", TextureDesc::d2(3, 3, Format::Depth32Float));
        frame.render_pass("clear").depth(&mut depth, Contents::clear_depth(0.25));
        frame.read_back_texture(&depth, Subresource::FULL)
    });
    assert_eq!(depth, 0.25_f32.to_le_bytes().repeat(9));
    let stencil = read(&gpu, |frame| {
        let mut depth = frame.create_texture("depth", TextureDesc::d2(5, 3, Format::Depth24PlusStencil8));
        frame.render_pass("clear").depth(&mut depth, Contents::clear_depth_stencil(0.25, 7));
        frame.read_back_texture(&depth, Subresource::FULL.aspect(Aspect::Stencil))
    });
    assert_eq!(stencil, [7; 15]);
}

#[test]
fn a_mip_of_a_layer_is_read() {
    let Some(gpu) = drawing() else { return };
    let one = |part| {
        read(&gpu, |frame| {
            let texture = numbered(frame, layered(7, 4, 3));
            frame.read_back_texture(&texture, part)
        })
    };
    assert_eq!(one(Subresource::FULL.mip(1).layer(2)), words([12; 3 * 2]));
    assert_eq!(one(Subresource::FULL.mip(2).layers(1..3)), words([21, 22]));
    assert_eq!(one(Subresource::FULL.mip(2)), words([20, 21, 22]), "all layers");
}

#[test]
fn a_rectangle_is_read() {
    let Some(gpu) = drawing() else { return };
    let bytes = read(&gpu, |frame| {
        let mut image = frame.create_texture("image", TextureDesc::d2(8, 8, Format::R32Uint));
        frame.render_pass("clear").color(&mut image, Contents::clear_color([1.0; 4]));
        let mut pass = frame.render_pass("tile");
        let tile = Subresource::FULL.rect(Rect::new(5, 3, 1, 2));
        pass.subresource(tile).color(&mut image, Contents::clear_color([2.0; 4]));
        frame.read_back_texture(&image, Subresource::FULL.rect(Rect::new(4, 4, 3, 2)))
    });
    assert_eq!(bytes, words([1, 2, 1, 1, 1, 1]));
}

#[test]
fn any_range_of_a_buffer_is_read() {
    let gpu = noop();
    let contents: Vec<u8> = (0..64).collect();
    for (part, range) in [
        (Subresource::FULL, 0..64),
        (Subresource::FULL.bytes(3..9), 3..9),
        (Subresource::FULL.bytes(63..64), 63..64),
    ] {
        let bytes = read(&gpu, |frame| {
            let numbers = frame.upload_buffer("numbers", contents.clone());
            frame.read_back_buffer(&numbers, part)
        });
        assert_eq!(bytes, contents[range]);
    }
}

#[test]
fn frames_in_flight_have_separate_results() {
    let gpu = noop();
    let mut graph = Graph::new();
    let frames: Vec<_> = (0..4u8)
        .map(|number| {
            let mut frame = graph.frame();
            let numbers = frame.upload_buffer("numbers", vec![number; 16]);
            let requests =
                [0..4, 4..16].map(|range| frame.read_back_buffer(&numbers, Subresource::FULL.bytes(range)));
            let mut encoder = gpu.0.create_command_encoder(&Default::default());
            let compiled = graph.compile(frame).unwrap();
            let mut executed = compiled.execute(&mut graph, &gpu.0, &mut encoder).unwrap();
            (number, requests.map(|request| executed.read_back(request).unwrap()), encoder)
        })
        .collect();
    assert_eq!(graph.plan_counts().compiled, 1);
    let (mut backs, mut commands) = (Vec::new(), Vec::new());
    for (number, own, encoder) in frames {
        backs.push((number, own));
        commands.push(encoder.finish());
    }
    valid(&gpu.0, || gpu.1.submit(commands.into_iter().rev()));
    gpu.1.submit([]);
    for (number, [four, twelve]) in backs {
        assert_eq!(block_on(four).unwrap(), [number; 4]);
        assert_eq!(block_on(twelve).unwrap(), [number; 12]);
    }
}

#[test]
fn a_result_is_taken_once_and_by_its_own_frame() {
    let gpu = noop();
    let mut graph = Graph::new();
    let mut requests = Vec::new();
    let mut executed: Vec<Executed> = (0..2)
        .map(|_| {
            let mut frame = graph.frame();
            let numbers = frame.upload_buffer("numbers", vec![1; 4]);
            requests.push(frame.read_back_buffer(&numbers, Subresource::FULL));
            execute(&gpu, &mut graph, frame)
        })
        .collect();
    assert!(executed[0].read_back(requests[1]).is_none());
    assert!(executed[0].read_back(requests[0]).is_some());
    assert!(executed[0].read_back(requests[0]).is_none());
}

#[test]
fn the_plan_shows_a_read_back_as_an_export() {
    let mut frame = Frame::new();
    let mut image = frame.create_texture("image", TextureDesc::d2(4, 4, Format::Rgba8Unorm));
    let pass = frame.render_pass("draw");
    let id = pass.id();
    { pass }.color(&mut image, Contents::clear_color([0.0; 4]));
    frame.read_back_texture(&image, Subresource::FULL);
    let plan = frame.compile().unwrap().into_plan();
    let resource = plan.resource(image.id());
    assert!(resource.exported);
    assert!(resource.texture_usage.contains(TextureUsages::COPY_SRC | TextureUsages::RENDER_ATTACHMENT));
    assert!(!resource.texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT));
    assert_eq!(plan.order(), [id], "the pass that writes it is not culled");
    assert!(plan.to_text().contains("exported"), "{}", plan.to_text());
}

#[test]
fn a_resource_that_is_read_back_shares_its_slot_with_no_later_one() {
    let gpu = noop();
    let (mut graph, mut requests) = (Graph::new(), Vec::new());
    let mut frame = graph.frame();
    for number in 0..3u8 {
        let numbers = frame.upload_buffer("numbers", vec![number; 16]);
        requests.push(frame.read_back_buffer(&numbers, Subresource::FULL));
    }
    let mut executed = execute(&gpu, &mut graph, frame);
    let taken: Vec<ReadBack> = requests.iter().map(|&request| executed.read_back(request).unwrap()).collect();
    for (number, back) in (0..).zip(taken) {
        assert_eq!(back.wait(&gpu.0).unwrap(), [number; 16]);
    }
}

#[test]
fn an_import_is_read_back() {
    let gpu = noop();
    let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    let own = wgpu::BufferDescriptor { label: None, size: 8, usage, mapped_at_creation: false };
    let own = gpu.0.create_buffer(&own);
    let bytes = read(&gpu, |frame| {
        let numbers = frame.upload_buffer("numbers", vec![9; 8]);
        let mut import = frame.import_buffer("own", &own, false);
        frame.copy_pass("copy").buffer(&numbers, &mut import);
        frame.read_back_buffer(&import, Subresource::FULL.bytes(0..3))
    });
    assert_eq!(bytes, [9; 3]);
}

#[test]
fn errors_are_those_of_exports() {
    let square = TextureDesc::d2(4, 4, Format::Rgba8Unorm);
    let later = refusal(|frame| {
        let mut image = frame.create_texture("image", square);
        frame.render_pass("draw").color(&mut image, Contents::clear_color([0.0; 4]));
        frame.read_back_texture(&image, Subresource::FULL);
        frame.render_pass("again").color(&mut image, Contents::clear_color([0.0; 4]));
    });
    assert_eq!(later.code(), "SG0101", "{later}");
    let stale = refusal(|frame| {
        let mut image = frame.create_texture("image", square);
        let before = image.clone();
        frame.render_pass("draw").color(&mut image, Contents::clear_color([0.0; 4]));
        frame.read_back_texture(&before, Subresource::FULL);
    });
    assert_eq!(stale.code(), "SG0101", "{stale}");
    let undefined = refusal(|frame| {
        let numbers = frame.create_buffer("numbers", BufferDesc::new(4));
        frame.read_back_buffer(&numbers, Subresource::FULL);
    });
    assert_eq!(undefined.code(), "SG0201", "{undefined}");
    let foreign = refusal(|frame| {
        let numbers = Frame::new().create_buffer("numbers", BufferDesc::new(4));
        frame.read_back_buffer(&numbers, Subresource::FULL);
    });
    assert_eq!(foreign.code(), "SG0103", "{foreign}");
}

#[test]
fn what_one_copy_cannot_read_is_an_error_that_says_why() {
    let expect_error = |desc: TextureDesc, part: Subresource, words: &str| {
        let error = refusal(|frame| {
            let texture = frame.create_texture("texture", desc);
            frame.read_back_texture(&texture, part);
        });
        let text = error.to_string();
        assert!(matches!(&error, Error::ReadBack { resource, .. } if resource == "texture"), "{text}");
        assert!(text.contains(words), "{text}");
    };
    let color = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
    let depth = |format| TextureDesc::d2(8, 8, format);
    let rect = Subresource::FULL.rect(Rect::new(1, 1, 2, 2));
    expect_error(TextureDesc { mip_levels: 3, ..color }, Subresource::FULL, "3 mip levels are requested");
    expect_error(TextureDesc { mip_levels: 3, ..color }, Subresource::FULL.mip(3), "past the last mip");
    expect_error(color, Subresource::FULL.bytes(0..4), "no byte ranges");
    expect_error(color, Subresource::FULL.aspect(Aspect::Depth), "does not have that aspect");
    expect_error(TextureDesc { samples: 4, ..color }, Subresource::FULL, "resolve it");
    expect_error(depth(Format::Depth32Float), rect, "copied whole");
    expect_error(depth(Format::Depth24Plus), Subresource::FULL, "use Depth32Float");
    expect_error(depth(Format::Depth24PlusStencil8), Subresource::FULL, "only the depth or only the stencil");
    expect_error(depth(Format::Bc1RgbaUnorm), rect, "whole blocks");
    let error = refusal(|frame| {
        let numbers = frame.upload_buffer("numbers", vec![0; 8]);
        frame.read_back_buffer(&numbers, Subresource::FULL.bytes(4..12));
    });
    assert!(error.to_string().contains("requested: bytes 4..12"), "{error}");
}

#[test]
fn an_import_without_the_usage_is_an_error() {
    let error = refusal(|frame| {
        let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
        let own = frame.declare_import_texture("own", desc, TextureUsages::RENDER_ATTACHMENT, true);
        frame.read_back_texture(&own, Subresource::FULL);
    });
    assert!(matches!(&error, Error::ReadBack { resource, .. } if resource == "own"), "{error}");
    assert!(error.to_string().contains("COPY_SRC"), "{error}");
}
