//! Short forms of values, and decisions as sentences, for tools that show plans.
//!
//! The `describe_*` methods of [`Plan`](crate::Plan) know only a reason. The `explain_*` methods also know what it is about, so they say more.

mod memory;
mod passes;

pub use passes::{Position, Positions};

use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{CopyOp, Origin, PassKind};
use crate::desc::ResourceDesc;
use crate::handle::PassId;
use crate::plan::{AccessPlan, Dependency, DependencyKind, Plan, ResourcePlan};
use crate::subresource::RegionSet;
use std::fmt::Write as _;
use wgpu_types::TextureDimension;

/// Formats bytes in a suitable unit.
pub fn bytes(bytes: u64) -> String {
    match bytes {
        0..1_024 => format!("{bytes} B"),
        1_024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1_024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

/// Formats a shape: `1280x720 Rgba16Float`.
pub fn shape(desc: &ResourceDesc) -> String {
    let ResourceDesc::Texture(desc) = desc else { return "buffer".into() };
    let mut out = format!("{}x{}", desc.size.width, desc.size.height);
    let deep = desc.dimension == TextureDimension::D3;
    if desc.size.depth_or_array_layers > 1 || deep {
        let _ = write!(out, "x{}", desc.size.depth_or_array_layers);
    }
    let _ = write!(out, " {:?}", desc.format);
    for (count, unit) in [(desc.samples, "samples"), (desc.mip_levels, "mips")] {
        if count > 1 {
            let _ = write!(out, ", {count} {unit}");
        }
    }
    if deep { out + ", 3D" } else { out }
}

/// Formats usages by short names, in the order of wgpu's flags.
pub(super) fn usage(resource: &ResourcePlan<'_>) -> String {
    match resource.desc {
        ResourceDesc::Texture(_) => {
            let names = resource.texture_usage.iter_names().map(|(name, _)| name);
            names.map(short).collect::<Vec<_>>().join(" ")
        }
        ResourceDesc::Buffer(_) => {
            let names = resource.buffer_usage.iter_names().map(|(name, _)| name);
            names.map(short).collect::<Vec<_>>().join(" ")
        }
    }
}

fn short(flag: &str) -> String {
    match flag {
        "TEXTURE_BINDING" => "sampled".into(),
        "STORAGE_BINDING" => "storage".into(),
        "RENDER_ATTACHMENT" => "attached".into(),
        "TRANSIENT_ATTACHMENT" => "transient".into(),
        other => other.to_lowercase().replace('_', "-"),
    }
}

/// Formats the lifetime of a resource: `step 3`, `steps 0 to 2`.
pub fn steps(resource: &ResourcePlan<'_>) -> String {
    match resource.steps {
        None => "not used".into(),
        Some((first, last)) if first == last => format!("step {first}"),
        Some((first, last)) => format!("steps {first} to {last}"),
    }
}

/// Formats a clear: `clear 0`, `clear 0,0,0,1`.
pub(super) fn clear(value: ClearValue) -> String {
    match value {
        ClearValue::Color(rgba) if rgba == [rgba[0]; 4] => format!("clear {}", number(rgba[0])),
        ClearValue::Color(rgba) => format!("clear {}", rgba.map(number).join(",")),
        ClearValue::Depth(depth) => format!("clear {}", number(depth.into())),
        ClearValue::DepthStencil(depth, stencil) => format!("clear {}/{stencil}", number(depth.into())),
    }
}

/// Formats a number with at most three decimals, or in scientific notation if it would round to 0.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(text, "0" | "-0") && value != 0.0 { format!("{value:e}") } else { text.into() }
}

/// Puts a name in backticks.
pub fn quoted(name: &str) -> String {
    format!("`{name}`")
}

/// Lists the first name and as many others as fit: `` `a`, `b` and 3 more ``.
pub fn list(names: &[String], columns: usize) -> String {
    let shown = |count: usize| {
        let mut words = names[..count].to_vec();
        if count < names.len() {
            words.push(format!("{} more", names.len() - count));
        }
        match words.pop() {
            Some(last) if !words.is_empty() => format!("{} and {last}", words.join(", ")),
            last => last.unwrap_or_default(),
        }
    };
    let fits = |words: &String| words.chars().count() <= columns;
    let mut from_most = (1..=names.len()).rev().map(shown);
    from_most.find(fits).unwrap_or_else(|| shown(names.len().min(1)))
}

/// Cuts text to `columns` characters, the last one an ellipsis.
pub(super) fn clip(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.into();
    }
    let mut cut: String = text.chars().take(columns.saturating_sub(1)).collect();
    cut.push('…');
    cut
}

impl PassKind {
    /// Returns the kind with an article, such as `a render pass`.
    pub(super) fn with_article(self) -> &'static str {
        match self {
            Self::Render => "a render pass",
            Self::Compute => "a compute pass",
            Self::Copy => "a copy pass",
            Self::Encoder => "an encoder pass",
        }
    }
}

impl Access {
    /// Returns a short label, with the index of a colour attachment.
    pub fn label(self) -> String {
        match self {
            Self::Color(index) => format!("color {index}"),
            Self::Resolve(index) => format!("resolve {index}"),
            other => other.as_str().into(),
        }
    }
}

/// Returns the verb before a resource's name and the role after it.
pub fn verb(access: Access) -> (&'static str, String) {
    let (verb, role) = match access {
        Access::Color(index) => return ("draws into", format!(" as colour attachment {index}")),
        Access::Resolve(index) => return ("resolves into", format!(" from colour attachment {index}")),
        Access::Depth => ("draws into", " as depth attachment"),
        Access::DepthRead => ("tests against", " as depth attachment"),
        Access::Sampled => ("samples", ""),
        Access::StorageRead => ("reads", " as storage"),
        Access::StorageWrite => ("writes", " as storage"),
        Access::Uniform => ("reads", " as uniform buffer"),
        Access::Vertex => ("reads", " as vertex buffer"),
        Access::Index => ("reads", " as index buffer"),
        Access::Indirect => ("reads", " as indirect arguments"),
        Access::CopySource => ("copies from", ""),
        Access::CopyTarget => ("copies into", ""),
    };
    (verb, role.into())
}

impl Plan {
    /// Returns the dependencies of a pass on earlier ones. All dependencies are in order of the later pass.
    pub fn waits_for(&self, pass: PassId) -> &[Dependency] {
        let all = self.dependencies();
        let start = all.partition_point(|dependency| dependency.after < pass);
        let end = all.partition_point(|dependency| dependency.after <= pass);
        &all[start..end]
    }

    /// Returns the passes that wrote what the access reads or preserves.
    pub(super) fn writers(&self, pass: PassId, access: &AccessPlan) -> Vec<PassId> {
        let writes = |other: PassId| {
            self.accesses(other).any(|a| {
                a.access.writes() && a.resource == access.resource && a.region.overlaps(&access.region)
            })
        };
        let of = |d: &&Dependency| {
            d.kind == DependencyKind::ReadAfterWrite
                && d.resource == Some(access.resource)
                && writes(d.before)
        };
        let mut writers: Vec<PassId> = self.waits_for(pass).iter().filter(of).map(|d| d.before).collect();
        writers.sort();
        writers
    }

    /// Lists the writers of what the access reads or preserves, in about `columns` columns.
    pub(super) fn describe_source(&self, pass: PassId, access: &AccessPlan, columns: usize) -> String {
        let writers = self.writers(pass, access);
        let mut left = RegionSet::from_region(access.region);
        for written in writers.iter().flat_map(|&writer| self.accesses(writer)) {
            if written.access.writes() && written.resource == access.resource {
                left.subtract(&written.region);
            }
        }
        let before = match self.resource(access.resource).origin {
            Origin::Imported { .. } => Some("the caller"),
            Origin::Previous { .. } => Some("the previous frame"),
            Origin::Transient | Origin::Current { .. } => None,
        };
        let before = before.filter(|_| !left.is_empty()).map(String::from);
        let sources = before.into_iter().chain(writers.iter().map(|&writer| quoted(&self.pass_path(writer))));
        list(&sources.collect::<Vec<_>>(), columns)
    }

    /// Describes where the contents of an access come from, or what happens to the old contents.
    pub fn access_note(&self, pass: PassId, access: &AccessPlan, columns: usize) -> String {
        let uploaded =
            |op: &CopyOp| matches!(op, CopyOp::Upload { target, .. } if *target == access.resource);
        match (access.access, access.contents) {
            (_, None) => match self.describe_source(pass, access, columns) {
                source if source.is_empty() => source,
                source => format!("from {source}"),
            },
            (Access::Resolve(index), _) => {
                let of_index = |a: &AccessPlan| a.access == Access::Color(index);
                let source = self.accesses(pass).find(of_index);
                let name = source.map_or("", |source| self.resource(source.resource).name);
                format!("averages the samples of `{name}`")
            }
            _ if self.pass(pass).copies.iter().any(uploaded) => "uploaded by the CPU".into(),
            (_, Some(Contents::Preserve)) if access.ops.is_none() => {
                match self.describe_source(pass, access, columns) {
                    source if source.is_empty() => "preserves the contents".into(),
                    source => format!("preserves what {source} wrote"),
                }
            }
            (_, Some(Contents::Overwrite)) if access.ops.is_none() => "overwrites it".into(),
            _ => String::new(),
        }
    }
}
