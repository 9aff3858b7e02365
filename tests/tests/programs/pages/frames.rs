//! Frames for pages.

use shadowgraph::core::{Contents, Error, Format, Frame, Plan, Texture, TextureDesc};

#[path = "../../../../crates/core/tests/frames/real.rs"]
#[allow(dead_code, reason = "a part of it is for benchmarks")]
mod real;

/// Returns a frame of 65 passes, as a game has.
pub(crate) fn real() -> Result<Plan, Error> {
    let mut frame = Frame::new();
    let bytes = [0u8; 4096];
    real::declare(&mut frame, &bytes, 0.5);
    Ok(frame.compile()?.into_plan())
}

/// Returns a frame of 500 passes, half of them in nodes of ten passes, half without a node. Some are culled.
pub(crate) fn large() -> Result<Plan, Error> {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(256, 256, Format::Rgba16Float);
    let mut last: Vec<Texture> = Vec::new();
    for node in 0..25 {
        let made = frame.node(format_args!("node {node}"), |frame| chain(frame, node, 10, &last));
        last.push(made);
    }
    for run in 25..50 {
        let made = chain(&mut frame, run, 10, &last);
        last.push(made);
    }
    let mut image = frame.create_texture("image", desc);
    let mut pass = frame.render_pass("compose");
    for made in last.iter().step_by(3) {
        pass.sample(made);
    }
    pass.color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);
    Ok(frame.compile()?.into_plan())
}

/// Passes each of which reads the one before, and now and then what others left.
fn chain(frame: &mut Frame<'_>, number: usize, passes: usize, others: &[Texture]) -> Texture {
    let desc = TextureDesc::d2(256, 256, Format::Rgba16Float);
    let mut before: Option<Texture> = None;
    for index in 0..passes {
        let mut made = frame.create_texture(format_args!("texture {number}.{index}"), desc);
        let mut pass = frame.render_pass(format_args!("pass {number}.{index}"));
        if let Some(before) = &before {
            pass.sample(before);
        }
        if index % 4 == 0
            && let Some(other) = others.get((number * 7 + index) % others.len().max(1))
        {
            pass.sample(other);
        }
        pass.color(&mut made, Contents::clear_color([0.0; 4]));
        before = Some(made);
    }
    before.unwrap_or_else(|| frame.create_texture("nothing", desc))
}
