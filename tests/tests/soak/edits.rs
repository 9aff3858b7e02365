//! Frames of one scene with random edits.

use super::{ALONE, FRAME_LIMIT, from_env, is_flat, memory_mib, watch};
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::shadows::{PCF, RAYTRACED, TechniqueKind};
use shadowgraph::{Gpu, Renderer, ViewOptions, wgpu};
use shadowgraph_samples::demo::demo_scene;
use shadowgraph_tests::random::Random;
use shadowgraph_tests::{edits, skip};

/// The default number of frames.
const FRAMES: u32 = 400;

/// The largest number of frames on a software driver: Mesa's compiles shaders again for new values of uniforms and keeps all their code,
/// up to 100 MiB a frame.
const DRAWN_FRAMES: u32 = 40;

/// Returns an instance with the noop device, whose resources can be counted.
fn noop() -> (wgpu::Instance, Gpu) {
    let noop = wgpu::NoopBackendOptions { enable: true, ..Default::default() };
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions { noop, ..Default::default() },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::NOOP));
    let gpu = Gpu::from_adapter(&adapters[0]).unwrap();
    (instance, gpu)
}

/// Returns the number of resources that an instance has.
fn resources(instance: &wgpu::Instance) -> u64 {
    let hub = instance.generate_report().unwrap().hub;
    let kinds =
        [hub.buffers, hub.textures, hub.texture_views, hub.samplers, hub.bind_groups, hub.render_pipelines];
    kinds.iter().map(|kind| kind.num_kept_from_user as u64).sum()
}

/// Draws frames of one renderer with up to three edits before each, and returns the largest value of each of `values` in each quarter.
fn peaks<const N: usize>(
    gpu: &Gpu,
    technique: TechniqueKind,
    frames: u32,
    values: impl Fn() -> [u64; N],
) -> [[u64; 4]; N] {
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let mut renderer = Renderer::with_config(gpu, scene, &camera, Aov::Color, technique).unwrap();
    let mut options = ViewOptions { camera, size_px: [64, 36], shadows: Default::default() };
    options.shadows.cascades.map_size_px = 256;
    options.shadows.atlas.map_size_px = 512;
    let mut random = Random::new(from_env("SHADOWGRAPH_SOAK_SEED", 0));
    let watched = watch(FRAME_LIMIT);
    let mut peaks = [[0; 4]; N];
    for frame in 0..frames {
        watched.send(format!("frame {frame}, {}", technique.name)).unwrap();
        for _ in 0..random.below(4) {
            edits::edit(renderer.scene_mut(), &mut random).unwrap();
        }
        renderer.draw(gpu, &options).unwrap();
        for (peaks, value) in peaks.iter_mut().zip(values()) {
            let peak = &mut peaks[(4 * frame / frames) as usize];
            *peak = value.max(*peak);
        }
    }
    peaks
}

#[test]
fn random_edits_of_a_scene_leak_no_memory() {
    let _alone = ALONE.lock();
    let frames = from_env("SHADOWGRAPH_SOAK", FRAMES);
    for technique in [PCF, RAYTRACED] {
        let (instance, gpu) = noop();
        let values = || [memory_mib().unwrap_or_default(), resources(&instance)];
        let [memory, resources] = peaks(&gpu, technique, frames, values);
        let text = format!("{memory:?} MiB of the process and {resources:?} resources of the device");
        println!("soak: {}: at most {text} by quarter of {frames} frames with edits", technique.name);
        assert!(is_flat(memory, 16) && is_flat(resources, 64), "{}: {text}", technique.name);
        assert!(resources[0] > 0, "{text}");
    }

    // After the noop device: Mesa's memory would hide a leak of the process.
    let gpu = match Gpu::open(&AdapterChoice::Cpu) {
        Ok(gpu) => gpu,
        Err(error) => return skip("soak", &error.to_string()),
    };
    let device = || [gpu.device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes)];
    let frames = frames.min(DRAWN_FRAMES);
    let [bytes] = peaks(&gpu, PCF, frames, device);
    println!("soak: at most {bytes:?} bytes of the device by quarter of {frames} frames with edits");
    assert!(is_flat(bytes, 1 << 20) && bytes[0] > 0, "{bytes:?} bytes");
}
