//! Explanation of the decisions about a resource.

use super::Page;
use crate::declaration::Origin;
use crate::desc::ResourceDesc;
use crate::dump::describe::{bytes, list, quoted, shape, steps, verb};
use crate::handle::{PassId, ResourceId};
use crate::plan::{AccessPlan, Plan};
use wgpu_types::{BufferUsages, TextureUsages};

impl Plan {
    /// Explains in a few lines where the resource comes from, which passes write and read each version, what each
    /// usage is for, and why the resource is in its slot.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    /// frame.export_texture(&scene);
    /// let why = frame.compile()?.plan().explain_resource(scene.id());
    /// assert!(why.contains("RENDER_ATTACHMENT: `draw` draws into it"));
    /// assert!(why.contains("COPY_SRC: it is exported"));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn explain_resource(&self, id: ResourceId) -> String {
        let resource = self.resource(id);
        let size = bytes(resource.desc.bytes());
        let mut page = Page::new(&format!("`{}`: {}, {size}", self.resource_path(id), shape(&resource.desc)));
        page.line(1, self.describe_origin(id));
        self.write_versions(&mut page, id);
        for usage in self.usages(id) {
            page.line(1, &usage);
        }
        self.write_slot(&mut page, id);
        page.0
    }

    pub(in crate::dump) fn describe_origin(&self, id: ResourceId) -> &'static str {
        let resource = self.resource(id);
        match resource.origin {
            Origin::Transient if resource.exported => {
                "lives from its first write to the end of the frame: it is exported"
            }
            Origin::Transient => "lives within the frame",
            Origin::Imported { defined: true } => {
                "belongs to the caller and is defined when the frame begins"
            }
            Origin::Imported { defined: false } => {
                "belongs to the caller and is undefined when the frame begins"
            }
            Origin::Previous { .. } => "holds the contents from the previous frame",
            Origin::Current { .. } => "is kept for the next frame",
        }
    }

    /// Lists writers and readers in order of declaration. The first write makes version 1.
    fn write_versions(&self, page: &mut Page, id: ResourceId) {
        for (pass, _) in self.passes() {
            for access in self.accesses(pass).filter(|access| access.resource == id) {
                let (verb, role) = verb(access.access);
                let subresource = access.subresource.to_string();
                let subresource = if access.subresource == crate::Subresource::FULL {
                    String::new()
                } else {
                    format!(", {subresource}")
                };
                let at = if access.access.writes() {
                    format!("version {}", access.version + 1)
                } else {
                    format!("version {}", access.version)
                };
                let culled = if self.pass(pass).culled.is_some() { " (culled)" } else { "" };
                let path = self.pass_path(pass);
                page.line(1, &format!("{at}{subresource}: `{path}` {verb} it{role}{culled}"));
            }
        }
    }

    /// Explains each usage flag.
    pub(in crate::dump) fn usages(&self, id: ResourceId) -> Vec<String> {
        let resource = self.resource(id);
        if let Origin::Imported { .. } = resource.origin {
            return vec!["usages: as the caller created it".into()];
        }
        let otherwise = if resource.exported { "it is exported" } else { "the graph needs it" };
        let line = |name: &str, user: Option<String>| {
            format!("{name}: {}", user.unwrap_or_else(|| otherwise.into()))
        };
        match resource.desc {
            ResourceDesc::Texture(_) => {
                let flags = resource.texture_usage.iter_names();
                let user = |flag| match flag {
                    TextureUsages::TRANSIENT_ATTACHMENT => Some("it never leaves its render pass".into()),
                    _ => self.describe_user(id, |access| access.access.texture_usage().contains(flag)),
                };
                flags.map(|(name, flag)| line(name, user(flag))).collect()
            }
            ResourceDesc::Buffer(_) => {
                let flags = resource.buffer_usage.iter_names();
                let user = |flag: BufferUsages| {
                    self.describe_user(id, |access| access.access.buffer_usage().contains(flag))
                };
                flags.map(|(name, flag)| line(name, user(flag))).collect()
            }
        }
    }

    /// Describes the first pass that runs and has such an access.
    fn describe_user(&self, id: ResourceId, uses: impl Fn(&AccessPlan) -> bool) -> Option<String> {
        let mut accesses = self.order().iter().flat_map(|&pass| self.accesses(pass).map(move |a| (pass, a)));
        let (pass, access): (PassId, AccessPlan) = accesses.find(|(_, a)| a.resource == id && uses(a))?;
        let (verb, role) = verb(access.access);
        Some(format!("`{}` {verb} it{role}", self.pass_path(pass)))
    }

    fn write_slot(&self, page: &mut Page, id: ResourceId) {
        let resource = self.resource(id);
        let steps = steps(&resource);
        let Some(slot) = resource.slot else {
            page.line(1, &format!("no slot: {}", self.explain_slot(id)));
            return;
        };
        page.line(1, &format!("slot {}, {steps}: {}", slot.index(), self.explain_slot(id)));
        let Some(plan) = self.slots().nth(slot.index()) else { return };
        let others: Vec<String> =
            plan.resources.iter().filter(|&&r| r != id).map(|&r| quoted(self.resource(r).name)).collect();
        if !others.is_empty() {
            page.line(1, &format!("shares the slot with {}", list(&others, 70)));
        }
    }
}
