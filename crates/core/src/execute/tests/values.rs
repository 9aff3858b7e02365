//! Checks of the values that passes write.

use super::gpu::Gpu;
use crate::{
    Contents, Format, Frame, Graph, Rect, Subresource, Texture, TextureDesc, ValueCheck, ValueReport,
};

/// Draws a frame with a check, and returns the report and its text.
fn check<'f>(gpu: &'f Gpu, check: ValueCheck, declare: impl Fn(&mut Frame<'f>)) -> (ValueReport, String) {
    let mut graph = Graph::new();
    graph.check_values(Some(check));
    let mut frame = graph.frame();
    declare(&mut frame);
    let mut executed = gpu.run(&mut graph, frame);
    let report = executed.take_values().unwrap().wait(&gpu.device).unwrap();
    assert!(executed.take_values().is_none());
    let text = report.to_text(executed.plan());
    (report, text)
}

fn texture(frame: &mut Frame<'_>, name: &'static str, format: Format) -> Texture {
    frame.create_texture(name, TextureDesc::d2(16, 8, format))
}

fn fill(
    frame: &mut Frame<'_>,
    pass: &'static str,
    target: &mut Texture,
    rect: Option<Rect>,
    color: [f64; 4],
) {
    let mut pass = frame.render_pass(pass);
    match rect {
        Some(rect) => pass.subresource(Subresource::FULL.rect(rect)),
        None => &mut pass,
    }
    .color(target, Contents::clear_color(color));
}

#[test]
fn the_first_pass_that_writes_a_nan_is_named_with_its_texel_and_what_it_read_there() {
    let Some(gpu) = Gpu::drawing() else { return };
    let (report, text) = check(&gpu, ValueCheck::default(), |frame| {
        let mut source = texture(frame, "source", Format::Rgba8Unorm);
        fill(frame, "fill", &mut source, None, [0.0, 1.0, 0.0, 1.0]);
        let mut color = texture(frame, "color", Format::Rgba16Float);
        fill(frame, "clear", &mut color, None, [2.0; 4]);
        let mut pass = frame.render_pass("divide");
        let _source = pass.sample(&source);
        let tile = Subresource::FULL.rect(Rect::new(5, 3, 2, 1));
        pass.subresource(tile).color(&mut color, Contents::clear_color([1.0, f64::NAN, f64::INFINITY, 1.0]));
        frame.export_texture(&color);
    });
    let [bad] = &report.bad[..] else { panic!("{text}") };
    assert_eq!((bad.nan, bad.infinite, bad.outside), (2, 0, 0));
    assert_eq!(bad.first.at, [5, 3, 0]);
    assert!(bad.first.value[1].is_nan() && bad.first.value[2] == f64::INFINITY, "{bad:?}");
    assert_eq!(bad.inputs[0].at, [5, 3, 0]);
    assert_eq!(bad.inputs[0].value, [0.0, 1.0, 0.0, 1.0]);
    assert_eq!(
        text,
        "`divide` wrote `color` v2: 2 texels NaN\n  there: `color` v2 at 5,3: 1 NaN inf 1\n  read:  `source` v1 at 5,3: 0 1 0 1\n"
    );
}

#[test]
fn values_of_later_versions_are_checked_too() {
    let Some(gpu) = Gpu::drawing() else { return };
    let (report, text) = check(&gpu, ValueCheck::default(), |frame| {
        let mut color = texture(frame, "color", Format::R32Float);
        fill(frame, "first", &mut color, None, [f64::INFINITY; 4]);
        let mut copy = texture(frame, "copy", Format::R32Float);
        frame.copy_pass("copy").texture(&color, &mut copy);
        fill(frame, "second", &mut color, None, [1.0; 4]);
        frame.export_texture(&color);
        frame.export_texture(&copy);
    });
    assert_eq!(report.bad.len(), 2, "{text}");
    assert_eq!(report.bad[1].infinite, 128);
    assert_eq!(report.bad[1].inputs[0].value, [f64::INFINITY]);
}

#[test]
fn declared_ranges_hold_for_all_formats_but_integers() {
    let Some(gpu) = Gpu::drawing() else { return };
    let ranges = ValueCheck::default().range("mask", 0.0..=0.5).range("color", -1.0..=1.0);
    let (report, text) = check(&gpu, ranges, |frame| {
        let mut mask = texture(frame, "mask", Format::R8Unorm);
        fill(frame, "clear", &mut mask, None, [0.25; 4]);
        fill(frame, "mask", &mut mask, Some(Rect::new(0, 7, 3, 1)), [1.0; 4]);
        let mut color = texture(frame, "color", Format::Rgba16Float);
        fill(frame, "color", &mut color, None, [1.0, -1.0, 0.0, 0.5]);
        let mut ids = texture(frame, "ids", Format::R32Uint);
        fill(frame, "ids", &mut ids, None, [f64::from(0x7f80_0001); 4]);
        for texture in [&mask, &color, &ids] {
            frame.export_texture(texture);
        }
    });
    let [bad] = &report.bad[..] else { panic!("{text}") };
    assert_eq!((bad.outside, bad.first.at), (3, [0, 7, 0]), "{text}");
    assert!(text.starts_with("`mask` wrote `mask` v2: 3 texels outside of 0 to 0.5\n"), "{text}");
}

#[test]
fn all_kinds_of_textures_can_be_checked() {
    for gpu in Gpu::all() {
        let (report, text) = check(&gpu, ValueCheck::default(), |frame| {
            let wide = |format| TextureDesc::d2(16, 8, format);
            let mut samples = frame.create_texture("samples", wide(Format::Rgba16Float).samples(4));
            let mut depth = frame.create_texture("depth", wide(Format::Depth32Float).samples(4));
            let mut pass = frame.render_pass("samples");
            pass.color(&mut samples, Contents::clear_color([f64::NAN; 4]));
            pass.depth(&mut depth, Contents::clear_depth(0.5));
            pass.keep();
            let mut layers = frame.create_texture("layers", wide(Format::R32Float).layers(3));
            for layer in 0..3 {
                let mut pass = frame.render_pass("layers");
                let value = if layer == 2 { f64::NAN } else { 0.0 };
                pass.subresource(Subresource::FULL.layer(layer))
                    .color(&mut layers, Contents::clear_color([value; 4]));
            }
            let mut small =
                frame.create_texture("small", TextureDesc { mip_levels: 2, ..wide(Format::R32Float) });
            for mip in 0..2 {
                let mut pass = frame.render_pass("small");
                let _layers = pass.subresource(Subresource::FULL.layer(2)).sample(&layers);
                let value = if mip == 1 { f64::NEG_INFINITY } else { 0.0 };
                pass.subresource(Subresource::FULL.mip(mip))
                    .color(&mut small, Contents::clear_color([value; 4]));
            }
            for texture in [&layers, &small, &samples] {
                frame.export_texture(texture);
            }
        });
        if !gpu.draws {
            continue;
        }
        let found: Vec<_> =
            report.bad.iter().map(|bad| (bad.nan, bad.infinite, bad.first.mip, bad.first.at)).collect();
        assert_eq!(found, [(128, 0, 0, [0, 0, 0]), (128, 0, 0, [0, 0, 2]), (0, 32, 1, [0, 0, 0])], "{text}");
        assert_eq!(report.bad[2].inputs[0].at, [0, 0, 2]);
        assert!(report.unchecked.is_empty(), "{text}");
    }
}

#[test]
fn a_texture_of_the_user_that_shaders_cannot_read_is_named() {
    let Some(gpu) = Gpu::drawing() else { return };
    let own = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 4, height: 4, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Format::R32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let (report, text) = check(&gpu, ValueCheck::default(), |frame| {
        let mut own = frame.import_texture("own", &own, true);
        fill(frame, "fill", &mut own, None, [f64::NAN; 4]);
    });
    assert!(report.bad.is_empty());
    assert_eq!(text, "not checked: `own`: it lacks the usage TEXTURE_BINDING\n");
}
