//! Explanation of the decisions about a pass.

use super::Page;
use shadowgraph_core::describe::{Position, Positions, verb};
use shadowgraph_core::{AccessPlan, DependencyKind, PassId, Plan, Subresource};

/// Explains in a few lines why the pass runs or not, why at this position and in this render pass, and for each access
/// where the contents come from and what happens to them.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
/// use shadowgraph_inspect::explain_pass;
/// let mut frame = Frame::new();
/// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
/// let mut draw = frame.render_pass("draw");
/// draw.color(&mut scene, Contents::clear_color([0.0; 4]));
/// let draw = draw.id();
/// let why = explain_pass(frame.compile()?.plan(), draw);
/// assert!(why.contains("does not run: nothing reads `scene`"));
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
pub fn explain_pass(plan: &Plan, id: PassId) -> String {
    let pass = plan.pass(id);
    let mut page = Page::new(&format!("{} pass `{}`", pass.kind.as_str(), plan.pass_path(id)));
    match (pass.culled, Positions::new(plan).get(id)) {
        (Some(reason), _) => page.line(1, &format!("does not run: {}", plan.describe_cull(reason))),
        (None, Some(position)) => write_position(plan, &mut page, id, position),
        (None, None) => {}
    }
    for note in plan.pass_notes(id) {
        page.line(1, note);
    }
    for access in plan.accesses(id) {
        write_pass_access(plan, &mut page, id, &access);
    }
    page.0
}

fn write_position(plan: &Plan, page: &mut Page, id: PassId, position: Position) {
    page.line(1, &format!("runs: {}", plan.explain_live(id)));
    let last = plan.steps().len().saturating_sub(1);
    let reason = plan.order_reason(id).map(|reason| plan.describe_order(reason)).unwrap_or_default();
    page.line(1, &format!("step {} (0 to {last}): {reason}", position.step));
    let what = if position.within > 0 { "merged with the previous pass" } else { "not merged" };
    page.line(1, &format!("{what}: {}", plan.explain_merge(position.order)));
    if position.passes > 1 {
        let number = position.within + 1;
        page.line(1, &format!("pass {number} of {} in this render pass", position.passes));
    }
    // The notes of accesses name the writers.
    for dependency in plan.waits_for(id) {
        if dependency.kind != DependencyKind::ReadAfterWrite {
            page.line(1, &format!("waits: {}", plan.explain_dependency(dependency)));
        }
    }
}

fn write_pass_access(plan: &Plan, page: &mut Page, pass: PassId, access: &AccessPlan) {
    let name = plan.resource(access.resource).name;
    let subresource = if access.subresource == Subresource::FULL {
        String::new()
    } else {
        access.subresource.to_string() + " of "
    };
    let (verb, role) = verb(access.access);
    let mut line = format!("{verb} {subresource}`{name}`{role}");
    if plan.pass(pass).culled.is_none() {
        let note = plan.access_note(pass, access, 70);
        line += if note.is_empty() { "" } else { ": " };
        line += &note;
    }
    page.line(1, &line);
    let Some(ops) = &access.ops else { return };
    let (action, reason) = plan.explain_load(access, ops);
    page.line(2, &format!("{action}: {reason}"));
    if let Some((action, reason)) = plan.explain_drawn_clear(access, ops) {
        page.line(2, &format!("{action}: {reason}"));
    }
    let (action, reason) = plan.explain_store(pass, access, ops);
    page.line(2, &format!("{action}: {reason}"));
}
