//! A render graph for wgpu: a frame is declared as passes and the resources they read and write, and is compiled
//! every frame into a [`Plan`]: which passes run, in what order, in which physical textures, with which load and
//! store operations, and why.
//!
//! The declaration is the only thing you write. Usage flags, load and store operations, lifetimes and the sharing
//! of textures are derived from it, and only declared resources can be accessed.
//!
//! ```
//! use shadowgraph_core::{BufferDesc, Contents, Format, Frame, TextureDesc};
//!
//! let mut frame = Frame::new();
//! let mut scene = frame.create_texture("scene", TextureDesc::d2(1280, 720, Format::Rgba16Float));
//! let mut output = frame.create_texture("output", TextureDesc::d2(1280, 720, Format::Rgba8UnormSrgb));
//!
//! frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
//! let mut tonemap = frame.render_pass("tonemap");
//! let _scene = tonemap.sample(&scene);
//! tonemap.color(&mut output, Contents::Overwrite);
//! frame.export_texture(&output);
//!
//! let plan = frame.compile()?.into_plan();
//! assert_eq!(plan.order().len(), 2);
//! println!("{}", plan.to_text());
//! # Ok::<(), shadowgraph_core::Error>(())
//! ```
//!
//! # Rules
//!
//! - Reading takes `&handle`; writing takes `&mut handle` and moves it to the next version. An older clone is
//!   stale afterwards, and using it is an error that names the writer. So cycles cannot be written, and the order
//!   of declaration is always a valid order.
//! - Every write says what happens to the old contents ([`Contents`]): cleared, overwritten or preserved. Reading
//!   undefined contents is an error.
//! - Declaring an access returns a token. Inside a pass body only tokens of that pass resolve.
//! - Errors are collected while declaring; [`Frame::compile`] returns the first one.
//!
//! # Features
//!
//! `gpu` (default): the pool and the executor. Without it the crate has no device and no wgpu, only the graph, its
//! compiler and the dumps.

mod access;
mod builder;
mod capture;
mod compile;
mod compiled;
#[cfg(feature = "gpu")]
mod context;
mod declaration;
mod desc;
#[cfg(feature = "gpu")]
mod device;
mod dump;
mod error;
#[cfg(feature = "gpu")]
mod execute;
mod frame;
mod graph;
mod handle;
mod history;
#[cfg(feature = "gpu")]
mod internal;
mod name;
mod pass_name;
#[cfg(feature = "gpu")]
mod pipeline;
mod plan;
#[cfg(feature = "gpu")]
mod pool;
#[cfg(feature = "gpu")]
mod read_back;
#[cfg(feature = "gpu")]
mod shader_pass;
mod subresource;
mod suggest;
#[cfg(all(test, feature = "gpu"))]
mod test_device;
#[cfg(test)]
mod test_text;
mod texels;
#[cfg(feature = "gpu")]
mod timer;
mod times;
mod values;
#[cfg(feature = "gpu")]
mod watch;

pub use access::{Access, ClearValue, Contents};
#[cfg(feature = "gpu")]
pub use builder::ShaderPassBuilder;
pub use builder::{Compute, Copying, Encoding, Pass, Rendering, ShaderPass};
pub use capture::{Contained, SnapshotTile, TexelValues, Texels, TextureSnapshot};
pub use compiled::Compiled;
#[cfg(feature = "gpu")]
pub use context::{BodyResult, ComputeContext, EncoderContext, RenderContext, Resources};
pub use declaration::{CopyOp, Options, OrderPolicy, Origin, PassKind};
pub use desc::{BufferDesc, Extent, Format, ResourceDesc, TextureDesc};
#[cfg(feature = "gpu")]
pub use device::{device_is_lost, with_error_scopes};
pub use dump::{JSON_SCHEMA, describe};
pub use error::Error;
#[cfg(feature = "gpu")]
pub use execute::{
    Executed, FailedFrame, FrameCapture, PendingCapture, PendingTexture, PendingValues, ReadBackRequest,
};
pub use frame::{Frame, History};
pub use graph::{Graph, PlanCounts};
#[cfg(feature = "gpu")]
pub use handle::Bind;
pub use handle::{
    Buffer, BufferExport, BufferToken, NodeId, PassId, ResourceId, SlotId, Texture, TextureExport,
    TextureToken, Uniform,
};
pub use history::Resize;
pub use name::Name;
pub use pass_name::PassName;

#[cfg(feature = "gpu")]
pub use pipeline::{ComputeShader, FullscreenShader};
pub use plan::{
    AccessPlan, AttachmentOps, CullReason, Dependency, DependencyKind, LoadAction, LoadReason, MergeReason,
    NodePlan, OrderReason, PassPlan, Plan, ResourcePlan, SlotPlan, SlotReason, Step, StoreAction,
    StoreReason,
};
#[cfg(feature = "gpu")]
pub use pool::PoolLimits;
#[cfg(feature = "gpu")]
pub use read_back::ReadBack;
#[cfg(feature = "gpu")]
pub use shader_pass::UniformSource;
pub use subresource::{Aspect, Rect, Subresource};
pub use suggest::{closest_name, did_you_mean};
pub use texels::TexelLayout;
#[cfg(feature = "gpu")]
pub use timer::Timer;
pub use times::{PassTime, TimeHistory, TimeStats, TimeSummary};
pub use values::{BadValues, Texel, ValueCheck, ValueReport};
#[cfg(feature = "gpu")]
pub use watch::WatchedTexture;
#[cfg(feature = "gpu")]
pub use wgpu;
pub use wgpu_types::{BufferUsages, TextureUsages};
