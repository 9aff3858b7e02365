//! A whole frame.

use super::{BLACK, FAR, check, depth, filter, hdr, plan};
use shadowgraph_core::{
    BufferDesc, Contents, Format, Frame, Rect, Resize, Subresource, Texture, TextureDesc, TextureUsages,
};

/// All features together: shadow tiles, a depth pass, lit passes that merge, culling on the GPU, accumulation over time,
/// a chain of mips, an optional debug view that is off, and the window.
#[test]
fn whole_frame() {
    let mut frame = Frame::new();
    let draws = frame.node("culling", draws);
    let shadows = frame.node("shadows", shadows);
    let (scene, depth) = frame.node("scene", |frame| scene(frame, &shadows, &draws));
    let steady = frame.node("accumulate", |frame| accumulate(frame, &scene, &depth));
    let glow = frame.node("bloom", |frame| bloom(frame, &steady));
    frame.node("debug", |frame| filter(frame, "show depth", &depth));

    let desc = TextureDesc::d2(1280, 720, Format::Bgra8UnormSrgb);
    let mut window = frame.declare_import_texture("window", desc, TextureUsages::RENDER_ATTACHMENT, false);
    let mut tonemap = frame.render_pass("tonemap");
    tonemap.sample(&steady);
    tonemap.subresource(Subresource::FULL.mip(0)).sample(&glow);
    tonemap.color(&mut window, Contents::Overwrite);
    frame.render_pass("overlay").color(&mut window, Contents::Preserve);
    check("whole_frame", &plan(frame).to_text());
}

/// The draws that are in view, counted by a compute pass.
fn draws(frame: &mut Frame<'_>) -> shadowgraph_core::Buffer {
    let objects = frame.upload_buffer("objects", vec![0; 64_000]);
    let mut draws = frame.create_buffer("draws", BufferDesc::new(20_000));
    let mut pass = frame.compute_pass("cull objects");
    pass.storage_buffer(&objects);
    pass.storage_buffer_mut(&mut draws, Contents::Overwrite);
    draws
}

fn shadows(frame: &mut Frame<'_>) -> Texture {
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(2048, 1024, Format::Depth32Float));
    for (light, name) in ["sun", "lamp"].into_iter().enumerate() {
        let tile = Subresource::FULL.rect(Rect::new(light as u32 * 1024, 0, 1024, 1024));
        frame.node(name, |frame| {
            frame.render_pass("casters").subresource(tile).depth(&mut atlas, FAR);
        });
    }
    atlas
}

fn scene(frame: &mut Frame<'_>, shadows: &Texture, draws: &shadowgraph_core::Buffer) -> (Texture, Texture) {
    let (mut scene, mut depth) = (hdr(frame, "scene"), depth(frame, "depth"));
    let mut first = frame.render_pass("depth first");
    first.indirect_buffer(draws);
    first.depth(&mut depth, FAR);
    for (name, contents) in [("opaque", BLACK), ("sky", Contents::Preserve), ("glass", Contents::Preserve)] {
        let mut pass = frame.render_pass(name);
        pass.color(&mut scene, contents);
        pass.depth_read(&depth);
        pass.sample(shadows);
    }
    (scene, depth)
}

fn accumulate(frame: &mut Frame<'_>, scene: &Texture, depth: &Texture) -> Texture {
    let desc = TextureDesc::d2(1280, 720, Format::Rgba16Float);
    let mut colour = frame.history("steady", desc, Resize::Resample);
    let mut pass = frame.compute_pass("blend");
    pass.sample(scene);
    pass.sample(depth);
    pass.sample(&colour.previous);
    pass.storage_texture_mut(&mut colour.current, Contents::Overwrite);
    colour.current
}

fn bloom(frame: &mut Frame<'_>, from: &Texture) -> Texture {
    let desc = TextureDesc { mip_levels: 3, ..TextureDesc::d2(640, 360, Format::Rg11b10Ufloat) };
    let mut glow = frame.create_texture("glow", desc);
    let mut down = frame.render_pass("down 0");
    down.sample(from);
    down.subresource(Subresource::FULL.mip(0)).color(&mut glow, Contents::Overwrite);
    for mip in 1..3 {
        let above = glow.clone();
        let mut down = frame.render_pass(format_args!("down {mip}"));
        down.subresource(Subresource::FULL.mip(mip - 1)).sample(&above);
        down.subresource(Subresource::FULL.mip(mip)).color(&mut glow, Contents::Overwrite);
    }
    for mip in (0..2).rev() {
        let below = glow.clone();
        let mut up = frame.render_pass(format_args!("up {mip}"));
        up.subresource(Subresource::FULL.mip(mip + 1)).sample(&below);
        up.subresource(Subresource::FULL.mip(mip)).color(&mut glow, Contents::Preserve);
    }
    glow
}
