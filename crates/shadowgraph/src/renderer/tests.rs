#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use super::*;
use shadowgraph_core::StoreReason;
use shadowgraph_core::{Executed, Format};
use shadowgraph_samples::demo::demo_scene;
use shadowgraph_shadows::ShadowSettings;
use wgpu::TextureUsages;

fn target(gpu: &Gpu, size_px: [u32; 2], format: Format, usage: TextureUsages) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d { width: size_px[0], height: size_px[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Records the demo scene into a target on the noop device, which checks what is recorded.
fn record(gpu: &Gpu, aov: Aov, target: &wgpu::Texture) -> Result<Executed, Error> {
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let mut renderer = Renderer::new(gpu, scene, &camera, aov)?;
    let options = ViewOptions { camera, size_px: [1, 1], shadows: ShadowSettings::default() };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let executed = renderer.record(gpu, &mut encoder, target, &options)?;
    gpu.queue.submit([encoder.finish()]);
    Ok(executed)
}

#[test]
fn colours_are_drawn_straight_into_the_target_and_are_as_large_as_it() {
    let gpu = Gpu::noop().unwrap();
    let target = target(&gpu, [64, 36], Format::Bgra8UnormSrgb, TextureUsages::RENDER_ATTACHMENT);
    let executed = record(&gpu, Aov::Color, &target).unwrap();
    let plan = executed.plan();
    let last = *plan.order().last().unwrap();
    assert_eq!(plan.pass(last).name, "fxaa");
    let reasons: Vec<_> = plan.accesses(last).filter_map(|access| access.ops).collect();
    assert_eq!(reasons[0].store_reason, StoreReason::Imported);
    let lit = plan.resource(plan.find_resource("lit").unwrap());
    assert_eq!(lit.desc.bytes(), 64 * 36 * 8);
}

#[test]
fn colours_are_not_drawn_into_a_format_that_does_not_encode_them() {
    let gpu = Gpu::noop().unwrap();
    let target = target(&gpu, [64, 36], Format::Bgra8Unorm, TextureUsages::RENDER_ATTACHMENT);
    let error = record(&gpu, Aov::Color, &target).err().unwrap();
    assert!(error.to_string().contains("Bgra8Unorm"), "{error}");
}

#[test]
fn data_is_copied_into_a_target_that_fits_and_into_no_other() {
    let gpu = Gpu::noop().unwrap();
    let fits = target(&gpu, [64, 36], Format::Rgba8Unorm, TextureUsages::COPY_DST);
    let executed = record(&gpu, Aov::Normal, &fits).unwrap();
    let last = executed.plan().order().last().map(|&id| executed.plan().pass(id).name);
    assert_eq!(last, Some("copy to target"));
    let other = target(&gpu, [64, 36], Format::Bgra8UnormSrgb, TextureUsages::COPY_DST);
    assert!(record(&gpu, Aov::Normal, &other).is_err());
}

#[test]
fn equal_views_share_a_plan_and_other_sizes_do_not_analyse_the_frame_again() {
    let gpu = Gpu::noop().unwrap();
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let mut renderer = Renderer::new(&gpu, scene, &camera, Aov::Color).unwrap();
    let shadows = ShadowSettings::default().without_cache();
    let options = ViewOptions { camera, size_px: [640, 360], shadows };
    let mut record = |size_px| {
        let target = target(&gpu, size_px, Format::Bgra8UnormSrgb, TextureUsages::RENDER_ATTACHMENT);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let executed = renderer.record(&gpu, &mut encoder, &target, &options).unwrap();
        gpu.queue.submit([encoder.finish()]);
        (executed.shared_plan(), renderer.graph().plan_counts())
    };
    let (first, _) = record([640, 360]);
    // The target is another texture in each frame, as a surface's is.
    let (second, counts) = record([640, 360]);
    assert!(Arc::ptr_eq(&first, &second));
    assert_eq!((counts.compiled, counts.resized, counts.reused), (1, 0, 1));
    let (other, counts) = record([320, 180]);
    assert_eq!(other.order(), first.order());
    assert_eq!((counts.compiled, counts.resized, counts.reused), (1, 1, 1));
    let (back, counts) = record([640, 360]);
    assert!(Arc::ptr_eq(&first, &back));
    assert_eq!((counts.compiled, counts.resized, counts.reused), (1, 1, 2));
}
