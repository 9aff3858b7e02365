//! The built-in techniques.

pub(crate) mod compute;
mod mask;
mod moments;
mod none;
mod pcf;
mod pcss;
mod raytraced;
mod screen;
mod sdsm;
mod virtual_maps;

pub use moments::{Evsm, EvsmMoments, EvsmPrecision, EvsmSettings, Msm, MsmSettings};
pub use none::NoShadows;
pub use pcf::Pcf;
pub use pcss::{Pcss, PcssSettings};
pub use raytraced::{Raytraced, RaytracedSettings};
pub use screen::{ContactSettings, ScreenSettings, ScreenShadows};
pub use sdsm::{Sdsm, SdsmSettings};
pub use virtual_maps::{VirtualMaps, VirtualSettings};
