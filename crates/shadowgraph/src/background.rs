//! What is drawn behind a scene.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What is drawn behind a scene in colour images.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Background {
    /// The sky of the pipeline; without one, its colour.
    #[default]
    Sky,
    /// This colour, as the image shows it: linear RGB, each 0 to 1. Of the ground, only shadows are visible.
    Color(Vec3),
    /// Nothing: alpha is 0, the ground black with the opacity of its shadows. Colours are multiplied by alpha.
    Transparent,
}
