//! Textures, passes and clears of the frames.

use shadowgraph_core::{Contents, Format, Frame, Plan, Texture, TextureDesc};

pub(crate) const BLACK: Contents = Contents::Clear(shadowgraph_core::ClearValue::Color([0.0; 4]));
/// Depth is reversed: the far plane is 0.
pub(crate) const FAR: Contents = Contents::Clear(shadowgraph_core::ClearValue::Depth(0.0));

pub(crate) fn hdr(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(1280, 720, Format::Rgba16Float))
}

pub(crate) fn depth(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(1280, 720, Format::Depth32Float))
}

/// Draws a new texture.
pub(crate) fn draw(frame: &mut Frame<'_>, name: &str) -> Texture {
    let mut target = hdr(frame, name);
    frame.render_pass(format_args!("draw {name}")).color(&mut target, BLACK);
    target
}

/// Reads a texture and overwrites a new one.
pub(crate) fn filter(frame: &mut Frame<'_>, name: &str, from: &Texture) -> Texture {
    let mut to = hdr(frame, name);
    let mut pass = frame.render_pass(name);
    pass.sample(from);
    pass.color(&mut to, Contents::Overwrite);
    to
}

pub(crate) fn plan(frame: Frame<'_>) -> Plan {
    frame.compile().unwrap().into_plan()
}
