//! Devices that are destroyed, and devices without memory.

use super::gpu::Gpu;
use crate::test_device::valid;
use crate::{
    Contents, Error, Format, Frame, Graph, ReadBackRequest, Subresource, TextureDesc, device_is_lost,
};

/// Declares a cleared square that is read back.
fn square(graph: &Graph) -> (Frame<'static>, ReadBackRequest) {
    let mut frame = graph.frame();
    let mut color = frame.create_texture("color", TextureDesc::d2(16, 16, Format::Rgba8Unorm));
    frame.render_pass("clear").color(&mut color, Contents::clear_color([1.0, 0.0, 0.0, 1.0]));
    let request = frame.read_back_texture(&color, Subresource::FULL);
    (frame, request)
}

/// Moment at which a device is destroyed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Moment {
    BeforeTheEncoder,
    BeforeRecording,
    BeforeSubmitting,
    BeforeWaiting,
    Never,
}

/// Draws the square, and destroys the device at that moment.
fn draw(gpu: &Gpu, graph: &mut Graph, destroyed: Moment) -> Result<Vec<u8>, Error> {
    let at = |moment| {
        if moment == destroyed {
            gpu.device.destroy();
        }
    };
    let (frame, request) = square(graph);
    at(Moment::BeforeTheEncoder);
    let mut encoder = gpu.encoder();
    at(Moment::BeforeRecording);
    let mut executed = graph.compile(frame)?.execute(graph, &gpu.device, &mut encoder)?;
    at(Moment::BeforeSubmitting);
    gpu.queue.submit([encoder.finish()]);
    at(Moment::BeforeWaiting);
    executed.read_back(request).unwrap().wait(&gpu.device)
}

#[test]
fn a_device_that_is_destroyed_at_any_moment_is_an_error_and_the_next_device_draws_the_same() {
    for make in [|| Some(Gpu::noop()), Gpu::drawing] {
        let Some(gpu) = make() else { continue };
        let expected = draw(&gpu, &mut Graph::new(), Moment::Never).unwrap();
        use Moment::{BeforeRecording, BeforeSubmitting, BeforeTheEncoder, BeforeWaiting};
        for moment in [BeforeTheEncoder, BeforeRecording, BeforeSubmitting, BeforeWaiting] {
            for drawn_before in [false, true] {
                let (gpu, mut graph) = (make().unwrap(), Graph::new());
                valid(&gpu.device, || {
                    if drawn_before {
                        assert_eq!(draw(&gpu, &mut graph, Moment::Never).unwrap(), expected);
                    }
                    match draw(&gpu, &mut graph, moment) {
                        // The submission may have completed before.
                        Ok(bytes) => assert!(moment == BeforeWaiting && bytes == expected, "{moment:?}"),
                        Err(error) => assert_eq!(error, Error::DeviceLost, "{moment:?}"),
                    }
                    assert!(device_is_lost(&gpu.device));
                    assert_eq!(draw(&gpu, &mut graph, Moment::Never), Err(Error::DeviceLost), "{moment:?}");
                });
            }
        }
        assert!(!device_is_lost(&gpu.device));
    }
}

#[test]
fn a_body_that_fails_on_a_lost_device_is_reported_as_a_lost_device() {
    let (gpu, mut graph) = (Gpu::noop(), Graph::new());
    let mut frame = graph.frame();
    let mut pass = frame.encoder_pass("draw");
    pass.keep();
    pass.body(|_| {
        gpu.device.destroy();
        Err(Error::body("no paint"))
    });
    let failed = graph.compile(frame).unwrap().execute(&mut graph, &gpu.device, &mut gpu.encoder());
    assert_eq!(failed.err(), Some(Error::DeviceLost));
}

#[test]
fn a_graph_that_ran_out_of_memory_evicts_and_draws_what_fits() {
    let Some(gpu) = Gpu::drawing() else { return };
    let mut graph = Graph::new();
    // A quarter of a TiB: within the default limits, and beyond any device.
    let much = TextureDesc::d2(8192, 8192, Format::Rgba32Float).layers(256);
    let little = TextureDesc::d2(16, 16, Format::Rgba32Float);
    let frame = |graph: &Graph, desc| {
        let mut frame = graph.frame();
        for (name, desc) in [("little", little), ("much", desc)] {
            let mut texture = frame.create_texture(name, desc);
            let mut pass = frame.render_pass("clear");
            pass.subresource(Subresource::FULL.layer(0));
            pass.color(&mut texture, Contents::clear_color([0.0; 4]));
            pass.keep();
        }
        frame
    };
    let fits = frame(&graph, little);
    gpu.run(&mut graph, fits);
    let bytes = graph.bytes();
    let too_much = frame(&graph, much);
    let failed = gpu.try_run(&mut graph, too_much).err();
    assert_eq!(failed, Some(Error::OutOfMemory { resource: "much".into(), bytes: much.bytes() }));
    assert_eq!(graph.bytes(), 0);
    let fits = frame(&graph, little);
    gpu.run(&mut graph, fits);
    assert_eq!(graph.bytes(), bytes);
}
