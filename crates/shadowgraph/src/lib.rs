//! A render-graph framework for wgpu whose shadow passes are nodes.
//!
//! - [`core`] is the graph: declare passes and what they read and write, compile, record. It has no concept of
//!   scenes or shadows.
//! - [`scene`] has cameras, lights, meshes and materials, and imports glTF.
//! - [`shadows`] has the shadow techniques and their contract, [`lighting`] the passes that consume them.
//! - This crate connects them: [`Renderer`] draws a scene with a pipeline of [`pipelines`], which is a file of nodes or a
//!   script with one call per node.
//!
//! ```
//! use shadowgraph::core::{Contents, Format, Frame, TextureDesc};
//!
//! let mut frame = Frame::new();
//! let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
//! frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0, 0.0, 0.0, 1.0]));
//! frame.export_texture(&color);
//! println!("{}", frame.compile()?.plan().to_text());
//! # Ok::<(), shadowgraph::core::Error>(())
//! ```
//!
//! This renders an image of a scene, on the device that [`Gpu::open`] opens:
//!
//! ```
//! use shadowgraph::glam::DVec3;
//! use shadowgraph::options::{AdapterChoice, Aov};
//! use shadowgraph::output::{Pixels, write_png};
//! use shadowgraph::scene::{Camera, Projection};
//! use shadowgraph::shadows::ShadowSettings;
//! use shadowgraph::{Gpu, Renderer, ViewOptions};
//! use shadowgraph_samples::demo::demo_scene;
//!
//! # fn example() -> Result<(), Box<dyn std::error::Error>> {
//! let gpu = Gpu::open(&AdapterChoice::Auto)?;
//! let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
//! let camera = Camera::look_at(DVec3::new(8.0, 4.0, 16.0), DVec3::Y, DVec3::Y, projection);
//! let mut renderer = Renderer::new(&gpu, demo_scene(), &camera, Aov::Color)?;
//! let shadows = ShadowSettings { distance_m: 80.0, ..ShadowSettings::default() };
//! let options = ViewOptions { camera, size_px: [640, 360], shadows };
//! let image = renderer.draw(&gpu, &options)?.image;
//! write_png("out.png".as_ref(), 640, 360, Pixels::Rgba, &image.rgba8)?;
//! # Ok(())
//! # }
//! ```

mod background;
mod build_context;
mod casters;
mod culling;
mod debug_blit;
mod error;
mod explain;
mod gpu;
#[cfg(feature = "inspect")]
pub mod inspect;
pub mod nodes;
pub mod options;
pub mod output;
pub mod pipelines;
pub mod recording;
mod registry;
mod render_config;
mod render_view;
mod rendered;
mod renderer;
mod replay;
pub mod ron_file;
mod scene_rays;
mod shadow_lines;
mod surfaces;
mod view_options;

pub use background::Background;
pub use build_context::BuildContext;
pub use casters::SceneCasters;
pub use culling::Culling;
pub use debug_blit::DebugBlit;
pub use error::Error;
pub use explain::{ExplainedShadow, ShadowExplainer, ShadowPoint};
pub use gpu::Gpu;
pub use pipelines::Pipeline;
pub use registry::Registry;
pub use render_config::RenderConfig;
pub use render_view::RenderView;
pub use rendered::{CulledView, FrameCounts, RenderedFrame, RenderedImage, shadow_ms};
pub use renderer::Renderer;
pub use renderer::aov::ViewOutput;
pub use renderer::counts::PendingCounts;
pub use replay::Replay;
pub use scene_rays::SceneRays;
pub use shadow_lines::{ShadowLines, ShadowLinesPass};
pub use surfaces::SurfaceDrawer;
pub use view_options::ViewOptions;

pub use glam;
pub use shadowgraph_core as core;
pub use shadowgraph_core::wgpu;
pub use shadowgraph_lighting as lighting;
pub use shadowgraph_scene as scene;
pub use shadowgraph_shaders as shaders;
pub use shadowgraph_shadows as shadows;

#[cfg(doctest)]
mod readme {
    #[doc = include_str!("../README.md")]
    mod own {}
    #[doc = include_str!("../../../README.md")]
    mod project {}
}

/// The pages of the book whose code is tested here; `docs/errors.md` is tested in `shadowgraph-inspect`.
#[cfg(doctest)]
mod book {
    #[doc = include_str!("../../../docs/graph.md")]
    mod graph {}
    #[doc = include_str!("../../../docs/moving.md")]
    mod moving {}
    #[doc = include_str!("../../../docs/pipelines.md")]
    mod pipelines {}
}
