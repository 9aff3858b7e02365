#![allow(warnings, clippy::all)]
use glam::*; use shadowgraph_scene::{*, gpu::*, demo::demo_scene};
fn block<F: std::future::Future>(f: F) -> F::Output { let mut f = std::pin::pin!(f); let mut c = std::task::Context::from_waker(std::task::Waker::noop()); loop { if let std::task::Poll::Ready(v) = f.as_mut().poll(&mut c) { return v } } }
fn main() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor { backends: wgpu::Backends::VULKAN, ..wgpu::InstanceDescriptor::new_without_display_handle() });
    let adapter = block(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).unwrap();
    println!("{:?}", adapter.get_info().name);
    let (device, queue) = block(adapter.request_device(&wgpu::DeviceDescriptor { required_features: wgpu::Features::DEPTH_CLIP_CONTROL, ..Default::default() })).unwrap();
    let t = std::time::Instant::now(); let scene = demo_scene(); println!("scene {:?}", t.elapsed());
    let t = std::time::Instant::now(); let gpu = GpuScene::new(&device, &queue, &scene, DVec3::ZERO).unwrap(); println!("upload {:?}", t.elapsed());
    let all: Vec<u32> = (0..scene.instances.len() as u32).collect();
    let t = std::time::Instant::now(); let list = gpu.draw_list(&all, scene.cameras[0].position_world()); println!("list {:?} {}", t.elapsed(), list.solid.len());
    let (w, h) = (1024u32, 576u32);
    let render = |m: DMat4, target: DepthTarget| -> Vec<f32> {
        let p = DepthPipelines::new(&device, gpu.layouts(), &target).unwrap();
        let buf = device.create_buffer(&wgpu::BufferDescriptor { label: None, size: 512, usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST, mapped_at_creation: false });
        queue.write_buffer(&buf, 256, bytemuck::cast_slice(&m.as_mat4().to_cols_array()));
        let g = device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: p.view_layout(), entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &buf, offset: 0, size: std::num::NonZeroU64::new(64) }) }] });
        let tex = device.create_texture(&wgpu::TextureDescriptor { label: None, size: wgpu::Extent3d { width: w, height: h, depth_or_array_layers: 1 }, mip_level_count: 1, sample_count: 1, dimension: wgpu::TextureDimension::D2, format: wgpu::TextureFormat::Depth32Float, usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC, view_formats: &[] });
        let out = device.create_buffer(&wgpu::BufferDescriptor { label: None, size: (w * h * 4) as u64, usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST, mapped_at_creation: false });
        let t = std::time::Instant::now();
        let mut e = device.create_command_encoder(&Default::default());
        { let v = tex.create_view(&Default::default());
          let mut pass = e.begin_render_pass(&wgpu::RenderPassDescriptor { depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment { view: &v, depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }), stencil_ops: None }), ..Default::default() });
          pass.set_bind_group(0, &g, &[256]); gpu.draw(&mut pass, &list.solid, false, &|k| p.get(k)); }
        e.copy_texture_to_buffer(tex.as_image_copy(), wgpu::TexelCopyBufferInfo { buffer: &out, layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(w * 4), rows_per_image: None } }, tex.size());
        queue.submit([e.finish()]);
        out.slice(..).map_async(wgpu::MapMode::Read, |r| r.unwrap()); device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        println!("draw {:?}", t.elapsed());
        let v = out.slice(..).get_mapped_range().unwrap(); bytemuck::cast_slice(&v[..]).to_vec()
    };
    let cam = &scene.cameras[1]; let m = cam.clip_from_view(w as f64 / h as f64) * cam.view_from_world();
    let d = render(m, DepthTarget::default());
    let img: Vec<u8> = d.iter().map(|d| if *d == 0.0 { 255 } else { ((1.0 - (0.1 / d / 20.0).min(1.0)) * 255.0) as u8 }).collect();
    image::save_buffer("/tmp/preview/depth.png", &img, w, h, image::ColorType::L8).unwrap();
    // sun view, near plane inside the scene
    let sun = Camera::look_at(DVec3::new(-4.0, 4.0, 2.0), DVec3::new(0.0, 0.0, 0.5), DVec3::Y, Projection::Orthographic { half_width: 16.0, half_height: 9.0, near: 0.0, far: 40.0 });
    let m = sun.clip_from_view(w as f64 / h as f64) * sun.view_from_world();
    let t0 = DepthTarget { clamp_near: true, slope_bias: -1.0, ..Default::default() };
    let a = render(m, t0); let b = render(m, DepthTarget { emulate_clamp: true, ..t0 }); let c = render(m, DepthTarget { clamp_near: false, ..t0 });
    let differ = |a: &[f32], b: &[f32]| { let mut v: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect(); v.sort_by(f32::total_cmp); (v[v.len() - 1], v[v.len() * 999 / 1000], v[v.len() / 2], v.iter().filter(|d| **d > 1e-4).count()) };
    println!("device clamp / emulated {:?}; clamp / none {:?}; at 1: {} {} {}", differ(&a, &b), differ(&a, &c), a.iter().filter(|d| **d == 1.0).count(), b.iter().filter(|d| **d == 1.0).count(), c.iter().filter(|d| **d == 1.0).count());
    let img: Vec<u8> = b.iter().map(|d| (d * 255.0) as u8).collect();
    image::save_buffer("/tmp/preview/sun.png", &img, w, h, image::ColorType::L8).unwrap();
}
