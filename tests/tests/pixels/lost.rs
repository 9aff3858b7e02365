//! Loss of the device during a frame.

use crate::stage::gpu;
use shadowgraph::core::{Error::DeviceLost, Frame};
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::pipelines::{PipelineInstance, PipelineOutput};
use shadowgraph::{BuildContext, Error, Gpu, Pipeline, RenderView, Renderer, ViewOptions, wgpu};
use shadowgraph_samples::demo::demo_scene;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// The forward pipeline with a pass in the middle of the frame that destroys the device in the last of `frames`.
struct Breaks {
    forward: Box<dyn PipelineInstance>,
    device: wgpu::Device,
    frames: Arc<AtomicU32>,
}

impl PipelineInstance for Breaks {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
    ) -> Result<PipelineOutput<'f>, Error> {
        let mut pass = frame.encoder_pass("break");
        pass.keep();
        pass.body(|_| {
            if self.frames.fetch_sub(1, Ordering::Relaxed) == 1 {
                self.device.destroy();
            }
            Ok(())
        });
        self.forward.add(frame, view)
    }
}

fn breaks(frames: u32) -> Pipeline {
    let frames = Arc::new(AtomicU32::new(frames));
    Pipeline::script("forward", move |context: &BuildContext<'_>| {
        let (forward, device) = (Pipeline::minimal_lit().build(context)?, context.device.clone());
        Ok(Box::new(Breaks { forward, device, frames: frames.clone() }))
    })
}

fn is_lost<T>(result: Result<T, Error>) -> bool {
    matches!(result, Err(Error::Graph(DeviceLost)))
}

#[test]
fn a_device_lost_during_a_frame_is_an_error_and_another_device_renders_the_same_image() {
    let Some(known) = gpu() else { return };
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let options = ViewOptions { camera, size_px: [128, 72], shadows: Default::default() };
    let make = |gpu: &Gpu, pipeline: Pipeline| {
        Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, pipeline)
    };
    let expected = make(known, Pipeline::minimal_lit()).unwrap().draw(known, &options).unwrap().image;

    let choice = AdapterChoice::Name(known.adapter.name.clone());
    for frames in [1, 3] {
        let mut gpu = Gpu::open(&choice).unwrap();
        let mut renderer = make(&gpu, breaks(frames)).unwrap();
        for _ in 1..frames {
            assert!(renderer.draw(&gpu, &options).unwrap().image == expected);
        }
        assert!(is_lost(renderer.draw(&gpu, &options)));
        assert!(is_lost(renderer.draw(&gpu, &options)), "it stays lost");
        assert!(is_lost(make(&gpu, Pipeline::minimal_lit())), "nothing is made on it");
        assert!(is_lost(renderer.recreate_on(&gpu)), "nothing is moved to it");

        gpu = Gpu::open(&choice).unwrap();
        renderer.recreate_on(&gpu).unwrap();
        let again = renderer.draw(&gpu, &options).unwrap().image;
        assert!(again == expected, "frames before: {frames}");
    }
}
