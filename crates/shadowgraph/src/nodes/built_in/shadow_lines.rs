//! `shadow_lines`

use shadowgraph_core::{Contents, Format, Frame};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;
use crate::shadow_lines::{ShadowLines, ShadowLinesPass};

pub(super) struct ShadowLinesNode {
    pass: ShadowLinesPass,
}

impl Node for ShadowLinesNode {
    const NAME: &'static str = "shadow_lines";
    const ABOUT: &'static str = "draws what shadow maps cover as lines";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::new("shadows", PortKind::Shadows, "the shadows; without maps there are no lines"),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("colors", "sRGB colours, alpha 0 where nothing is drawn")
            .with_format(Format::Rgba8Unorm)];
    const SETTINGS: &'static [Setting] = &[Setting::new(
        "lines",
        SettingType::Choice("frusta", &ShadowLines::NAMES),
        "slices of the view and boxes of tiles, spheres of cascades, or tiles and their borders",
    )];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        let kind = ShadowLines::from_name(settings.text("lines")?).unwrap_or(ShadowLines::Frusta);
        Ok(Self { pass: ShadowLinesPass::new(context.device, kind)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, views) = (ports.view("view")?, ports.shadows("shadows")?.map_buffers.clone());
        let mut colors = ports.create("colors", frame, view.texture_desc(Format::Rgba8Unorm));
        let clear = Contents::clear_color([0.0; 4]);
        match views {
            Some([views, _]) => {
                let origin_world = view.casters.scene.origin_world();
                let camera = (view.shadow_camera, view.options.aspect(), origin_world);
                self.pass.add_to(frame, (&buffers, &views), camera, (&mut colors, clear));
            }
            None => {
                let mut pass = frame.render_pass("no shadow lines");
                pass.color(&mut colors, clear);
                pass.body(|_| Ok(()));
            }
        }
        ports.set("colors", colors);
        Ok(())
    }
}
