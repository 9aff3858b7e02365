//! The program's options as plain values: parsed, checked, and applied to a scene.
//!
//! Every option is a type with [`FromStr`](std::str::FromStr), so other tools can take the same words.
//! Angles are degrees here and radians in the scene's types; unknown keys and values out of range are
//! refused with the key and the range.
//!
//! ```
//! use shadowgraph::options::{Aov, Size, SunChoice};
//! let size: Size = "320x180".parse()?;
//! assert_eq!(size.aspect(), 16.0 / 9.0);
//! assert_eq!("visibility:2".parse::<Aov>()?, Aov::Visibility(2));
//! let error = "dir=0,-1,0 lux=-3".parse::<SunChoice>().unwrap_err();
//! assert_eq!(error.to_string(), "--sun: lux=-3 is out of range: 0 to 1000000 lux");
//! # Ok::<(), shadowgraph::options::OptionError>(())
//! ```

mod adapter;
mod aov;
mod camera;
mod distance;
mod error;
mod pairs;
mod settings;
mod size;
mod sun;

pub use adapter::AdapterChoice;
pub use aov::Aov;
pub use camera::CameraChoice;
pub use distance::ShadowDistance;
pub use error::OptionError;
pub use settings::SettingsFile;
pub(crate) use settings::wrong_setting;
pub use size::Size;
pub use sun::{DEFAULT_SUN_LUX, SunChoice, default_sun};

use crate::{Method, Pipeline};
use shadowgraph_shadows::{ShadowSettings, Technique};

/// Everything that the options of a drawing command say, without the scene's file and the output's.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The pipeline that draws.
    pub pipeline: Pipeline,
    /// The shadow technique; `None`: that of the pipeline.
    pub technique: Option<Technique>,
    /// How many samples each pixel has while colours are drawn, 1 or 4.
    pub samples: u32,
    /// The settings of the shadows.
    pub settings: ShadowSettings,
    /// The size of the picture.
    pub size: Size,
    /// The camera.
    pub camera: CameraChoice,
    /// The directional lights.
    pub sun: SunChoice,
    /// How far shadows reach; `settings.distance_m` is not looked at.
    pub shadow_distance: ShadowDistance,
    /// What the picture shows.
    pub aov: Aov,
    /// The GPU that draws.
    pub adapter: AdapterChoice,
    /// Whether times per pass are asked for.
    pub timings: bool,
}

impl Options {
    /// Returns how pictures are drawn.
    pub fn method(&self) -> Method {
        Method { technique: self.technique, pipeline: self.pipeline.clone(), samples: self.samples }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            pipeline: Pipeline::default(),
            technique: None,
            samples: 1,
            settings: ShadowSettings::default(),
            size: Size::default(),
            camera: CameraChoice::default(),
            sun: SunChoice::default(),
            shadow_distance: ShadowDistance::default(),
            aov: Aov::default(),
            adapter: AdapterChoice::default(),
            timings: false,
        }
    }
}
