//! Devices whose indirect draws cannot begin with another instance than the first.

use super::{Random, boxes, transform};
use crate::stage::gpu;
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Light, Projection};
use shadowgraph::{Culling, Gpu, Pipeline, RenderConfig, Renderer, ViewOptions, wgpu};

/// Opens a device like another one, without the feature.
fn gpu_without_first_instance(like: &Gpu) -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter = adapters.into_iter().find(|adapter| adapter.get_info() == like.adapter).unwrap();
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: like.device.features() - wgpu::Features::INDIRECT_FIRST_INSTANCE,
        required_limits: like.device.limits(),
        ..Default::default()
    }))
    .unwrap();
    Gpu { device, queue, adapter: adapter.get_info() }
}

#[test]
fn images_are_those_of_culling_on_the_cpu_without_indirect_first_instance() {
    let Some(gpu) = gpu() else { return };
    let gpu = &gpu_without_first_instance(gpu);
    let random = &mut Random(11);
    let mut scene = boxes(random, 400);
    scene.insert_light(Light::sun(DVec3::new(0.4, -1.0, 0.3), 40_000.0));
    let eye = DVec3::new(20.0, 9.0, 25.0);
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
    for samples in [1, 4] {
        let mut renderers = [Culling::Cpu, Culling::Gpu].map(|culling| {
            let config = RenderConfig { culling, samples, ..Pipeline::minimal_lit().into() };
            let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection);
            Renderer::with_config(gpu, scene.clone(), &camera, Aov::Color, config).unwrap()
        });
        let mut images = Vec::new();
        for frame in 0..4 {
            let eye = eye + DVec3::new(-5.0, 0.5, -3.0) * f64::from(frame);
            let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection);
            let options = ViewOptions { camera, size_px: [192, 108], shadows: Default::default() };
            let moved = transform(random);
            let [by_cpu, by_gpu] = renderers.each_mut().map(|renderer| {
                let (key, _) = renderer.scene().instances().nth(7).unwrap();
                renderer.scene_mut().move_instance(key, moved).unwrap();
                let drawn = renderer.draw(gpu, &options).unwrap();
                assert_eq!(drawn.counts.culled.is_empty(), !renderer.casters().culls_on_gpu());
                drawn.image
            });
            assert!(by_cpu.rgba8 == by_gpu.rgba8, "{samples} samples, frame {frame}");
            images.push(by_gpu.rgba8);
        }
        images.dedup();
        assert_eq!(images.len(), 4);
    }
}
