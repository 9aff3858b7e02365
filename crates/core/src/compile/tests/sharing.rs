//! Sharing of slots.

use super::helpers::{BLACK, FAR, color, depth, draw, filter, look, plan};
use crate::{
    BufferDesc, Contents, Format, Frame, Options, Plan, ResourceDesc, SlotReason, TextureDesc, TextureUsages,
};

/// draw -> a -> b -> c -> d, of which a and c, b and d can share.
fn chain() -> Plan {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.node("scene", |frame| draw(frame, "draw", &mut a, BLACK));
    let d = frame.node("post", |frame| {
        let b = filter(frame, "b", &a);
        let c = filter(frame, "c", &b);
        filter(frame, "unused", &c);
        filter(frame, "d", &c)
    });
    frame.export_texture(&d);
    plan(frame)
}

#[test]
fn resources_with_disjoint_lifetimes_share_a_slot() {
    let plan = chain();
    assert_eq!(plan.slots().len(), 2);
    let slots: Vec<_> = plan.resources().map(|(_, r)| r.slot.map(|s| s.0)).collect();
    assert_eq!(slots, [Some(0), Some(1), Some(0), None, Some(1)]);
    assert_eq!(plan.saved_bytes(), 2 * 64 * 64 * 4);
    let usage = plan.slots().nth(1).unwrap().texture_usage;
    assert!(usage.contains(TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING), "{usage:?}");
}

#[test]
fn slots_name_the_previous_resource_and_why_a_new_one_is_needed() {
    let plan = chain();
    let reasons: Vec<_> = plan.resources().map(|(_, r)| r.slot_reason).collect();
    let id = |name: &str| plan.find_resource(name).unwrap();
    let expected = [
        SlotReason::FirstOfClass,
        SlotReason::AllBusy(id("a")),
        SlotReason::After(id("a")),
        SlotReason::Unused,
        SlotReason::After(id("b")),
    ];
    assert_eq!(reasons, expected);
}

#[test]
fn resources_with_different_descriptions_never_share_a_slot() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    draw(&mut frame, "draw", &mut a, BLACK);
    let b = filter(&mut frame, "b", &a);
    let mut wide = frame.create_texture("wide", TextureDesc::d2(65, 64, Format::Rgba8Unorm));
    let mut pass = frame.render_pass("wide");
    pass.sample(&b);
    pass.color(&mut wide, Contents::Overwrite);
    frame.export_texture(&wide);
    assert_eq!(plan(frame).slots().len(), 3);
}

#[test]
fn a_storage_texture_does_not_share_with_a_plain_attachment() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    draw(&mut frame, "draw", &mut a, BLACK);
    let b = filter(&mut frame, "b", &a);
    let mut c = color(&mut frame, "c");
    let mut compute = frame.compute_pass("c");
    compute.sample(&b);
    compute.storage_texture_mut(&mut c, Contents::Overwrite);
    frame.export_texture(&c);
    assert_eq!(plan(frame).slots().len(), 3);
}

/// Fills and copies buffers of these sizes, one after the other.
fn buffers(sizes: [u64; 3], export: bool) -> Plan {
    let mut frame = Frame::new();
    let mut before: Option<crate::Buffer> = None;
    for bytes in sizes {
        let mut buffer = frame.create_buffer(format_args!("{bytes}"), BufferDesc::new(bytes));
        let mut pass = frame.compute_pass("pass");
        if let Some(before) = &before {
            pass.storage_buffer(before);
        }
        pass.storage_buffer_mut(&mut buffer, Contents::Overwrite);
        pass.keep();
        before = Some(buffer);
    }
    if let (true, Some(last)) = (export, &before) {
        frame.export_buffer(last);
    }
    plan(frame)
}

#[test]
fn buffers_of_one_size_class_share_a_slot_of_its_size() {
    let plan = buffers([1_000, 600, 980], false);
    let bytes: Vec<_> = plan.slots().map(|slot| slot.desc.bytes()).collect();
    assert_eq!(bytes, [1_024, 640]);
    assert_eq!(plan.slots().next().unwrap().resources.len(), 2);
}

#[test]
fn an_exported_buffer_has_the_requested_size() {
    let plan = buffers([1_000, 600, 980], true);
    let exported = plan.resource(plan.find_resource("980").unwrap());
    let slot = plan.slots().nth(exported.slot.unwrap().index()).unwrap();
    assert_eq!(slot.desc, ResourceDesc::Buffer(BufferDesc::new(980)));
}

#[test]
fn an_export_keeps_its_slot_to_the_end() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    draw(&mut frame, "draw", &mut a, BLACK);
    let b = filter(&mut frame, "b", &a);
    let c = filter(&mut frame, "c", &b);
    frame.export_texture(&a);
    frame.export_texture(&c);
    let plan = plan(frame);
    assert_eq!(plan.resource(a.id()).steps, Some((0, 2)));
    assert_eq!(plan.slots().len(), 3);
}

#[test]
fn passes_of_one_render_pass_do_not_share_slots() {
    let mut frame = Frame::new();
    frame.fix_order();
    let (mut target, mut a, mut b) = (color(&mut frame, "t"), color(&mut frame, "a"), color(&mut frame, "b"));
    draw(&mut frame, "a", &mut a, BLACK);
    draw(&mut frame, "b", &mut b, BLACK);
    for (name, from) in [("first", &a), ("second", &b)] {
        let contents = if name == "first" { BLACK } else { Contents::Preserve };
        let mut pass = frame.render_pass(name);
        pass.sample(from);
        pass.color(&mut target, contents);
    }
    frame.export_texture(&target);
    let plan = plan(frame);
    assert_eq!(plan.steps().len(), 3);
    assert_eq!(plan.slots().len(), 3);
}

/// A depth buffer that only one render pass needs.
fn transient_depth(options: Options, change: impl FnOnce(&mut Frame<'_>, &crate::Texture)) -> TextureUsages {
    let mut frame = Frame::new();
    frame.set_options(options);
    let (mut out, mut depth) = (color(&mut frame, "out"), depth(&mut frame, "depth"));
    let mut pass = frame.render_pass("draw");
    pass.color(&mut out, BLACK);
    pass.depth(&mut depth, FAR);
    frame.export_texture(&out);
    change(&mut frame, &depth);
    plan(frame).resource(depth.id()).texture_usage
}

#[test]
fn an_attachment_used_in_only_one_render_pass_is_transient() {
    let usage = transient_depth(Options::default(), |_, _| {});
    assert_eq!(usage, TextureUsages::RENDER_ATTACHMENT | TextureUsages::TRANSIENT_ATTACHMENT);
}

#[test]
fn an_attachment_that_is_sampled_or_exported_is_not_transient() {
    let sampled = transient_depth(Options::default(), |frame, depth| {
        look(frame, "look", depth);
    });
    assert_eq!(sampled, TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING);
    let exported = transient_depth(Options::default(), |frame, depth| {
        frame.export_texture(depth);
    });
    assert_eq!(exported, TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC);
}

#[test]
fn transient_attachments_can_be_switched_off() {
    let options = Options { transient_attachments: false, ..Options::default() };
    assert_eq!(transient_depth(options, |_, _| {}), TextureUsages::RENDER_ATTACHMENT);
}

#[test]
fn multisampled_attachments_are_transient_and_their_resolve_targets_are_not() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(64, 64, Format::Rgba8Unorm);
    let mut samples = frame.create_texture("samples", TextureDesc { samples: 4, ..desc });
    let mut target = frame.create_texture("target", desc);
    let mut pass = frame.render_pass("draw");
    pass.color(&mut samples, BLACK);
    pass.resolve(&mut target);
    pass.keep();
    let plan = plan(frame);
    let usage = |texture: &crate::Texture| plan.resource(texture.id()).texture_usage;
    assert!(usage(&samples).contains(TextureUsages::TRANSIENT_ATTACHMENT));
    assert_eq!(usage(&target), TextureUsages::RENDER_ATTACHMENT);
}

#[test]
fn the_same_declaration_gives_the_same_plan() {
    assert_eq!(chain(), chain());
    assert_eq!(chain().to_json().unwrap(), chain().to_json().unwrap());
}

#[test]
fn the_largest_possible_textures_are_refused_and_do_not_overflow() {
    let most = TextureDesc::d2(u32::MAX, u32::MAX, Format::Rgba32Float).layers(u32::MAX);
    assert_eq!(most.bytes(), u64::MAX);
    let mut frame = Frame::new();
    frame.create_texture("most", most);
    assert_eq!(frame.compile().err().unwrap().code(), "SG0401");
    let mut frame = Frame::new();
    frame.create_buffer("most", BufferDesc::new(u64::MAX));
    assert_eq!(frame.compile().err().unwrap().code(), "SG0401");
}
