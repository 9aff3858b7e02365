//! Shows and compares compiled frames of [`shadowgraph_core`]: an HTML page ([`HtmlPage`]), the differences between two frames ([`diff`],
//! [`Dump`]), explanations of passes and resources ([`explain`]), the history of a pixel ([`PixelRecorder`]) and times in Chrome's trace format ([`trace_json`]).
//!
//! The crate reads plans, captured textures and times. It draws nothing and needs no device. With the feature `serve`, `Server` shows the frames of a
//! running program on a page.
//!
//! ```
//! use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
//!
//! let mut frame = Frame::new();
//! let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
//! frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
//! frame.export_texture(&scene);
//! let plan = frame.compile()?.into_plan();
//!
//! println!("{}", shadowgraph_inspect::explain(&plan, "draw")?);
//! let page = shadowgraph_inspect::to_html(&plan);
//! # assert!(page.contains("draw"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod contents;
mod diff;
mod error;
mod explain;
mod html;
mod pixel;
#[cfg(feature = "serve")]
mod serve;
mod trace;
mod version_image;

pub use contents::{ContentsDiff, ContentsDifference, ContentsRecorder, LargestDifference, Tolerance};
pub use diff::{Diff, Difference, Dump, Subject, diff};
pub use error::Error;
pub use explain::{explain, explain_order, explain_pass, explain_resource, explain_why_before};
pub use html::{Drawing, HtmlPage, Outline, PageTable, to_html};
pub use pixel::{
    PixelHistory, PixelPass, PixelPlace, PixelRead, PixelRecorder, PixelTexel, PixelWrite, WriteEffect,
};
#[cfg(feature = "serve")]
pub use serve::{Controls, FrameReport, Offered, OfferedValue, PageRequest, Server};
pub use trace::trace_json;
pub use version_image::VersionImage;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

/// Compiles and runs the examples of the page, those of `shadowgraph-core` too. Some need a device.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/errors.md")]
mod errors_page {}
