//! `sky`

use std::sync::{Mutex, PoisonError};

use shadowgraph_core::Frame;
use shadowgraph_lighting::{KeyLight, SkyLight, SkySettings};
use shadowgraph_scene::Light;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(crate) struct Sky {
    settings: SkySettings,
    /// The sky of the latest lights.
    latest: Mutex<Option<(Vec<Light>, KeyLight, SkyLight)>>,
}

impl Sky {
    /// Returns the sky above some lights, computed if they have changed.
    fn light(&self, lights: &[Light], key: KeyLight) -> SkyLight {
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        match &*latest {
            Some((of, of_key, sky)) if of == lights && *of_key == key => sky.clone(),
            _ => {
                let sky = SkyLight::new(lights, key, &self.settings);
                *latest = Some((lights.to_vec(), key, sky.clone()));
                sky
            }
        }
    }
}

impl Node for Sky {
    const NAME: &'static str = "sky";
    const ABOUT: &'static str =
        "computes a sky around the sun, which lights the scene and is its background, with the ground below";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera and the lights")];
    const OUTPUTS: &'static [Port] =
        &[Port::new("view", PortKind::View, "the same with the sky, for `ssao` and lighting nodes")];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "turbidity",
            SettingType::Number(3.0, 1.0, 10.0),
            "aerosols in the air: 2 arctic, 3 clear, 6 warm and moist, 10 hazy",
        ),
        Setting::new(
            "disc_rad",
            SettingType::Number(0.0075, 0.0, 0.5),
            "angular radius of the sun's disc; the sun's is 0.00465",
        )
        .in_units("radians"),
    ];

    fn new(_context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        let settings = SkySettings {
            turbidity: settings.number("turbidity")?,
            disc_rad: settings.number("disc_rad")?,
            ..SkySettings::default()
        };
        Ok(Self { settings, latest: Mutex::default() })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let light = self.light(view.lights, view.key_light);
        ports.set("view", view.with_sky(frame, &ports.view("view")?, &light));
        Ok(())
    }
}
