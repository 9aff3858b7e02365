#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

mod contents;
mod errors;
mod random;
mod sharing;

use crate::{Contents, Format, Frame, PassId, Plan, Texture, TextureDesc};

const BLACK: Contents = Contents::Clear(crate::ClearValue::Color([0.0; 4]));

fn color(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(64, 64, Format::Rgba8Unorm))
}

fn plan(frame: Frame<'_>) -> Plan {
    frame.compile().unwrap().into_plan()
}

fn pass(plan: &Plan, name: &str) -> PassId {
    PassId(plan.passes.iter().position(|p| p.name == name).unwrap() as u32)
}

/// Reads `from` and covers a new texture.
fn filter(frame: &mut Frame<'_>, name: &str, from: &Texture) -> Texture {
    let mut to = color(frame, name);
    let mut pass = frame.render_pass(name);
    pass.sample(from);
    pass.color(&mut to, Contents::Cover);
    to
}
