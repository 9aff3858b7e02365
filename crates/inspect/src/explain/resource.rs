//! Explanation of the decisions about a resource.

use super::Page;
use shadowgraph_core::describe::{bytes, list, quoted, shape, steps, verb};
use shadowgraph_core::{
    AccessPlan, BufferUsages, Origin, PassId, Plan, ResourceDesc, ResourceId, Subresource, TextureUsages,
};

/// Explains in a few lines where the resource comes from, which passes write and read each version, what each
/// usage is for, and why the resource is in its slot.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
/// use shadowgraph_inspect::explain_resource;
/// let mut frame = Frame::new();
/// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
/// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
/// frame.export_texture(&scene);
/// let why = explain_resource(frame.compile()?.plan(), scene.id());
/// assert!(why.contains("RENDER_ATTACHMENT: `draw` draws into it"));
/// assert!(why.contains("COPY_SRC: it is exported"));
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
pub fn explain_resource(plan: &Plan, id: ResourceId) -> String {
    let resource = plan.resource(id);
    let size = bytes(resource.desc.bytes());
    let mut page = Page::new(&format!("`{}`: {}, {size}", plan.resource_path(id), shape(&resource.desc)));
    page.line(1, describe_origin(plan, id));
    for note in plan.resource_notes(id) {
        page.line(1, note);
    }
    write_versions(plan, &mut page, id);
    for usage in usages(plan, id) {
        page.line(1, &usage);
    }
    write_slot(plan, &mut page, id);
    page.0
}

pub(crate) fn describe_origin(plan: &Plan, id: ResourceId) -> &'static str {
    let resource = plan.resource(id);
    match resource.origin {
        Origin::Transient if resource.exported => {
            "lives from its first write to the end of the frame: it is exported"
        }
        Origin::Transient => "lives within the frame",
        Origin::Imported { defined: true } => "belongs to the caller and is defined when the frame begins",
        Origin::Imported { defined: false } => "belongs to the caller and is undefined when the frame begins",
        Origin::Previous { .. } => "holds the contents from the previous frame",
        Origin::Current { .. } => "is kept for the next frame",
    }
}

/// Lists writers and readers in order of declaration. The first write makes version 1.
fn write_versions(plan: &Plan, page: &mut Page, id: ResourceId) {
    for (pass, _) in plan.passes() {
        for access in plan.accesses(pass).filter(|access| access.resource == id) {
            let (verb, role) = verb(access.access);
            let subresource = access.subresource.to_string();
            let subresource = if access.subresource == Subresource::FULL {
                String::new()
            } else {
                format!(", {subresource}")
            };
            let at = if access.access.writes() {
                format!("version {}", access.version + 1)
            } else {
                format!("version {}", access.version)
            };
            let culled = if plan.pass(pass).culled.is_some() { " (culled)" } else { "" };
            let path = plan.pass_path(pass);
            page.line(1, &format!("{at}{subresource}: `{path}` {verb} it{role}{culled}"));
        }
    }
}

/// Explains each usage flag.
pub(crate) fn usages(plan: &Plan, id: ResourceId) -> Vec<String> {
    let resource = plan.resource(id);
    if let Origin::Imported { .. } = resource.origin {
        return vec!["usages: as the caller created it".into()];
    }
    let otherwise = if resource.exported { "it is exported" } else { "the graph needs it" };
    let line =
        |name: &str, user: Option<String>| format!("{name}: {}", user.unwrap_or_else(|| otherwise.into()));
    match resource.desc {
        ResourceDesc::Texture(_) => {
            let flags = resource.texture_usage.iter_names();
            let user = |flag| match flag {
                TextureUsages::TRANSIENT_ATTACHMENT => Some("it never leaves its render pass".into()),
                _ => describe_user(plan, id, |access| access.access.texture_usage().contains(flag)),
            };
            flags.map(|(name, flag)| line(name, user(flag))).collect()
        }
        ResourceDesc::Buffer(_) => {
            let flags = resource.buffer_usage.iter_names();
            let user = |flag: BufferUsages| {
                describe_user(plan, id, |access| access.access.buffer_usage().contains(flag))
            };
            flags.map(|(name, flag)| line(name, user(flag))).collect()
        }
    }
}

/// Describes the first pass that runs and has such an access.
fn describe_user(plan: &Plan, id: ResourceId, uses: impl Fn(&AccessPlan) -> bool) -> Option<String> {
    let mut accesses = plan.order().iter().flat_map(|&pass| plan.accesses(pass).map(move |a| (pass, a)));
    let (pass, access): (PassId, AccessPlan) = accesses.find(|(_, a)| a.resource == id && uses(a))?;
    let (verb, role) = verb(access.access);
    Some(format!("`{}` {verb} it{role}", plan.pass_path(pass)))
}

fn write_slot(plan: &Plan, page: &mut Page, id: ResourceId) {
    let resource = plan.resource(id);
    let steps = steps(&resource);
    let Some(slot) = resource.slot else {
        page.line(1, &format!("no slot: {}", plan.explain_slot(id)));
        return;
    };
    page.line(1, &format!("slot {}, {steps}: {}", slot.index(), plan.explain_slot(id)));
    let Some(shared) = plan.slots().nth(slot.index()) else { return };
    let others: Vec<String> =
        shared.resources.iter().filter(|&&r| r != id).map(|&r| quoted(plan.resource(r).name)).collect();
    if !others.is_empty() {
        page.line(1, &format!("shares the slot with {}", list(&others, 70)));
    }
}
