//! `shadows`

use shadowgraph_core::Frame;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

/// By whatever technique: a pipeline is made with it.
pub(crate) struct Shadows;

impl Shadows {
    /// The setting that names the technique.
    pub(crate) const TECHNIQUE: &'static str = "technique";
    /// The setting that has shadows collected on the screen.
    pub(crate) const COLLECTED: &'static str = "collected";
}

impl Node for Shadows {
    const NAME: &'static str = "shadows";
    const ABOUT: &'static str = "makes the shadows of all lights, by a technique";
    const INPUTS: &'static [Port] =
        &[Port::new("surfaces", PortKind::Surfaces, "for techniques that ask for them").optional()];
    const OUTPUTS: &'static [Port] = &[Port::new("shadows", PortKind::Shadows, "for whoever lights")];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            Self::TECHNIQUE,
            SettingType::Text(""),
            "a technique by name; empty: that of --technique",
        ),
        Setting::new(
            Self::COLLECTED,
            SettingType::Toggle(false),
            "whether shadows are collected in a screen mask first",
        ),
    ];
    const GROUPS_ITSELF: bool = true;

    fn new(_build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self)
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let screen = ports.surfaces("surfaces")?;
        let shadows = view.shadows(frame, screen.as_ref())?;
        ports.set("shadows", shadows);
        Ok(())
    }
}
