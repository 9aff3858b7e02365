//! Explanation of the order of two passes.

use super::Page;
use shadowgraph_core::describe::Positions;
use shadowgraph_core::{Dependency, OrderReason, PassId, Plan};

/// Explains why `before` runs before `after`: the shortest chain of dependencies from one to the other, one on each
/// line, or that nothing orders them. See [`Plan::why_before`] for the chain itself.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
/// use shadowgraph_inspect::explain_why_before;
/// let mut frame = Frame::new();
/// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
/// let mut image = frame.create_texture("image", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
/// let mut draw = frame.render_pass("draw");
/// draw.color(&mut scene, Contents::clear_color([0.0; 4]));
/// let draw = draw.id();
/// let mut tonemap = frame.render_pass("tonemap");
/// tonemap.sample(&scene);
/// tonemap.color(&mut image, Contents::Overwrite);
/// let tonemap = tonemap.id();
/// frame.export_texture(&image);
/// let why = explain_why_before(frame.compile()?.plan(), draw, tonemap);
/// assert!(why.contains("`tonemap` needs what `draw` wrote to `scene`"));
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
pub fn explain_why_before(plan: &Plan, before: PassId, after: PassId) -> String {
    let (first, second) = (plan.pass_path(before), plan.pass_path(after));
    for (pass, path) in [(before, &first), (after, &second)] {
        if let Some(reason) = plan.pass(pass).culled {
            return Page::new(&format!("`{path}` does not run: {}", plan.describe_cull(reason))).0;
        }
    }
    if before == after {
        return Page::new(&format!("`{first}` and `{second}` are the same pass")).0;
    }
    if let Some(chain) = plan.why_before(before, after) {
        return explain_chain(plan, &format!("`{first}` runs before `{second}`"), &chain);
    }
    if let Some(chain) = plan.why_before(after, before) {
        return explain_chain(plan, &format!("`{first}` runs after `{second}`"), &chain);
    }
    let positions = Positions::new(plan);
    let at = |pass| positions.get(pass).map(|position| position.order);
    let (early, late) = if at(before) < at(after) { (before, after) } else { (after, before) };
    let mut page = Page::new(&format!("nothing orders `{first}` and `{second}`"));
    page.line(1, &format!("`{}` runs first: {}", plan.pass_path(early), explain_choice(plan, early, late)));
    page.0
}

/// Explains why `early` was scheduled before `late`, although nothing orders them.
fn explain_choice(plan: &Plan, early: PassId, late: PassId) -> String {
    let positions = Positions::new(plan);
    let at = |pass| positions.get(pass).map(|position| position.order);
    let reason = plan.order_reason(early);
    let chosen = !matches!(
        reason,
        Some(OrderReason::Fixed | OrderReason::DeclarationNeedsLess | OrderReason::BackwardsNeedsLess)
    );
    let undone = plan.waits_for(late).iter().map(|d| d.before).filter(|&pass| at(pass) > at(early)).min();
    match (undone, reason) {
        (Some(pass), _) if chosen => {
            format!("`{}` was still waiting for `{}`", plan.pass_path(late), plan.pass_path(pass))
        }
        (_, reason) => reason.map(|reason| plan.describe_order(reason)).unwrap_or_default(),
    }
}

fn explain_chain(plan: &Plan, heading: &str, chain: &[Dependency]) -> String {
    let mut page = Page::new(heading);
    for dependency in chain {
        page.line(1, &plan.explain_dependency(dependency));
    }
    page.0
}
