//! Small frames for tests that look at one decision.

use crate::{
    AccessPlan, AttachmentOps, ClearValue, Contents, Format, Frame, PassId, Plan, Rect, Subresource, Texture,
    TextureDesc,
};

pub(super) const BLACK: Contents = Contents::Clear(ClearValue::Color([0.0; 4]));
pub(super) const FAR: Contents = Contents::Clear(ClearValue::Depth(0.0));

/// Creates a colour texture of 64 x 64 texels, 16 KiB.
pub(super) fn color(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(64, 64, Format::Rgba8Unorm))
}

/// Creates a depth texture of 64 x 64 texels.
pub(super) fn depth(frame: &mut Frame<'_>, name: &str) -> Texture {
    frame.create_texture(name, TextureDesc::d2(64, 64, Format::Depth32Float))
}

/// One of the four quarters of a texture of 64 x 64 texels.
pub(super) fn quarter(index: u32) -> Subresource {
    Subresource::FULL.rect(Rect::new(index % 2 * 32, index / 2 * 32, 32, 32))
}

/// Reads `from` and overwrites a new texture.
pub(super) fn filter(frame: &mut Frame<'_>, name: &str, from: &Texture) -> Texture {
    let mut to = color(frame, name);
    let mut pass = frame.render_pass(name);
    pass.sample(from);
    pass.color(&mut to, Contents::Overwrite);
    to
}

/// Draws into a texture in a separate pass.
pub(super) fn draw(frame: &mut Frame<'_>, name: &str, to: &mut Texture, contents: Contents) -> PassId {
    let mut pass = frame.render_pass(name);
    pass.color(to, contents);
    pass.id()
}

/// Samples a texture in a compute pass that is kept.
pub(super) fn look(frame: &mut Frame<'_>, name: &str, at: &Texture) -> PassId {
    let mut pass = frame.compute_pass(name);
    pass.sample(at);
    pass.keep();
    pass.id()
}

pub(super) fn plan(frame: Frame<'_>) -> Plan {
    frame.compile().unwrap().into_plan()
}

pub(super) fn pass(plan: &Plan, name: &str) -> PassId {
    plan.find_pass(name).unwrap()
}

/// Returns the operations of the access with this index.
pub(super) fn ops(plan: &Plan, name: &str, access: usize) -> AttachmentOps {
    accesses(plan, name)[access].ops.unwrap()
}

pub(super) fn accesses(plan: &Plan, name: &str) -> Vec<AccessPlan> {
    plan.accesses(pass(plan, name)).collect()
}

/// Returns the names of the passes that run, in order.
pub(super) fn order(plan: &Plan) -> Vec<&str> {
    plan.order().iter().map(|&id| plan.pass(id).name).collect()
}

/// Returns the names of the passes of each step.
pub(super) fn steps(plan: &Plan) -> Vec<Vec<&str>> {
    plan.steps().map(|step| step.passes.iter().map(|&id| plan.pass(id).name).collect()).collect()
}

/// Returns whether one pass has a dependency on another, by name.
pub(super) fn depends(plan: &Plan, after: &str, before: &str) -> bool {
    let (before, after) = (pass(plan, before), pass(plan, after));
    plan.dependencies().iter().any(|d| (d.before, d.after) == (before, after))
}
