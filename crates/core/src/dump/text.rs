//! The plan as an aligned text table, at most 110 columns wide.

use super::words::bytes;
use crate::access::Contents;
use crate::declaration::{CopyOp, Origin};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId};
use crate::plan::{AccessPlan, PassPlan, Plan, ResourcePlan};
use std::fmt::Write as _;

/// No line is longer; names that would make one so are cut with an ellipsis.
const COLUMNS: usize = 110;

impl Plan {
    /// Returns the plan as text: passes by node with their accesses, loads and stores with reasons, culled passes,
    /// resources, and which of them share a physical texture or buffer.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        self.summary(&mut out);
        self.pass_table(&mut out);
        self.culled_table(&mut out);
        self.resource_table(&mut out);
        self.slot_table(&mut out);
        fit(&out)
    }

    fn summary(&self, out: &mut String) {
        let culled = self.passes.iter().filter(|p| p.culled.is_some()).count();
        let _ = writeln!(
            out,
            "plan: {} passes in {} steps, {culled} culled; {} resources in {} slots of {}, {} saved by sharing\n",
            self.passes.len() - culled,
            self.order.len(),
            self.resources.len(),
            self.slots.len(),
            bytes(self.slot_bytes()),
            bytes(self.saved_bytes()),
        );
    }

    fn pass_table(&self, out: &mut String) {
        out.push_str("passes\n");
        let mut node: Option<NodeId> = None;
        for (step, id) in self.live_passes().enumerate() {
            let pass = self.pass(id);
            if pass.node != node {
                node = pass.node;
                let _ = writeln!(out, "  {}", node.map_or("(no node)".into(), |n| self.node_path(n)));
            }
            let _ = writeln!(out, "    {step:>3}  {:<40} {}", clip(&pass.name, 40), pass.kind.word());
            for access in &pass.accesses {
                self.access_line(out, pass, access);
            }
        }
    }

    fn access_line(&self, out: &mut String, pass: &PassPlan, access: &AccessPlan) {
        let resource = self.resource(access.resource);
        let arrow = if access.access.writes() { "->" } else { "<-" };
        let version = if access.access.writes() { access.version + 1 } else { access.version };
        let name = format!("{} v{version}", clip(&resource.name, 32));
        let upload = pass.copies.iter().any(|copy| matches!(copy, CopyOp::Upload { .. }));
        let note = match access.contents {
            _ if upload => "from the CPU",
            Some(Contents::Preserve) => "preserve",
            Some(Contents::Cover) => "cover",
            _ => "",
        };
        let note = if access.ops.is_some() { "" } else { note };
        let _ = writeln!(out, "         {arrow} {:<14} {name:<36} {note}", access.access.word());
        if let Some(ops) = &access.ops {
            let (load, load_reason) = self.load_words(ops);
            let (store, store_reason) = self.store_words(ops);
            let _ = writeln!(out, "              {load}: {load_reason}");
            let _ = writeln!(out, "              {store}: {store_reason}");
        }
    }

    fn culled_table(&self, out: &mut String) {
        if self.passes.iter().all(|p| p.culled.is_none()) {
            return;
        }
        out.push_str("\nculled\n");
        for (index, pass) in self.passes.iter().enumerate() {
            if let Some(reason) = pass.culled {
                let path = clip(&self.pass_path(PassId(index as u32)), 40);
                let _ = writeln!(out, "  {path:<42} {}", self.cull_words(reason));
            }
        }
    }

    fn resource_table(&self, out: &mut String) {
        let _ = writeln!(
            out,
            "\nresources\n  {:<28} {:<28} {:>9}  {:>7}  {:<8} usage",
            "name", "shape", "size", "steps", "where"
        );
        for resource in &self.resources {
            let steps = resource.steps.map_or("-".into(), |(first, last)| format!("{first}..{last}"));
            let place = match (resource.origin, resource.slot) {
                (Origin::Imported { .. }, _) => "import".into(),
                (_, Some(slot)) => format!("slot {}", slot.index()),
                (_, None) => "unused".into(),
            };
            let _ = writeln!(
                out,
                "  {:<28} {:<28} {:>9}  {steps:>7}  {place:<8} {}",
                clip(&resource.name, 28),
                clip(&shape(&resource.desc), 28),
                bytes(resource.desc.bytes()),
                usage(resource),
            );
        }
    }

    fn slot_table(&self, out: &mut String) {
        if self.slots.is_empty() {
            return;
        }
        out.push_str("\nslots (resources of one slot share one physical texture or buffer)\n");
        for (index, slot) in self.slots.iter().enumerate() {
            let tenants: Vec<_> = slot.tenants.iter().map(|&r| self.resource(r).name.as_str()).collect();
            let shared = if tenants.len() > 1 { "shared: " } else { "" };
            let _ = writeln!(
                out,
                "  {index:>3}  {:<28} {:>9}  {shared}{}",
                clip(&shape(&slot.desc), 28),
                bytes(slot.desc.bytes()),
                tenants.join(", then "),
            );
        }
    }
}

/// Shape in a few words: `1280x720 Rgba16Float`.
fn shape(desc: &ResourceDesc) -> String {
    match desc {
        ResourceDesc::Buffer(_) => "buffer".into(),
        ResourceDesc::Texture(desc) => {
            let mut words = format!("{}x{}", desc.size.width, desc.size.height);
            if desc.size.depth_or_array_layers > 1 {
                let _ = write!(words, "x{}", desc.size.depth_or_array_layers);
            }
            let _ = write!(words, " {:?}", desc.format);
            if desc.samples > 1 {
                let _ = write!(words, " x{} samples", desc.samples);
            }
            words
        }
    }
}

/// Usages in short words, in the order of wgpu's flags.
fn usage(resource: &ResourcePlan) -> String {
    let names: Vec<_> = match resource.desc {
        ResourceDesc::Texture(_) => resource.texture_usage.iter_names().map(|(name, _)| name).collect(),
        ResourceDesc::Buffer(_) => resource.buffer_usage.iter_names().map(|(name, _)| name).collect(),
    };
    let short = |name: &str| match name {
        "TEXTURE_BINDING" => "sampled".into(),
        "STORAGE_BINDING" => "storage".into(),
        "RENDER_ATTACHMENT" => "attached".into(),
        other => other.to_lowercase().replace('_', "-"),
    };
    names.into_iter().map(short).collect::<Vec<String>>().join(" ")
}

/// Cuts `text` to `columns` characters, the last one an ellipsis.
fn clip(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.into();
    }
    let mut cut: String = text.chars().take(columns - 1).collect();
    cut.push('…');
    cut
}

/// Cuts every line to the width and its trailing blanks.
fn fit(text: &str) -> String {
    text.lines().flat_map(|line| [clip(line.trim_end(), COLUMNS), "\n".into()]).collect()
}
