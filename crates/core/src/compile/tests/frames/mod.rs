//! Frames as plain data: generated from bytes, declared with the builder, and used as truth by the oracle.
//!
//! This folder and `oracle` use the crate's public names only, so that a fuzz target can include both.

mod build;
mod cells;
mod chains;
mod generate;
mod invalid;
mod passes;
mod random_calls;
mod resources;
mod source;
mod transfers;

pub(super) use build::Names;
pub(super) use cells::{Cell, Cells, cells_of};
pub(super) use chains::chain_from_bytes;
pub(super) use generate::{frame_from_bytes, small_frame_from_bytes};
pub(super) use invalid::INVALID_CHANGES;
pub(super) use random_calls::random_calls_from_bytes;
pub(super) use source::Source;

use crate::{
    Access, Aspect, ClearValue, Contents, Options, Origin, PassKind, Rect, ResourceDesc, Subresource,
    TextureDesc,
};
use std::fmt::{Display, Formatter};
use wgpu_types::TextureDimension;

/// The declarations of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Spec {
    pub(super) options: Options,
    /// `Previous` and `Current` of a history follow each other.
    pub(super) resources: Vec<ResourceSpec>,
    pub(super) passes: Vec<PassSpec>,
    /// Indices of exported resources.
    pub(super) exports: Vec<usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ResourceSpec {
    pub(super) desc: ResourceDesc,
    pub(super) origin: Origin,
    /// Created and filled by an upload.
    pub(super) uploaded: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct PassSpec {
    pub(super) kind: PassKind,
    pub(super) keep: bool,
    /// Number of nodes around it.
    pub(super) nodes: usize,
    /// Explicit orders, as indices in the list of passes.
    pub(super) after: Vec<usize>,
    pub(super) accesses: Vec<AccessSpec>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AccessSpec {
    pub(super) resource: usize,
    pub(super) access: Access,
    /// Contents of a write; `None` for a read.
    pub(super) contents: Option<Contents>,
    pub(super) subresource: SubresourceSpec,
}

/// The fields of a [`Subresource`]; `None` stands for all.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SubresourceSpec {
    pub(super) mips: Option<(u32, u32)>,
    pub(super) layers: Option<(u32, u32)>,
    pub(super) aspect: Aspect,
    pub(super) rect: Option<Rect>,
    pub(super) bytes: Option<(u64, u64)>,
}

impl AccessSpec {
    /// Returns whether it needs the earlier contents.
    pub(super) fn needs(&self) -> bool {
        matches!(self.contents, None | Some(Contents::Preserve))
    }

    pub(super) fn writes(&self) -> bool {
        self.contents.is_some()
    }

    /// Returns whether it is an attachment with load and store operations.
    pub(super) fn drawn(&self) -> bool {
        matches!(self.access, Access::Color(_) | Access::Depth)
    }

    /// Returns whether it is an attachment.
    pub(super) fn attached(&self) -> bool {
        self.drawn() || self.access == Access::DepthRead
    }
}

impl PassSpec {
    pub(super) fn new(kind: PassKind) -> Self {
        Self { kind, keep: false, nodes: 0, after: Vec::new(), accesses: Vec::new() }
    }

    /// Returns whether it is the pass of an upload, which the builder adds itself.
    pub(super) fn uploads(&self) -> bool {
        self.kind == PassKind::Copy && self.accesses.len() == 1
    }
}

impl SubresourceSpec {
    pub(super) fn to_subresource(self) -> Subresource {
        let mut subresource = Subresource::FULL.aspect(self.aspect);
        if let Some((start, end)) = self.mips {
            subresource = subresource.mips(start..end);
        }
        if let Some((start, end)) = self.layers {
            subresource = subresource.layers(start..end);
        }
        if let Some(rect) = self.rect {
            subresource = subresource.rect(rect);
        }
        if let Some((start, end)) = self.bytes {
            subresource = subresource.bytes(start..end);
        }
        subresource
    }

    /// Returns all of the mips and layers that it uses, of the same aspects.
    pub(super) fn without_rect(self) -> Self {
        Self { rect: None, ..self }
    }

    /// Returns what wgpu tracks together with it within one pass: all of its mips and layers, every slice of a volume.
    pub(super) fn tracked(self, desc: &TextureDesc) -> Self {
        Self { rect: None, aspect: Aspect::All, ..self.with_all_slices(desc) }
    }

    /// Returns what a discarded attachment discards: for a volume every slice of the mip.
    pub(super) fn with_all_slices(self, desc: &TextureDesc) -> Self {
        let volume = desc.dimension == TextureDimension::D3;
        if volume { Self { layers: None, ..self } } else { self }
    }

    /// Returns all of the mips and layers that it uses.
    pub(super) fn subresources(self) -> Self {
        Self { rect: None, aspect: Aspect::All, ..self }
    }
}

impl Spec {
    pub(super) fn desc(&self, resource: usize) -> &ResourceDesc {
        &self.resources[resource].desc
    }

    /// Returns the same frame with textures scaled in width and height, and the same subresources.
    pub(super) fn scaled(&self, factor: u32) -> Self {
        let mut scaled = self.clone();
        for resource in &mut scaled.resources {
            if let ResourceDesc::Texture(desc) = &mut resource.desc {
                desc.size.width *= factor;
                desc.size.height *= factor;
            }
        }
        scaled
    }

    /// Returns the same frame with other values in place of those that attachments are cleared to.
    pub(super) fn with_other_clears(&self) -> Self {
        let mut other = self.clone();
        for access in other.passes.iter_mut().flat_map(|pass| &mut pass.accesses) {
            if let Some(Contents::Clear(value)) = &mut access.contents {
                *value = match *value {
                    ClearValue::Color(color) => ClearValue::Color(color.map(|channel| channel + 8.0)),
                    ClearValue::Depth(depth) => ClearValue::Depth(0.5 * depth + 0.25),
                    ClearValue::DepthStencil(depth, stencil) => {
                        ClearValue::DepthStencil(0.5 * depth + 0.25, stencil)
                    }
                };
            }
        }
        other
    }

    pub(super) fn is_exported(&self, resource: usize) -> bool {
        self.exports.contains(&resource)
    }

    /// Returns whether the contents are needed after the frame.
    pub(super) fn outlives(&self, resource: usize) -> bool {
        let origin = self.resources[resource].origin;
        self.is_exported(resource) || matches!(origin, Origin::Imported { .. } | Origin::Current { .. })
    }
}

/// Short text for failing tests.
impl Display for Spec {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
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

fn write_pass(f: &mut Formatter<'_>, index: usize, pass: &PassSpec) -> std::fmt::Result {
    let keep = if pass.keep { ", kept" } else { "" };
    writeln!(f, "p{index}: {:?}{keep}, after {:?}", pass.kind, pass.after)?;
    for access in &pass.accesses {
        let subresource = access.subresource.to_subresource().to_string();
        writeln!(f, "    {:?} of r{}, {subresource}, {:?}", access.access, access.resource, access.contents)?;
    }
    Ok(())
}
