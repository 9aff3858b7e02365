//! What a program offers its page.

use serde::Serialize;

/// What the page may change.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Controls {
    /// Whether the program stands still, if the page may freeze it and let it do one step.
    pub freeze: Option<bool>,
    /// Whether frames are recorded, and the page may have the recording saved.
    pub save_recording: bool,
    /// Whether the page may ask for the history of a pixel.
    pub pixel: bool,
    /// Settings.
    pub settings: Vec<Offered>,
}

/// A setting of a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Offered {
    /// The name on the page.
    pub name: String,
    /// The value, and which others are allowed.
    pub value: OfferedValue,
}

/// The value of a setting.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OfferedValue {
    /// One of some words.
    Choice {
        /// The chosen one.
        chosen: String,
        /// All of them.
        all: Vec<String>,
    },
    /// A number in a range.
    Number {
        /// The value.
        value: f64,
        /// The smallest allowed value.
        min: f64,
        /// The largest allowed value.
        max: f64,
    },
}
