//! What a measurement found, as data.

use serde::{Deserialize, Serialize};
use shadowgraph_shadows::ShadowSettings;

use crate::metrics::{EdgeError, Summary};
use crate::{Variant, ViewErrors};

/// Everything that was measured: what its table, its page and its check against bounds are made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The version of this form: [`Report::VERSION`].
    pub version: u32,
    /// What drew.
    pub adapter: String,
    /// Width and height of the pictures, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings that all techniques got.
    pub settings: ShadowSettings,
    /// Further settings that they got.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variants: Vec<Variant>,
    /// One for each technique, with each settings, in each view of each light.
    pub cases: Vec<CaseReport>,
}

impl Report {
    /// The version of the form that this crate writes.
    pub const VERSION: u32 = 1;
}

/// One technique in one view of one light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseReport {
    /// The scene's name.
    pub scene: String,
    /// The light: a sun by its height, other lights by kind and number.
    pub light: String,
    /// The view's name.
    pub view: String,
    /// The technique's name; with a variant of settings `NAME: VARIANT`.
    pub technique: String,
    /// How its shadows differ from hard truth.
    pub errors: ViewErrors,
    /// How its edges differ from soft truth, if that was traced.
    pub edges: Option<EdgeError>,
    /// How much its cascades differ along their borders, if it has any.
    pub seam: Option<Summary>,
    /// How much its shadows change while the camera moves, if that was measured.
    pub flicker: Vec<Flicker>,
    /// What its shadows cost.
    pub cost: Option<Cost>,
    /// The files of its pictures, if they were written.
    pub pictures: Option<ImageFiles>,
}

/// How much shadows change during one motion of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flicker {
    /// How the camera moves.
    pub motion: Motion,
    /// Whether the scene was moved 10 km away from the world's origin.
    pub far_out: bool,
    /// The change of visibility from frame to frame, 0 to 1.
    pub change: Summary,
}

/// How the camera moves, by less than a pixel each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Motion {
    /// Sideways and forwards.
    Translate,
    /// Around its own axes.
    Rotate,
    /// The angle of its lens.
    Zoom,
}

/// What the shadows of a frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// The GPU's time for the shadow passes, milliseconds, where the adapter can measure it.
    pub gpu_ms: Option<f64>,
    /// The bytes of all textures that the technique's passes write.
    pub texture_bytes: u64,
    /// How many draws of casters there are.
    pub draws: u64,
    /// How many triangles they have.
    pub triangles: u64,
}

/// Pictures of a case, as paths from the page's folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageFiles {
    /// What the technique draws, in colour.
    pub picture: String,
    /// The ray-traced truth: white lit, black in shadow.
    pub truth: String,
    /// What the technique says: the same, with grey between.
    pub visibility: String,
    /// How the two differ.
    pub difference: String,
}
