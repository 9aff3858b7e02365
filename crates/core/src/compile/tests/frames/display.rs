//! Short text of a frame, for failing tests.

use super::{PassSpec, Spec};
use crate::ResourceDesc;
use std::fmt::{Display, Formatter, Result};

impl Display for Spec {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        writeln!(f, "{:?}", self.options)?;
        for (index, resource) in self.resources.iter().enumerate() {
            write!(f, "r{index}: {:?}, ", resource.origin)?;
            match resource.desc {
                ResourceDesc::Buffer(desc) => writeln!(f, "{} bytes", desc.bytes)?,
                ResourceDesc::Texture(desc) => writeln!(
                    f,
                    "{:?} {}x{}x{} {:?}, {} mips, {} samples",
                    desc.dimension,
                    desc.size.width,
                    desc.size.height,
                    desc.size.depth_or_array_layers,
                    desc.format,
                    desc.mip_levels,
                    desc.samples
                )?,
            }
        }
        self.passes.iter().enumerate().try_for_each(|(index, pass)| write_pass(f, index, pass))?;
        writeln!(f, "exports {:?}", self.exports)
    }
}

fn write_pass(f: &mut Formatter<'_>, index: usize, pass: &PassSpec) -> Result {
    let keep = if pass.keep { ", kept" } else { "" };
    writeln!(f, "p{index}: {:?}{keep}, after {:?}", pass.kind, pass.after)?;
    for access in &pass.accesses {
        let subresource = access.subresource.to_subresource().to_string();
        writeln!(f, "    {:?} of r{}, {subresource}, {:?}", access.access, access.resource, access.contents)?;
    }
    Ok(())
}
