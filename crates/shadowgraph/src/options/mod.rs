//! Options as plain values: parsed, checked, and applied to a scene.
//!
//! Every option is a type with [`FromStr`](std::str::FromStr), so that other tools can read the same syntax. Angles are degrees here
//! and radians in the types of the scene. An error about an unknown key or a value out of range names the key and the range.
//!
//! ```
//! use shadowgraph::options::{Aov, Size, SunChoice};
//! let size: Size = "320x180".parse()?;
//! assert_eq!(size.aspect(), 16.0 / 9.0);
//! assert_eq!("visibility:2".parse::<Aov>()?, Aov::Visibility(2));
//! let error = "dir=0,-1,0 lux=-3".parse::<SunChoice>().unwrap_err();
//! assert_eq!(error.to_string(), "sun: lux=-3 is out of range: 0 to 1000000 lux");
//! # Ok::<(), shadowgraph::options::OptionError>(())
//! ```

pub(crate) mod adapter;
pub(crate) mod animation;
pub(crate) mod aov;
mod background;
pub(crate) mod camera;
mod color;
mod culling;
pub(crate) mod distance;
pub(crate) mod error;
pub(crate) mod ground;
mod overlay;
mod pairs;
pub(crate) mod settings;
pub(crate) mod size;
pub(crate) mod sun;

pub use adapter::AdapterChoice;
pub use animation::{AnimationChoice, AnimationTime};
pub use aov::Aov;
pub use camera::CameraChoice;
pub use distance::ShadowDistance;
pub use error::OptionError;
pub use ground::{GroundChoice, PlacedGround};
pub use settings::{SettingsFile, read_tracks, setting_error};
pub use size::Size;
pub use sun::{DEFAULT_SUN_LUX, SunChoice, default_sun, sun_at};
