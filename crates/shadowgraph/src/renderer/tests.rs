#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use super::*;
use shadowgraph_core::StoreReason;
use shadowgraph_scene::demo::demo_scene;
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
    let last = plan.live_passes().last().map(|id| plan.pass(id)).unwrap();
    assert_eq!(last.name, "tonemap");
    let reasons: Vec<_> = last.accesses.iter().filter_map(|access| access.ops).collect();
    assert_eq!(reasons[0].store_reason, StoreReason::Imported);
    let lit = plan.resources.iter().find(|resource| resource.name == "lit").unwrap();
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
    let last = executed.plan().live_passes().last().map(|id| &executed.plan().pass(id).name);
    assert_eq!(last.map(String::as_str), Some("copy to target"));
    let other = target(&gpu, [64, 36], Format::Bgra8UnormSrgb, TextureUsages::COPY_DST);
    assert!(record(&gpu, Aov::Normal, &other).is_err());
}
