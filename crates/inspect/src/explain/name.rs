//! Lookup of passes and resources by name.

use super::{explain_pass, explain_resource, explain_why_before};
use crate::Error;
use shadowgraph_core::describe::{list, quoted};
use shadowgraph_core::{PassId, Plan, ResourceId, closest_name};

/// Explains the decisions about every pass and resource of a name. The name is a path, such as `post/blur`, or the last
/// part of one.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
/// use shadowgraph_inspect::explain;
/// let mut frame = Frame::new();
/// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
/// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
/// let plan = frame.compile()?.into_plan();
/// assert!(explain(&plan, "draw")?.contains("does not run: nothing reads `scene`"));
/// let error = explain(&plan, "scenes").unwrap_err().to_string();
/// assert!(error.ends_with("did you mean `scene`?"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::UnknownName`], with a similar name if there is one.
pub fn explain(plan: &Plan, name: &str) -> Result<String, Error> {
    let passes = passes_named(plan, name).into_iter().map(|id| explain_pass(plan, id));
    let resources = resources_named(plan, name).into_iter().map(|id| explain_resource(plan, id));
    let pages: Vec<String> = passes.chain(resources).collect();
    if pages.is_empty() { Err(unknown_name(plan, name)) } else { Ok(pages.join("\n")) }
}

/// Explains why a pass runs before another, for every pair of passes of these names.
///
/// # Errors
/// As [`explain`].
pub fn explain_order(plan: &Plan, before: &str, after: &str) -> Result<String, Error> {
    let named = |name: &str| match passes_named(plan, name) {
        passes if passes.is_empty() => Err(unknown_name(plan, name)),
        passes => Ok(passes),
    };
    let (first, second) = (named(before)?, named(after)?);
    let pairs = first.iter().flat_map(|&first| second.iter().map(move |&second| (first, second)));
    let pages: Vec<String> = pairs.map(|(first, second)| explain_why_before(plan, first, second)).collect();
    Ok(pages.join("\n"))
}

/// Returns the passes of this path, or else those of this name.
fn passes_named(plan: &Plan, name: &str) -> Vec<PassId> {
    let ids = || plan.passes().map(|(id, _)| id);
    let of_path: Vec<PassId> = ids().filter(|&id| plan.pass_path(id) == name).collect();
    if of_path.is_empty() { ids().filter(|&id| plan.pass(id).name == name).collect() } else { of_path }
}

fn resources_named(plan: &Plan, name: &str) -> Vec<ResourceId> {
    let ids = || plan.resources().map(|(id, _)| id);
    let of_path: Vec<ResourceId> = ids().filter(|&id| plan.resource_path(id) == name).collect();
    if of_path.is_empty() { ids().filter(|&id| plan.resource(id).name == name).collect() } else { of_path }
}

fn unknown_name(plan: &Plan, name: &str) -> Error {
    let unknown = |hint: String| Error::UnknownName { name: name.into(), hint };
    // The caller looked for a pass.
    if !resources_named(plan, name).is_empty() {
        return unknown(" that is a pass: it is a resource, and only passes have an order".into());
    }
    let paths = |id| plan.pass_path(id);
    let inside = |path: &String| path.starts_with(&format!("{name}/")) || path.contains(&format!("/{name}/"));
    let members: Vec<String> =
        plan.passes().map(|(id, _)| paths(id)).filter(inside).map(|path| quoted(&path)).collect();
    if !members.is_empty() {
        return unknown(format!(": it is a node with the passes {}", list(&members, 200)));
    }
    let paths = plan.passes().flat_map(|(id, pass)| [plan.pass_path(id), pass.name.to_owned()]);
    let names =
        paths.chain(plan.resources().flat_map(|(id, own)| [plan.resource_path(id), own.name.to_owned()]));
    let nearest = closest_name(name, names);
    let hint = match nearest {
        Some(nearest) => format!("; did you mean `{nearest}`?"),
        None => "; `dump` lists all names".into(),
    };
    unknown(hint)
}
