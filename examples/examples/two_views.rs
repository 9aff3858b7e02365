//! Two cameras in one frame, such as a split screen or two eyes: each has its own shadow maps, and the graph plans both together.
//!
//! `cargo run -p shadowgraph-examples --example two_views` writes out/two_views.png.

use glam::DVec3;
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::scene::demo::demo_scene;
use shadowgraph::scene::{Camera, Projection};
use shadowgraph::{Gpu, Renderer, ViewOptions};

const SIZE_PX: [u32; 2] = [320, 360];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let scene = demo_scene();
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
    let view = |eye: DVec3, target: DVec3| {
        let camera = Camera::look_at(eye, target, DVec3::Y, projection);
        ViewOptions { camera, size_px: SIZE_PX, shadows: Default::default() }
    };
    let left = view(DVec3::new(-6.0, 2.5, 16.0), DVec3::new(-2.0, 1.5, 0.0));
    let right = view(DVec3::new(9.0, 7.0, 14.0), DVec3::new(0.0, 1.0, 0.0));

    let mut renderer = Renderer::new(&gpu, scene, &left.camera, Aov::Color)?;
    let pictures = renderer.draw_views(&gpu, &[left, right])?;

    // Side by side, row by row.
    let [width, height] = SIZE_PX;
    let row = |picture: &shadowgraph::Picture, y: u32| {
        let bytes = width as usize * 4;
        picture.rgba8[y as usize * bytes..][..bytes].to_vec()
    };
    let both: Vec<u8> =
        (0..height).flat_map(|y| pictures.iter().flat_map(move |picture| row(picture, y))).collect();
    Ok(write_png("out/two_views.png".as_ref(), 2 * width, height, Pixels::Rgba, &both)?)
}
