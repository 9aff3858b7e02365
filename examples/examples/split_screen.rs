//! Two cameras in one frame, such as a split screen or two eyes. Each has its own shadow maps, and the graph plans both together.
//!
//! `cargo run -p shadowgraph-examples --example split_screen` writes out/split_screen.png; `-- --window` shows it.

use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Projection};
use shadowgraph::{Gpu, Renderer, ViewOptions, wgpu};
use shadowgraph_examples::{Canvas, Example, FORMAT, Failure, run_example};
use shadowgraph_samples::demo::demo_scene;
use std::process::ExitCode;

/// Eyes and targets of the two cameras.
const VIEWS: [[DVec3; 2]; 2] = [
    [DVec3::new(-6.0, 2.5, 16.0), DVec3::new(-2.0, 1.5, 0.0)],
    [DVec3::new(9.0, 7.0, 14.0), DVec3::new(0.0, 1.0, 0.0)],
];

struct SplitScreen {
    renderer: Renderer,
    views: [ViewOptions; 2],
}

impl Example for SplitScreen {
    const NAME: &'static str = "split_screen";

    fn new(gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
        let views = VIEWS.map(|[eye, target]| {
            let camera = Camera::look_at(eye, target, DVec3::Y, projection);
            ViewOptions { camera, size_px: [1, 1], shadows: Default::default() }
        });
        let renderer = Renderer::new(gpu, demo_scene(), &views[0].camera, Aov::Color)?;
        Ok(Self { renderer, views })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, .. }: Canvas<'_>) -> Result<(), Failure> {
        let size = wgpu::Extent3d { width: (target.width() / 2).max(1), ..target.size() };
        let halves = [(); 2].map(|()| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("half"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        });
        let [left, right] = &self.views;
        self.renderer.record_views(gpu, encoder, &[(&halves[0], left), (&halves[1], right)])?;
        for (half, x) in halves.iter().zip([0, target.width() - size.width]) {
            let origin = wgpu::Origin3d { x, ..Default::default() };
            let into = wgpu::TexelCopyTextureInfo { origin, ..target.as_image_copy() };
            encoder.copy_texture_to_texture(half.as_image_copy(), into, size);
        }
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<SplitScreen>()
}
