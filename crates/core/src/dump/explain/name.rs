//! Lookup of passes and resources by name.

use crate::dump::describe::{list, quoted};
use crate::error::Error;
use crate::handle::{PassId, ResourceId};
use crate::plan::Plan;
use crate::suggest::closest_name;

impl Plan {
    /// Explains the decisions about every pass and resource of a name. The name is a path, such as `post/blur`, or the last
    /// part of one.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    /// let plan = frame.compile()?.into_plan();
    /// assert!(plan.explain("draw")?.contains("does not run: nothing reads `scene`"));
    /// let error = plan.explain("scenes").unwrap_err().to_string();
    /// assert!(error.ends_with("did you mean `scene`?"), "{error}");
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnknownName`], with a similar name if there is one.
    pub fn explain(&self, name: &str) -> Result<String, Error> {
        let passes = self.passes_named(name).into_iter().map(|id| self.explain_pass(id));
        let resources = self.resources_named(name).into_iter().map(|id| self.explain_resource(id));
        let pages: Vec<String> = passes.chain(resources).collect();
        if pages.is_empty() { Err(self.unknown_name(name)) } else { Ok(pages.join("\n")) }
    }

    /// Explains why a pass runs before another, for every pair of passes of these names.
    ///
    /// # Errors
    /// As [`explain`](Self::explain).
    pub fn explain_order(&self, before: &str, after: &str) -> Result<String, Error> {
        let named = |name: &str| match self.passes_named(name) {
            passes if passes.is_empty() => Err(self.unknown_name(name)),
            passes => Ok(passes),
        };
        let (first, second) = (named(before)?, named(after)?);
        let pairs = first.iter().flat_map(|&first| second.iter().map(move |&second| (first, second)));
        let pages: Vec<String> =
            pairs.map(|(first, second)| self.explain_why_before(first, second)).collect();
        Ok(pages.join("\n"))
    }

    /// Returns the passes of this path, or else those of this name.
    fn passes_named(&self, name: &str) -> Vec<PassId> {
        let ids = || self.passes().map(|(id, _)| id);
        let of_path: Vec<PassId> = ids().filter(|&id| self.pass_path(id) == name).collect();
        if of_path.is_empty() { ids().filter(|&id| self.pass(id).name == name).collect() } else { of_path }
    }

    fn resources_named(&self, name: &str) -> Vec<ResourceId> {
        let ids = || self.resources().map(|(id, _)| id);
        let of_path: Vec<ResourceId> = ids().filter(|&id| self.resource_path(id) == name).collect();
        if of_path.is_empty() {
            ids().filter(|&id| self.resource(id).name == name).collect()
        } else {
            of_path
        }
    }

    fn unknown_name(&self, name: &str) -> Error {
        let unknown = |hint: String| Error::UnknownName { name: name.into(), hint };
        // The caller looked for a pass.
        if !self.resources_named(name).is_empty() {
            return unknown(" that is a pass: it is a resource, and only passes have an order".into());
        }
        let paths = |id| self.pass_path(id);
        let inside =
            |path: &String| path.starts_with(&format!("{name}/")) || path.contains(&format!("/{name}/"));
        let members: Vec<String> =
            self.passes().map(|(id, _)| paths(id)).filter(inside).map(|path| quoted(&path)).collect();
        if !members.is_empty() {
            return unknown(format!(": it is a node with the passes {}", list(&members, 200)));
        }
        let paths = self.passes().flat_map(|(id, pass)| [self.pass_path(id), pass.name.to_owned()]);
        let names =
            paths.chain(self.resources().flat_map(|(id, own)| [self.resource_path(id), own.name.to_owned()]));
        let nearest = closest_name(name, names);
        let hint = match nearest {
            Some(nearest) => format!("; did you mean `{nearest}`?"),
            None => "; `dump` lists all names".into(),
        };
        unknown(hint)
    }
}
