//! How pages of `virtual` store depths, on the GPU.

use crate::stage::gpu;
use shadowgraph::core::wgpu::util::DeviceExt;
use shadowgraph::shaders::{ModuleSource, compose_source};
use shadowgraph::{Gpu, wgpu};
use shadowgraph_tests::random::Random;
use std::borrow::Cow;

/// Finds, for a page with casters from x to y (z: the depth at an infinite distance, 0 for a linear projection) and the depth w: the step that a
/// caster is stored at, its depth, the step that a receiver at the same depth is compared with, and the width of a step.
const SHADER: &str = "
#import shadowgraph::shadows::page_depths::{compared_step, depth_of_step, page_depths, step_width, stored_step}

@group(0) @binding(0) var<storage, read> cases: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4f>;

@compute @workgroup_size(64)
fn cs_main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&cases) {
        let own = cases[id.x];
        let depths = page_depths(own.x, own.y, own.z < 0.0, own.z);
        let step = stored_step(depths, own.w);
        results[id.x] = vec4f(step, depth_of_step(depths, step), compared_step(depths, own.w), step_width(depths, own.w));
    }
}
";

fn evaluated(gpu: &Gpu, cases: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let Gpu { device, queue, .. } = gpu;
    let module = compose_source(&ModuleSource::new("page_depths_test.wgsl", SHADER), &[]).unwrap();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(cases),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let buffer = |usage| {
        let size = input.size();
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let output = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let entries = [(0, &input), (1, &output)]
        .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
    let layout = &pipeline.get_bind_group_layout(0);
    let group =
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups((cases.len() as u32).div_ceil(64), 1, 1);
    }
    encoder.copy_buffer_to_buffer(&output, 0, &read, 0, None);
    queue.submit([encoder.finish()]);
    read.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = read.get_mapped_range(..).unwrap();
    bytemuck::cast_slice(&bytes).to_vec()
}

#[test]
fn depths_of_pages_are_rounded_away_from_the_light_by_less_than_a_step() {
    let Some(gpu) = gpu() else { return };
    let random = &mut Random::new(5);
    let mut cases = Vec::new();
    for page in 0..400 {
        // Of a directional light, or of a spot light from 5 cm to 40 m, where depth is 1 at 5 cm and 0 at 40 m.
        let at_infinity = if page % 2 == 0 { 0.0 } else { -0.05 / 39.95 };
        let depth = |random: &mut Random| match page % 2 {
            0 => random.between(0.0, 1.0),
            _ => (0.05 * 40.0 / 39.95) / random.between(0.05, 40.0) + at_infinity,
        };
        let (a, b) = (depth(random), depth(random));
        let thickness = [1.0, 1e-2, 1e-5][random.below(3) as usize];
        let (first, last) = (a.min(b), a.min(b) + (a.max(b) - a.min(b)) * thickness);
        let inner = (0..50).map(|_| random.between(first, last));
        for depth in [first, last].into_iter().chain(inner) {
            let depth = (depth as f32).clamp(first as f32, last as f32);
            cases.push([first as f32, last as f32, at_infinity as f32, depth]);
        }
    }
    let results = evaluated(gpu, &cases);
    let mut most = 0.0f32;
    for (case, result) in cases.iter().zip(&results) {
        let [step, stored, compared, width] = *result;
        let said = || format!("{case:?}: {result:?}");
        assert!(step == step.round() && (1.0..=65535.0).contains(&step), "{}", said());
        // It is lit, and it would be even if comparisons were off by an eighth of a step.
        assert!(compared >= step + 0.125 || compared == 65535.0, "{}", said());
        assert!(compared - step < 1.5, "{}", said());
        let rounding = case[3] * f32::EPSILON * 2.0 + 0.02 * width;
        let error = case[3] - stored;
        assert!(error >= -rounding && error <= 1.25 * width + rounding, "{}", said());
        most = most.max(error / width);
    }
    assert!(most > 0.9, "rounding is seen");

    // Two steps above or below the caster, a receiver is lit or in shadow; below the farthest caster of the page always.
    let moved = |steps: f32| {
        let cases = cases.iter().zip(&results).map(|(case, result)| {
            let [first, last, at_infinity, depth] = *case;
            [first, last, at_infinity, depth + steps * result[3]]
        });
        cases.collect::<Vec<_>>()
    };
    for (steps, is_lit) in [(2.0, true), (-2.0, false)] {
        for (result, caster) in evaluated(gpu, &moved(steps)).iter().zip(&results) {
            assert!((result[2] >= caster[0]) == is_lit, "{steps}: {result:?} {caster:?}");
        }
    }
}
