//! Shadowgraph on a canvas.
//!
//! In a web page, `Viewer` shows a model with a technique, a pipeline and shadow settings, and draws a frame for each call. Programs in
//! Rust that have their own frame loop use `Canvas`, which opens a device for a canvas, and the [`Renderer`](shadowgraph::Renderer). Both
//! exist only on `wasm32`; [`Stage`], [`Orbit`] and [`Model`] need no browser.
//!
//! What a page does with it is in the book, `docs/web.md`; `cargo xtask web` builds the demo page.

#[cfg(target_arch = "wasm32")]
mod browser;
mod error;
mod model;
mod orbit;
mod settings;
mod stage;

#[cfg(target_arch = "wasm32")]
pub use browser::{Canvas, Viewer};
pub use error::Error;
pub use model::Model;
pub use orbit::Orbit;
pub use settings::settings_from_json;
pub use stage::Stage;
