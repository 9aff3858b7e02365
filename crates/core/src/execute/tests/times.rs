//! Times of passes.

use super::gpu::{Gpu, square};
use crate::test_device::{drawing_with, valid};
use crate::{Contents, Frame, Graph, PassTime, Timer};
use wgpu::Features;

/// Runs two passes that are merged, a compute pass in a node, and a copy.
fn frame(graph: &Graph) -> Frame<'static> {
    let mut frame = graph.frame();
    let mut color = frame.create_texture("color", square(64));
    frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0; 4]));
    let mut pass = frame.render_pass("draw");
    pass.color(&mut color, Contents::Preserve);
    pass.body(|_| {
        std::thread::sleep(std::time::Duration::from_millis(2));
        Ok(())
    });
    frame.node("effects", |frame| {
        let mut pass = frame.compute_pass("think");
        pass.sample(&color);
        pass.keep();
        pass.body(|_| Ok(()));
    });
    let mut copy = frame.create_texture("copy", square(64));
    frame.copy_pass("copy").texture(&color, &mut copy);
    frame.export_texture(&copy);
    frame
}

fn times(gpu: &Gpu) -> Vec<PassTime> {
    let (mut graph, mut timer) = (Graph::new(), Timer::new());
    let mut times = Vec::new();
    // One timer can be used for every frame.
    for _ in 0..2 {
        let frame = frame(&graph);
        let executed = valid(&gpu.device, || {
            let mut encoder = gpu.encoder();
            let compiled = graph.compile(frame).unwrap();
            let executed = compiled.execute_timed(&mut graph, &gpu.device, &mut encoder, &mut timer).unwrap();
            gpu.queue.submit([encoder.finish()]);
            executed
        });
        assert_eq!(executed.plan().steps().len(), 3);
        times = timer.read(&gpu.device, &gpu.queue).unwrap();
    }
    times
}

#[test]
fn every_pass_has_a_cpu_time_also_without_timestamps() {
    for gpu in Gpu::all() {
        let times = times(&gpu);
        let names: Vec<_> = times.iter().map(|time| (time.pass.as_str(), time.node.as_str())).collect();
        let expected = [("clear", ""), ("draw", ""), ("effects/think", "effects"), ("copy", "")];
        assert_eq!(names, expected);
        assert!(times[1].cpu_ms >= 2.0 && times[2].cpu_ms < 2.0, "{times:?}");
        assert!(times.iter().all(|time| (time.gpu_ms, time.shared_by) == (None, 1)), "{times:?}");
    }
}

#[test]
fn merged_passes_share_a_gpu_time_and_say_so() {
    let features = Features::TIMESTAMP_QUERY;
    let Some(gpu) = drawing_with(features).map(|device| Gpu::new(device, true)) else { return };
    let times = times(&gpu);
    assert_eq!(times.iter().map(|time| time.shared_by).collect::<Vec<_>>(), [2, 2, 1, 1]);
    assert!(times[0].gpu_ms.unwrap() >= 0.0, "{times:?}");
    assert_eq!(times[0].gpu_ms, times[1].gpu_ms);
    assert!(times[2].gpu_ms.is_some(), "{times:?}");
    assert_eq!(times[3].gpu_ms, None, "this device writes no timestamps between passes");
}

#[test]
fn merged_passes_are_measured_separately_with_timestamps_inside_passes() {
    let features = Features::TIMESTAMP_QUERY
        | Features::TIMESTAMP_QUERY_INSIDE_PASSES
        | Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let Some(gpu) = drawing_with(features).map(|device| Gpu::new(device, true)) else { return };
    let times = times(&gpu);
    assert!(times.iter().all(|time| time.shared_by == 1 && time.gpu_ms.is_some()), "{times:?}");
}

#[test]
fn timers_of_any_device_are_valid_on_noop() {
    let inside = Features::TIMESTAMP_QUERY_INSIDE_PASSES;
    let encoders = Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    for more in [Features::empty(), inside, encoders, inside | encoders] {
        let required_features = Features::TIMESTAMP_QUERY | more;
        let device = wgpu::Device::noop(&wgpu::DeviceDescriptor { required_features, ..Default::default() });
        let times = times(&Gpu::new(device, false));
        let merged = if more.contains(inside) { 1 } else { 2 };
        assert_eq!(times.iter().map(|time| time.shared_by).collect::<Vec<_>>(), [merged, merged, 1, 1]);
    }
}

#[test]
fn an_empty_frame_has_no_times() {
    let required_features = Features::TIMESTAMP_QUERY;
    let device = wgpu::Device::noop(&wgpu::DeviceDescriptor { required_features, ..Default::default() });
    let gpu = Gpu::new(device, false);
    let (mut graph, mut timer) = (Graph::new(), Timer::new());
    let frame = graph.frame();
    let compiled = graph.compile(frame).unwrap();
    compiled.execute_timed(&mut graph, &gpu.device, &mut gpu.encoder(), &mut timer).unwrap();
    assert_eq!(timer.read(&gpu.device, &gpu.queue).unwrap(), []);
}
