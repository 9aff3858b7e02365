//! Clearing a region, compared with `LoadOp::Clear` of the whole attachment.

use super::Gpu;
use super::stage::{SIDE, Stage, Values};
use crate::Rect;
use crate::desc::Format;
use crate::internal::{RegionClear, RegionClears, module, vertex};

const ALL: Rect = Rect { x: 0, y: 0, width: SIDE, height: SIDE };

// Values that the formats represent exactly: drivers may round others differently in a draw and a clear, as Mesa's llvmpipe
// does in `Rgb10a2Unorm`.
const FLOAT: [[f64; 4]; 2] = [[1.0, 0.4, 0.8, 0.0], [0.2, 0.4, 0.6, 0.8]];
const TENTHS: [[f64; 4]; 2] = [[1.0, 0.0, 1.0, 0.0], [1.0 / 3.0, 2.0 / 3.0, 0.0, 1.0 / 3.0]];
const SIGNED: [[f64; 4]; 2] = [[1.0, -1.0, 0.0, 1.0], [-1.0, 0.0, 1.0, -1.0]];
const HALF: [[f64; 4]; 2] = [[1.0, 0.5, 0.25, 0.0], [0.25, 8.0, 0.75, 2.0]];
const SINGLE: [[f64; 4]; 2] = [[1.0, -0.5, 0.25, 0.0], [-0.1, 1e9, 1e-9, 0.8]];
const UINT: [[f64; 4]; 2] = [[1.0, 2.0, 3.0, 0.0], [255.0, 128.0, 7.0, 3.0]];
const SINT: [[f64; 4]; 2] = [[1.0, -2.0, 3.0, -4.0], [-128.0, 127.0, -1.0, 0.0]];
/// Neither is a number of 32-bit float.
const WIDE_UINT: [[f64; 4]; 2] = [[1.0, 2.0, 3.0, 4.0], [4_294_967_295.0, 16_777_217.0, 0.0, 5.0]];
const WIDE_SINT: [[f64; 4]; 2] = [[1.0, 2.0, 3.0, 4.0], [-2_147_483_647.0, 16_777_217.0, -1.0, 5.0]];

/// Colour formats of every sample type and width, with values before and after.
pub(super) const COLORS: [(Format, [[f64; 4]; 2]); 30] = [
    (Format::R8Unorm, FLOAT),
    (Format::Rg8Unorm, FLOAT),
    (Format::Rgba8Unorm, FLOAT),
    (Format::Rgba8UnormSrgb, FLOAT),
    (Format::Bgra8Unorm, FLOAT),
    (Format::Bgra8UnormSrgb, FLOAT),
    (Format::Rgb10a2Unorm, TENTHS),
    (Format::R16Unorm, FLOAT),
    (Format::Rgba16Unorm, FLOAT),
    (Format::R8Snorm, SIGNED),
    (Format::Rgba8Snorm, SIGNED),
    (Format::Rgba16Snorm, SIGNED),
    (Format::R16Float, HALF),
    (Format::Rgba16Float, HALF),
    (Format::Rg11b10Ufloat, HALF),
    (Format::R32Float, SINGLE),
    (Format::Rg32Float, SINGLE),
    (Format::Rgba32Float, SINGLE),
    (Format::R8Uint, UINT),
    (Format::Rgba8Uint, UINT),
    (Format::Rg16Uint, UINT),
    (Format::Rgb10a2Uint, UINT),
    (Format::R32Uint, WIDE_UINT),
    (Format::Rgba32Uint, WIDE_UINT),
    (Format::R8Sint, SINT),
    (Format::Rgba8Sint, SINT),
    (Format::Rg16Sint, SINT),
    (Format::Rgba16Sint, SINT),
    (Format::R32Sint, WIDE_SINT),
    (Format::Rgba32Sint, WIDE_SINT),
];

pub(super) const DEPTH_STENCILS: [Format; 6] = [
    Format::Stencil8,
    Format::Depth16Unorm,
    Format::Depth24Plus,
    Format::Depth32Float,
    Format::Depth24PlusStencil8,
    Format::Depth32FloatStencil8,
];

fn color(value: [f64; 4]) -> Values {
    Values { colors: vec![Some(value)], ..Default::default() }
}

fn depth_stencil(depth: Option<f32>, stencil: Option<u32>) -> Values {
    Values { colors: Vec::new(), depth, stencil }
}

fn check_colors(gpu: &Gpu, samples: u32) {
    for (format, [before, over]) in COLORS.into_iter().filter(|(format, _)| gpu.renders(*format, samples)) {
        Stage::new(gpu, &[Some(format)], None, samples).check(&color(before), &color(over));
    }
}

fn check_depth_stencils(gpu: &Gpu, samples: u32) {
    let before = depth_stencil(Some(0.5), Some(9));
    for format in DEPTH_STENCILS.into_iter().filter(|format| gpu.renders(*format, samples)) {
        let stage = Stage::new(gpu, &[], Some(format), samples);
        // Both, one of two, and aspects that not every format has.
        for over in [(Some(0.25), Some(200)), (Some(0.25), None), (None, Some(200))] {
            stage.check(&before, &depth_stencil(over.0, over.1));
        }
    }
}

/// Clears attachments of all sample types, one of them unchanged and one missing, with depth.
fn check_mixed(gpu: &Gpu, samples: u32) {
    let formats = [
        Some(Format::Rgba8Unorm),
        None,
        Some(Format::R16Uint),
        Some(Format::Rg16Sint),
        Some(Format::Rgba8Unorm),
        Some(Format::R16Sint),
    ];
    let before = Values {
        colors: vec![Some(FLOAT[0]), None, Some(UINT[0]), Some(SINT[0]), Some(FLOAT[0]), Some(SINT[0])],
        depth: Some(0.5),
        stencil: Some(3),
    };
    let stage = Stage::new(gpu, &formats, Some(Format::Depth24PlusStencil8), samples);
    let (float, sint) = (Some(FLOAT[1]), Some(SINT[1]));
    for colors in [
        vec![float, None, Some(UINT[1]), sint, None, sint],
        // The missing attachment has a value, which is ignored, and the list is shorter.
        vec![None, float, None, sint],
        vec![None; 6],
    ] {
        stage.check(&before, &Values { colors, depth: Some(0.25), stencil: None });
        let over = Values { colors: vec![float], depth: None, stencil: Some(255) };
        stage.check(&before, &over);
    }
}

/// Records a pass that reads depth and stencil and clears colour.
fn check_read_only_depth(gpu: &Gpu) {
    for format in [Format::Depth32Float, Format::Depth24PlusStencil8] {
        let mut stage = Stage::new(gpu, &[Some(Format::Rgba8Unorm)], Some(format), 1);
        stage.depth_read_only = true;
        let before = Values { colors: vec![Some(FLOAT[0])], depth: Some(0.5), stencil: Some(3) };
        stage.check(&before, &color(FLOAT[1]));
    }
}

#[test]
fn a_tile_of_any_color_format_is_cleared_and_its_neighbours_kept() {
    let Some(gpu) = Gpu::real() else { return };
    check_colors(&gpu, 1);
}

#[test]
fn all_samples_of_a_multisampled_tile_are_cleared() {
    let Some(gpu) = Gpu::real() else { return };
    check_colors(&gpu, 4);
    check_depth_stencils(&gpu, 4);
    check_mixed(&gpu, 4);
}

#[test]
fn depth_and_stencil_of_a_tile_are_cleared_together_or_alone() {
    let Some(gpu) = Gpu::real() else { return };
    check_depth_stencils(&gpu, 1);
}

#[test]
fn a_cleared_depth_is_stored_as_a_whole_clear_stores_it() {
    let Some(gpu) = Gpu::real() else { return };
    for format in [Format::Depth16Unorm, Format::Depth32Float] {
        let stage = Stage::new(&gpu, &[], Some(format), 1);
        for depth in [0.0, f32::MIN_POSITIVE, 1e-7, 0.1, 0.25, 1.0 / 3.0, 0.7, 0.999_999_94, 1.0] {
            stage.check(&depth_stencil(Some(0.5), None), &depth_stencil(Some(depth), None));
        }
    }
}

#[test]
fn attachments_of_all_sample_types_are_cleared_in_one_pass_next_to_a_missing_and_an_unchanged_one() {
    let Some(gpu) = Gpu::real() else { return };
    check_mixed(&gpu, 1);
}

#[test]
fn colors_are_cleared_where_depth_is_read_only() {
    let Some(gpu) = Gpu::real() else { return };
    check_read_only_depth(&gpu);
}

#[test]
fn every_kind_of_clear_validates() {
    let gpu = Gpu::noop();
    for samples in [1, 4] {
        check_colors(&gpu, samples);
        check_depth_stencils(&gpu, samples);
        check_mixed(&gpu, samples);
    }
    check_read_only_depth(&gpu);
}

#[test]
fn a_later_draw_finds_the_stencil_reference_at_zero() {
    let Some(gpu) = Gpu::real() else { return };
    let stage = Stage::new(&gpu, &[], Some(Format::Stencil8), 1);
    let module = module(&gpu.device, "stencil", "");
    let face =
        wgpu::StencilFaceState { pass_op: wgpu::StencilOperation::Replace, ..wgpu::StencilFaceState::IGNORE };
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: vertex(&module),
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: Format::Stencil8,
            depth_write_enabled: None,
            depth_compare: None,
            stencil: wgpu::StencilState { front: face, back: face, read_mask: !0, write_mask: !0 },
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    });
    stage.pass(Some(&depth_stencil(None, Some(9))), |pass| {
        let clear = RegionClear { colors: &[], depth: None, stencil: Some(200), rect: ALL };
        RegionClears::default().record(&gpu.device, pass, &stage.targets, &clear);
        pass.set_pipeline(&pipeline);
        pass.set_scissor_rect(0, 0, 1, 1);
        pass.draw(0..3, 0..1);
    });
    let stencil = stage.read().concat().concat();
    assert_eq!(stencil[..2], [0, 200]);
}

#[test]
fn an_empty_rectangle_or_nothing_to_clear_records_nothing() {
    let gpu = Gpu::noop();
    let stage = Stage::new(&gpu, &[None, Some(Format::R8Unorm)], Some(Format::Depth16Unorm), 1);
    let mut clears = RegionClears::default();
    stage.pass(None, |pass| {
        let nothing = RegionClear { colors: &[Some(FLOAT[0])], depth: None, stencil: Some(1), rect: ALL };
        clears.record(&gpu.device, pass, &stage.targets, &nothing);
        let empty = RegionClear { depth: Some(1.0), rect: Rect { width: 0, ..ALL }, ..nothing };
        clears.record(&gpu.device, pass, &stage.targets, &empty);
    });
    assert_eq!(clears.len(), (0, 0));
}

#[test]
fn values_share_a_pipeline_and_are_dropped_when_idle() {
    let gpu = Gpu::noop();
    let stage = Stage::new(&gpu, &[Some(Format::R8Unorm)], None, 1);
    let mut clears = RegionClears::default();
    for frame in 0..20 {
        clears.begin_frame(frame, frame.saturating_sub(8));
        let changing = [frame as f64 / 20.0; 4];
        stage.pass(None, |pass| {
            for value in [changing, [1.0; 4], changing] {
                let clear = RegionClear { colors: &[Some(value)], depth: None, stencil: None, rect: ALL };
                clears.record(&gpu.device, pass, &stage.targets, &clear);
            }
        });
    }
    // One value of each of the last nine frames, and the constant one.
    assert_eq!(clears.len(), (1, 10));
}
