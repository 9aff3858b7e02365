//! Shaders that do not compile or do not match their pass are errors of the frame, never panics of wgpu.

use super::{Gpu, cleared, fragment, kernel, texture};
use crate::{ComputeShader, Contents, Error, Format, Frame, FullscreenShader};

/// Returns the error of a frame that `declare` declares.
fn error_of(declare: impl FnOnce(&mut Gpu, &mut Frame<'_>)) -> Error {
    let mut gpu = Gpu::noop();
    let mut frame = gpu.graph.frame();
    declare(&mut gpu, &mut frame);
    gpu.run(frame).err().unwrap()
}

fn draw(frame: &mut Frame<'_>, shader: &FullscreenShader, format: Format) {
    let mut image = texture(frame, "image", 4, format);
    frame.fullscreen("draw", shader).draw(&mut image);
    frame.export_texture(&image);
}

fn assert_error(error: &Error, shader: &str, words: &[&str]) {
    let Error::Shader { shader: named, message } = error else { panic!("{error:?}") };
    assert_eq!((&**named, error.code()), (shader, "SG0604"), "{error}");
    for word in words {
        assert!(message.contains(word), "`{word}` is not in: {message}");
    }
}

#[test]
fn source_that_is_not_wgsl_is_an_error_that_shows_the_location() {
    let error = error_of(|_, frame| {
        let shader = FullscreenShader::wgsl("broken", "fn half( -> f32 { return 0.5; }");
        draw(frame, &shader, Format::Rgba8Unorm);
    });
    assert_error(
        &error,
        "broken",
        &["line 1, column 10: expected identifier, found \"->\", in `fn half( -> f32 { return 0.5; }`"],
    );
    let error = error_of(|_, frame| {
        let text = "fn half() -> vec4f {\n    return vec2f(0.5);\n}";
        draw(frame, &FullscreenShader::wgsl("half", text), Format::Rgba8Unorm);
    });
    assert_error(
        &error,
        "half",
        &[
            "line 2: Function [0] 'half' is invalid",
            "does not match the declared return type",
            "in `return vec2f(0.5);`",
        ],
    );
    assert_eq!(error.to_string().lines().count(), 1, "{error}");
    assert!(!error.to_string().contains("Device::"), "{error}");
}

#[test]
fn a_missing_entry_point_is_an_error() {
    let error = error_of(|_, frame| draw(frame, &fragment("nowhere"), Format::Rgba8Unorm));
    assert_error(&error, "nowhere", &["nowhere"]);
    let error = error_of(|_, frame| {
        let several = FullscreenShader::wgsl("several", super::TEXT);
        draw(frame, &several, Format::Rgba8Unorm);
    });
    assert_error(&error, "several", &["entry point"]);
}

#[test]
fn an_output_that_does_not_match_the_target_is_an_error() {
    let error = error_of(|_, frame| draw(frame, &fragment("wrong_type"), Format::Rgba8Unorm));
    assert_error(&error, "wrong_type", &["Color state [0] is invalid: Output format Float32x4"]);
}

#[test]
fn too_many_or_too_few_bindings_are_an_error_that_names_the_pass() {
    for count in [0, 1, 3] {
        let error = error_of(|_, frame| {
            let source = cleared(frame, "source", 4, 0.0);
            let mut image = texture(frame, "image", 4, Format::Rgba8Unorm);
            let mut halve =
                frame.fullscreen("halve it", &fragment(if count == 1 { "scaled" } else { "halve" }));
            for _ in 0..count {
                halve = halve.sample(&source);
            }
            halve.draw(&mut image);
            frame.export_texture(&image);
        });
        let shader = if count == 1 { "scaled" } else { "halve" };
        assert_error(
            &error,
            shader,
            &[
                "the bindings of pass `halve it`",
                "exactly those that the shader uses",
                "in order: Number of bindings",
            ],
        );
    }
}

#[test]
fn a_uniform_block_that_is_too_small_is_an_error() {
    let error = error_of(|_, frame| {
        let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
        let multiply = kernel("multiply");
        let call = frame.compute("multiply", &multiply).storage_mut(&mut numbers, Contents::Preserve);
        call.uniform(&[1, 2]).dispatch([1; 3]);
        frame.export_buffer(&numbers);
    });
    assert_error(&error, "multiply", &["the bindings of pass `multiply`"]);
}

#[test]
fn an_empty_uniform_block_is_an_error() {
    let error = error_of(|_, frame| {
        let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
        let multiply = kernel("multiply");
        let call = frame.compute("multiply", &multiply).storage_mut(&mut numbers, Contents::Preserve);
        call.uniform(&[]).dispatch([1; 3]);
    });
    assert!(
        matches!(&error, Error::InvalidResource { resource, .. } if resource.contains("`multiply`")),
        "{error}"
    );
}

#[test]
fn a_binding_in_another_group_is_an_error_that_says_what_to_do() {
    let error = error_of(|_, frame| draw(frame, &fragment("other_group"), Format::Rgba8Unorm));
    assert_error(&error, "other_group", &["bindings in group 1", "render_pass"]);
}

#[test]
fn source_without_the_stage_is_an_error() {
    let error = error_of(|_, frame| {
        let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
        let shader = ComputeShader::wgsl("empty", "");
        frame.compute("empty", &shader).storage_mut(&mut numbers, Contents::Preserve).dispatch([1; 3]);
        frame.export_buffer(&numbers);
    });
    assert_error(&error, "empty", &["entry point"]);
}

#[test]
fn more_workgroups_than_the_device_allows_are_an_error() {
    let error = error_of(|_, frame| {
        let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
        let call = frame.compute("double", &kernel("double")).storage_mut(&mut numbers, Contents::Preserve);
        call.dispatch([1, 70_000, 1]);
        frame.export_buffer(&numbers);
    });
    assert!(matches!(error, Error::Limit { needed: 70_000, .. }), "{error}");
}

#[test]
fn indirect_arguments_outside_the_buffer_or_misaligned_are_errors() {
    for offset in [4, 2, u64::MAX] {
        let error = error_of(|_, frame| {
            let arguments = frame.upload_buffer("arguments", vec![0; 12]);
            let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
            let call =
                frame.compute("double", &kernel("double")).storage_mut(&mut numbers, Contents::Preserve);
            call.dispatch_indirect(&arguments, offset);
            frame.export_buffer(&numbers);
        });
        assert!(
            matches!(&error, Error::InvalidSubresource { resource, .. } if resource == "arguments"),
            "{error}"
        );
    }
}

#[test]
fn handles_of_another_frame_are_errors() {
    let mut other = Frame::new();
    let (mut foreign, buffer) =
        (texture(&mut other, "t", 4, Format::Rgba8Unorm), other.upload_buffer("b", vec![0; 64]));
    for case in 0..5 {
        let error = error_of(|_, frame| {
            let mut image = texture(frame, "image", 4, Format::Rgba8Unorm);
            let mut bytes = frame.create_buffer("bytes", crate::BufferDesc::new(64));
            match case {
                0 => drop(frame.fullscreen("draw", &fragment("level")).draw(&mut foreign)),
                1 => drop(frame.fullscreen("draw", &fragment("halve")).sample(&foreign).draw(&mut image)),
                2 => drop(frame.fullscreen("draw", &fragment("depth_of_uv")).draw_depth(&mut foreign)),
                3 => {
                    let call = frame.compute("double", &kernel("double"));
                    call.storage_mut(&mut bytes, Contents::Overwrite).dispatch_indirect(&buffer, 2);
                }
                _ => drop(frame.compute("double", &kernel("double")).storage(&buffer).dispatch([1; 3])),
            }
        });
        assert!(matches!(error, Error::ForeignHandle { .. }), "{case}: {error}");
    }
}

#[test]
fn more_targets_than_any_device_supports_are_an_error() {
    let error = error_of(|_, frame| {
        let mut targets: Vec<_> = (0..9).map(|_| texture(frame, "t", 4, Format::Rgba8Unorm)).collect();
        let mut last = targets.pop().unwrap();
        let shader = fragment("level");
        let mut call = frame.fullscreen("draw", &shader);
        for target in &mut targets {
            call = call.target(target);
        }
        call.draw(&mut last);
        frame.export_texture(&last);
    });
    assert!(matches!(error, Error::Limit { limit: "max_color_attachments", .. }), "{error}");
}

#[test]
fn a_frame_after_one_with_an_error_draws() {
    let mut gpu = Gpu::noop();
    for shader in [fragment("wrong_type"), fragment("level")] {
        let mut frame = gpu.graph.frame();
        draw(&mut frame, &shader, Format::Rgba8Unorm);
        assert_eq!(gpu.run(frame).is_ok(), shader.0.name == "level");
    }
    assert_eq!(gpu.cached().0, 1);
}
