//! Recordings of what a [`Renderer`](crate::Renderer) is given for its frames, from which [`Replay`](crate::Replay) draws any of them again to the bit.
//!
//! A frame follows from the scene, the options of its views, and what the frames before have left: histories, kept shadow maps, pages. A
//! recording has the first two of every frame since the renderer was created, so drawing the frames in order leaves the same on the same
//! adapter and driver, and no memory of the GPU has to be kept. A frame of a still scene takes some bytes, one with a new camera some hundred.

pub(crate) mod entry;
mod error;
mod file;
mod recorder;
pub(crate) mod scene;

pub use error::RecordingError;
pub use file::Recording;
pub use recorder::Recorder;
pub(crate) use recorder::RendererState;
