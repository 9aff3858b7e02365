//! Results of a measurement as data.

use serde::{Deserialize, Serialize};
use shadowgraph_shadows::ShadowSettings;

use crate::comparator::ViewErrors;
use crate::metrics::{EdgeError, Stability, Summary};
use crate::variants::Variant;

/// Results of a measurement, from which the table, the page and the check against bounds are made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version of the format: [`Report::VERSION`].
    pub version: u32,
    /// Name of the adapter.
    pub adapter: String,
    /// Width and height of the images, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings of all techniques.
    pub settings: ShadowSettings,
    /// More settings that were measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variants: Vec<Variant>,
    /// A case for each technique and settings in each view of each light.
    pub cases: Vec<CaseReport>,
}

impl Report {
    /// Version of the format that this crate writes.
    pub const VERSION: u32 = 1;
}

/// One technique in one view of one light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseReport {
    /// The scene's name.
    pub scene: String,
    /// The light: a sun by its elevation, other lights by kind and index.
    pub light: String,
    /// The view's name.
    pub view: String,
    /// The technique's name; with a variant of settings `NAME: VARIANT`.
    pub technique: String,
    /// Errors against the hard reference.
    pub errors: ViewErrors,
    /// Errors of edges against the soft reference, if it was traced.
    pub edges: Option<EdgeError>,
    /// Difference of cascades along their borders, if there are any.
    pub seam: Option<Summary>,
    /// Change of shadows while the camera moves, if measured.
    pub flicker: Vec<Flicker>,
    /// Cost of the shadows.
    pub cost: Option<Cost>,
    /// The image files, if written.
    #[serde(rename = "pictures")]
    pub images: Option<ImageFiles>,
}

/// Change of shadows during one motion of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flicker {
    /// Motion of the camera.
    pub motion: Motion,
    /// Whether the scene was moved 10 km away from the world's origin.
    pub far_out: bool,
    /// Change of visibility from frame to frame, 0 to 1.
    pub change: Summary,
}

/// Motion of the camera, by less than a pixel each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Motion {
    /// Sideways and forwards.
    Translate,
    /// Around its own axes.
    Rotate,
    /// Field of view.
    Zoom,
}

/// Results of a measurement of motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionReport {
    /// Version of the format: [`Report::VERSION`].
    pub version: u32,
    /// Name of the adapter.
    pub adapter: String,
    /// Width and height of the images, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings of all techniques.
    pub settings: ShadowSettings,
    /// A case for each technique on each path in each view of each light.
    pub cases: Vec<MotionCase>,
}

/// Change of one technique's shadows on a path, in one view of one light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionCase {
    /// The scene's name.
    pub scene: String,
    /// The light: a sun by its elevation, other lights by kind and index.
    pub light: String,
    /// The view's name.
    pub view: String,
    /// The technique's name.
    pub technique: String,
    /// What moves.
    pub moving: Moving,
    /// The change of the shadows. Points are pixels.
    pub stability: Stability,
}

/// What moves on a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Moving {
    /// The camera walks, then turns.
    Camera,
    /// The sun turns.
    Sun,
    /// All instances that are smaller than half of the scene move.
    Objects,
}

impl Moving {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 3] = [Self::Camera, Self::Sun, Self::Objects];

    /// Returns the name in tables and options.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Sun => "sun",
            Self::Objects => "objects",
        }
    }
}

/// Cost of the shadows of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// GPU time of the shadow passes, milliseconds, if the adapter can measure it.
    pub gpu_ms: Option<f64>,
    /// Size of all textures that the technique's passes write, bytes.
    pub texture_bytes: u64,
    /// Number of draws of casters.
    pub draws: u64,
    /// Number of triangles of casters; `None` where the GPU decides what is drawn.
    pub triangles: Option<u64>,
    /// Number of pages, if the technique has any.
    #[serde(default)]
    pub pages: Option<u64>,
}

/// Image files of a case, as paths relative to the page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageFiles {
    /// The rendered colour image.
    #[serde(rename = "picture")]
    pub color: String,
    /// The ray-traced reference: white lit, black in shadow.
    pub truth: String,
    /// The visibility of the technique, 0 black to 1 white.
    pub visibility: String,
    /// The difference of the two.
    pub difference: String,
}
