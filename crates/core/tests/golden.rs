//! Small frames, each showing one feature, and their dumps.
//!
//! The texts are in `golden/NAME.txt`. A different text fails the test and prints the difference; after
//! reading it, accept it with
//! `UPDATE_GOLDEN=1 cargo test -p shadowgraph-core --no-default-features --test golden`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "golden/compare.rs"]
mod compare;
#[path = "golden/contents.rs"]
mod contents;
#[path = "golden/formats.rs"]
mod formats;
#[path = "golden/frame.rs"]
mod frame;
#[path = "golden/memory.rs"]
mod memory;
#[path = "golden/merging.rs"]
mod merging;
#[path = "golden/order.rs"]
mod order;
#[path = "golden/regions.rs"]
mod regions;

use compare::check;
use shadowgraph_core::{Contents, Format, Frame, Plan, Texture, TextureDesc};

const BLACK: Contents = Contents::Clear(shadowgraph_core::ClearValue::Color([0.0; 4]));
/// Depth is reversed: the far plane is 0.
const FAR: Contents = Contents::Clear(shadowgraph_core::ClearValue::Depth(0.0));

fn hdr(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(1280, 720, Format::Rgba16Float))
}

fn depth(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(1280, 720, Format::Depth32Float))
}

/// Draws a new texture.
fn draw(frame: &mut Frame<'_>, name: &str) -> Texture {
    let mut target = hdr(frame, name);
    frame.render_pass(format_args!("draw {name}")).color(&mut target, BLACK);
    target
}

/// Reads a texture and overwrites a new one.
fn filter(frame: &mut Frame<'_>, name: &str, from: &Texture) -> Texture {
    let mut to = hdr(frame, name);
    let mut pass = frame.render_pass(name);
    pass.sample(from);
    pass.color(&mut to, Contents::Overwrite);
    to
}

fn plan(frame: Frame<'_>) -> Plan {
    frame.compile().unwrap().into_plan()
}
