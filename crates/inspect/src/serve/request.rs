//! What pages ask for.

use serde::Deserialize;
use shadowgraph_core::WatchedTexture;

use super::controls::{Controls, OfferedValue};

/// What a page asks the program for, of what it [offers](super::Server::offer).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PageRequest {
    /// Stand still, or go on.
    Freeze(bool),
    /// Draw the next frame and stand still again.
    Step,
    /// Save what has been recorded so far.
    SaveRecording,
    /// Draw a frame pass by pass and [answer](super::Server::answer_pixel) with the history of a pixel: column and row from the top left.
    Pixel([u32; 2]),
    /// Set a setting to one of its words.
    Choose {
        /// The name of the setting.
        name: String,
        /// One of its words.
        value: String,
    },
    /// Set a setting to a number in its range.
    Set {
        /// The name of the setting.
        name: String,
        /// The number.
        value: f64,
    },
}

impl PageRequest {
    /// Checks that a request is offered.
    pub(super) fn check(&self, controls: &Controls) -> Result<(), String> {
        let offered = |name: &str| controls.settings.iter().find(|setting| setting.name == name);
        let is_offered = match self {
            Self::Freeze(_) | Self::Step => controls.freeze.is_some(),
            Self::SaveRecording => controls.save_recording,
            Self::Pixel(_) => controls.pixel,
            Self::Choose { name, value } => match offered(name).map(|setting| &setting.value) {
                Some(OfferedValue::Choice { all, .. }) => all.contains(value),
                _ => false,
            },
            Self::Set { name, value } => match offered(name).map(|setting| &setting.value) {
                Some(OfferedValue::Number { min, max, .. }) => (*min..=*max).contains(value),
                _ => false,
            },
        };
        if is_offered { Ok(()) } else { Err("the program does not offer this".into()) }
    }
}

/// A message of a page.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum PageMessage {
    /// Show a texture, or none.
    Watch(Option<WatchMessage>),
    /// Ask the program for something.
    Request(PageRequest),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WatchMessage {
    texture: String,
    version: Option<u32>,
    mip: u32,
    layer: u32,
}

impl From<WatchMessage> for WatchedTexture {
    fn from(message: WatchMessage) -> Self {
        let WatchMessage { texture, version, mip, layer } = message;
        Self { texture, version, mip, layer }
    }
}
