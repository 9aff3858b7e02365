//! Uploads the demo scene to a device that validates everything and draws nothing.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use glam::{DAffine3, DVec3};

use shadowgraph_samples::demo::demo_scene;
use shadowgraph_scene::gpu::*;
use shadowgraph_scene::{
    AlphaMode, CasterMode, EditError, Error, Instance, InstanceKey, MaterialKey, Scene, origin_near,
};

/// Creates a device with wgpu's default limits and these features.
fn device(required_features: wgpu::Features) -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor { required_features, ..wgpu::DeviceDescriptor::default() })
}

/// Runs `work` and panics with the validation error, if there is one.
fn without_validation_errors<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> T {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    match std::pin::pin!(scope.pop()).as_mut().poll(&mut context) {
        std::task::Poll::Ready(None) => result,
        std::task::Poll::Ready(Some(error)) => panic!("{error}"),
        std::task::Poll::Pending => panic!("the device did not answer"),
    }
}

/// The demo scene with three more instances: blended, mirrored, and mirrored and double-sided.
fn varied_scene() -> Scene {
    let mut scene = demo_scene();
    let mut glass = scene.materials().next().unwrap().1.clone();
    glass.alpha = AlphaMode::Blend;
    let glass = scene.insert_material(glass).unwrap();
    let [second, third] = [1, 2].map(|n| scene.instances().nth(n).unwrap().0);
    let (fence, _) = scene.instances().find(|(_, instance)| instance.name == "fence panel").unwrap();
    let mut add = |like: InstanceKey, material: Option<MaterialKey>, mirror: f64| {
        let mut instance = scene.instance(like).unwrap().clone();
        instance.material = material.unwrap_or(instance.material);
        instance.world_from_local *= DAffine3::from_scale(DVec3::new(mirror, 1.0, 1.0));
        scene.insert_instance(instance).unwrap();
    };
    add(second, None, -1.0);
    add(fence, None, -1.0);
    add(third, Some(glass), 1.0);
    scene
}

fn all(scene: &Scene) -> Vec<u32> {
    (0..scene.instances().len() as u32).collect()
}

/// Draws everything into a depth texture, at the second of two views in a buffer.
fn draw_depth(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    gpu: &GpuScene,
    draws: &DrawList,
    (pipelines, casters): (&DepthPipelines, &CasterPipelines),
    format: wgpu::TextureFormat,
) {
    let views = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("views"),
        size: 512,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let binding = wgpu::BufferBinding { buffer: &views, offset: 0, size: std::num::NonZeroU64::new(256) };
    let view_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("view"),
        layout: pipelines.view_layout(),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(binding) }],
    });
    let depth = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depth"),
        size: wgpu::Extent3d { width: 64, height: 64, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_bind_group(0, &view_group, &[256]);
    gpu.draw(&mut pass, &draws.solid, &|draw| Some(pipelines.get(draw.key)));
    gpu.draw(&mut pass, &draws.blend, &|draw| Some(pipelines.get(draw.key)));
    for mode in [CasterMode::On, CasterMode::Clip, CasterMode::Dither, CasterMode::Off] {
        gpu.draw(&mut pass, draws.iter(), &|_| casters.get(mode));
    }
    drop(pass);
    queue.submit([encoder.finish()]);
}

#[test]
fn demo_scene_draws_depth_without_validation_errors_on_every_path() {
    use wgpu::TextureFormat::{Depth16Unorm, Depth32Float};
    let scene = varied_scene();
    for features in [wgpu::Features::empty(), wgpu::Features::DEPTH_CLIP_CONTROL] {
        let (device, queue) = device(features);
        let gpu = without_validation_errors(&device, || {
            GpuScene::new(&device, &queue, &scene, DVec3::ZERO).unwrap()
        });
        let draws = gpu.draw_list(&all(&scene), DVec3::ZERO);
        for (format, clamp_near, emulate_clamp) in
            [(Depth32Float, false, false), (Depth32Float, true, false), (Depth16Unorm, true, true)]
        {
            without_validation_errors(&device, || {
                let target = DepthTarget {
                    format,
                    clamp_near,
                    slope_bias: -1.5,
                    emulate_clamp,
                    ..DepthTarget::default()
                };
                let pipelines = DepthPipelines::new(&device, gpu.layouts(), &target).unwrap();
                let casters = CasterPipelines::new(&device, gpu.layouts(), &target).unwrap();
                draw_depth(&device, &queue, &gpu, &draws, (&pipelines, &casters), format);
            });
        }
    }
}

#[test]
fn a_draw_list_has_every_instance_once_with_the_key_of_its_material() {
    let (device, queue) = device(wgpu::Features::empty());
    let scene = varied_scene();
    let gpu = GpuScene::new(&device, &queue, &scene, DVec3::ZERO).unwrap();
    let draws = gpu.draw_list(&all(&scene), DVec3::ZERO);
    let mut instances: Vec<u32> = draws.iter().map(|draw| draw.instance).collect();
    instances.sort_unstable();
    assert_eq!(instances, all(&scene));
    assert_eq!(draws.blend.len(), 1);
    assert!(draws.solid.is_sorted());
    assert_eq!(draws.solid.iter().filter(|draw| draw.key.mirrored).count(), 2);
    assert!(draws.solid.iter().any(|draw| draw.key.alpha == AlphaKey::Mask && draw.key.double_sided));
    assert_eq!(gpu.bounds().len(), scene.instances().len());
    assert_eq!(gpu.draw_list(&[3, 100_000], DVec3::ZERO).iter().count(), 1);
}

#[test]
fn the_origin_moves_without_validation_errors_and_an_empty_scene_uploads() {
    let (device, queue) = device(wgpu::Features::empty());
    let scene = demo_scene();
    without_validation_errors(&device, || {
        let mut gpu = GpuScene::new(&device, &queue, &scene, DVec3::ZERO).unwrap();
        gpu.set_origin(&device, &queue, &scene, origin_near(DVec3::new(5000.0, 0.0, 0.0))).unwrap();
        assert_eq!(gpu.origin_world(), DVec3::new(5120.0, 0.0, 0.0));
        let empty = GpuScene::new(&device, &queue, &Scene::default(), DVec3::ZERO).unwrap();
        let pipelines = DepthPipelines::new(&device, empty.layouts(), &DepthTarget::default()).unwrap();
        let format = DepthTarget::default().format;
        let casters = CasterPipelines::new(&device, empty.layouts(), &DepthTarget::default()).unwrap();
        draw_depth(&device, &queue, &empty, &DrawList::default(), (&pipelines, &casters), format);
        queue.submit([]);
    });
}

#[test]
fn the_error_of_a_scene_over_a_limit_names_the_limit() {
    let scene = demo_scene();
    let with = |required_limits: wgpu::Limits| {
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
        let (device, queue) = wgpu::Device::noop(&descriptor);
        match GpuScene::new(&device, &queue, &scene, DVec3::ZERO).err() {
            Some(Error::Limit { limit, .. }) => limit,
            other => panic!("{other:?}"),
        }
    };
    let limits = wgpu::Limits::default();
    assert_eq!(with(wgpu::Limits { max_buffer_size: 65_536, ..limits.clone() }), "max_buffer_size");
    let storage = wgpu::Limits { max_storage_buffer_binding_size: 1024, ..limits.clone() };
    assert_eq!(with(storage), "max_storage_buffer_binding_size");
    let textures = wgpu::Limits { max_texture_dimension_2d: 128, ..limits };
    assert_eq!(with(textures), "max_texture_dimension_2d");
}

#[test]
fn references_to_missing_meshes_materials_and_images_are_errors() {
    let mut scene = demo_scene();
    let plain = scene.instances().next().unwrap().1.clone();
    assert_eq!(plain.name, "plain");
    let mut scratch = scene.clone();
    let (mesh, material) =
        (scratch.mesh(plain.mesh).unwrap().clone(), scratch.material(plain.material).unwrap().clone());
    let (mesh, material) = (scratch.insert_mesh(mesh), scratch.insert_material(material).unwrap());
    let before = scene.clone();
    let (key, _) = scene.instances().next().unwrap();
    // The keys of another scene.
    let error = scene.edit_instance(key, |instance| instance.mesh = mesh);
    assert_eq!(error, Err(EditError::StaleKey { kind: "mesh" }));
    let error = scene.edit_instance(key, |instance| instance.material = material);
    assert_eq!(error, Err(EditError::StaleKey { kind: "material" }));
    let error = scene.insert_instance(Instance { mesh, ..plain });
    assert!(error.unwrap_err().to_string().contains("the mesh does not exist"));
    // What others refer to cannot be removed.
    let (image, name) = scene.images().nth(1).map(|(key, image)| (key, image.name.clone())).unwrap();
    let text = scene.remove_image(image).unwrap_err().to_string();
    assert!(text.contains(&format!("image \"{name}\" is used by")), "{text}");
    assert_eq!(scene, before);
}

#[test]
fn a_copy_of_a_scene_that_is_updated_with_another_scene_is_an_error() {
    let (device, queue) = device(wgpu::Features::empty());
    let mut scene = demo_scene();
    let mut gpu = GpuScene::new(&device, &queue, &Scene::default(), DVec3::ZERO).unwrap();
    let mut changes = scene.take_changes();
    changes.meshes.clear();
    let error = gpu.update(&device, &queue, &scene, &changes);
    assert!(matches!(error, Err(Error::Inconsistent { what: "mesh" })), "{error:?}");
}
