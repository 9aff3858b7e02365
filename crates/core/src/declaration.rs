//! What a frame declares, as plain data in flat arrays: the only input of the compiler.
//!
//! Two frames whose declarations are equal have the same plan. That is how plans are found again, so everything that
//! the compiler reads must be in here, and nothing else.

use crate::access::{Access, ClearValue, Contents};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId, ResourceId};
use crate::name::{Names, Text};
use crate::subresource::{Region, Subresource};
use serde::Serialize;
use std::ops::Range;
use wgpu_types::{BufferUsages, TextureUsages};

/// What a pass is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum PassKind {
    /// Draws into attachments.
    Render,
    /// Dispatches compute work.
    Compute,
    /// Copies and uploads, done by the graph itself.
    Copy,
    /// Records into the raw encoder.
    Encoder,
}

impl PassKind {
    /// Returns the name of the kind, as the dumps print it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Render => "render",
            Self::Compute => "compute",
            Self::Copy => "copy",
            Self::Encoder => "encoder",
        }
    }
}

impl std::fmt::Display for PassKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

/// One transfer of a copy pass. `source` and `target` are the parts that the pass declares on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum CopyOp {
    /// One texture to another.
    TextureToTexture {
        /// Copied from.
        source: ResourceId,
        /// Copied to.
        target: ResourceId,
    },
    /// One buffer to another.
    BufferToBuffer {
        /// Copied from.
        source: ResourceId,
        /// Copied to.
        target: ResourceId,
    },
    /// A texture to a buffer, rows padded to 256 bytes.
    TextureToBuffer {
        /// Copied from.
        source: ResourceId,
        /// Copied to.
        target: ResourceId,
    },
    /// Bytes from the CPU to a buffer.
    Upload {
        /// Written to.
        target: ResourceId,
        /// Which of the frame's uploads.
        upload: u32,
    },
}

/// Where a resource comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Origin {
    /// Lives within the frame, in a slot of the pool.
    Transient,
    /// Belongs to the caller.
    Imported {
        /// Whether it holds something when the frame begins.
        defined: bool,
    },
    /// What this history held at the end of the frame before. It is only read.
    Previous {
        /// Which of the frame's histories.
        history: u32,
    },
    /// What this history will hold for the next frame.
    Current {
        /// Which of the frame's histories.
        history: u32,
    },
}

impl Origin {
    /// Whether there are contents when the frame begins.
    pub(crate) fn defined(self) -> bool {
        matches!(self, Self::Imported { defined: true } | Self::Previous { .. })
    }

    /// Whether contents are needed after the frame.
    pub(crate) fn outlives(self) -> bool {
        matches!(self, Self::Imported { .. } | Self::Current { .. })
    }
}

/// In which order passes run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum OrderPolicy {
    /// Continue the open render pass if possible, else free the most memory, else keep the order of declaration.
    #[default]
    Automatic,
    /// Free the most memory, else keep the order of declaration.
    Memory,
    /// The order of declaration, fixed.
    Declared,
}

/// What the compiler may do with a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Options {
    /// In which order passes run.
    pub order: OrderPolicy,
    /// Whether neighbouring render passes with the same attachments become one.
    pub merge: bool,
    /// Whether attachments that never leave a render pass get memory of their own kind
    /// (`TextureUsages::TRANSIENT_ATTACHMENT`), which costs nothing on GPUs that draw in tiles.
    pub transient_attachments: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { order: OrderPolicy::Automatic, merge: true, transient_attachments: true }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NodeDecl {
    pub(crate) name: Text,
    pub(crate) parent: Option<NodeId>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PassDecl {
    pub(crate) name: Text,
    pub(crate) node: Option<NodeId>,
    pub(crate) kind: PassKind,
    pub(crate) keep: bool,
    pub(crate) accesses: (u32, u32),
    pub(crate) copies: (u32, u32),
    /// The resource that it attaches first.
    pub(crate) attachment: Option<ResourceId>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AccessDecl {
    pub(crate) resource: ResourceId,
    pub(crate) access: Access,
    pub(crate) contents: WriteMode,
    /// The version read, or written over.
    pub(crate) version: u32,
    /// Which of the frame's parts; [`ALL_OF_RESOURCE`] for all of the resource.
    pub(crate) subresource: u32,
}

pub(crate) const ALL_OF_RESOURCE: u32 = u32::MAX;

/// What an access does with the contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WriteMode {
    /// Nothing: it reads.
    ReadOnly,
    /// Clears them to one of the frame's clear values.
    Clear(u32),
    /// Covers them.
    Overwrite,
    /// Writes among them.
    Preserve,
}

impl WriteMode {
    /// Whether the earlier contents are needed.
    pub(crate) fn needs(self) -> bool {
        matches!(self, Self::ReadOnly | Self::Preserve)
    }

    pub(crate) fn writes(self) -> bool {
        self != Self::ReadOnly
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SubresourceDecl {
    pub(crate) subresource: Subresource,
    pub(crate) region: Region,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ResourceDecl {
    pub(crate) name: Text,
    pub(crate) node: Option<NodeId>,
    pub(crate) desc: ResourceDesc,
    pub(crate) origin: Origin,
    /// How many writes have been declared.
    pub(crate) version: u32,
    /// The version that is taken out of the frame.
    pub(crate) exported: Option<u32>,
    /// Whether any access is to a part of it.
    pub(crate) has_partial_accesses: bool,
    /// Usages asked for from outside (exports), or allowed by the caller's object (imports).
    pub(crate) texture_usage: TextureUsages,
    pub(crate) buffer_usage: BufferUsages,
}

/// All of a frame's declarations.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Declaration {
    pub(crate) options: Options,
    pub(crate) resources: Vec<ResourceDecl>,
    pub(crate) passes: Vec<PassDecl>,
    pub(crate) accesses: Vec<AccessDecl>,
    pub(crate) nodes: Vec<NodeDecl>,
    pub(crate) subresources: Vec<SubresourceDecl>,
    pub(crate) clears: Vec<ClearValue>,
    pub(crate) copies: Vec<CopyOp>,
    /// Orders asked for by name: the first before the second.
    pub(crate) after: Vec<(PassId, PassId)>,
    pub(crate) names: Names,
}

impl Declaration {
    pub(crate) fn clear(&mut self) {
        let Self { options, resources, passes, accesses, nodes, subresources, clears, copies, after, names } =
            self;
        *options = Options::default();
        resources.clear();
        passes.clear();
        accesses.clear();
        nodes.clear();
        subresources.clear();
        clears.clear();
        copies.clear();
        after.clear();
        names.clear();
    }

    pub(crate) fn pass(&self, id: PassId) -> &PassDecl {
        &self.passes[id.index()]
    }

    pub(crate) fn resource(&self, id: ResourceId) -> &ResourceDecl {
        &self.resources[id.index()]
    }

    pub(crate) fn access_range(&self, id: PassId) -> Range<usize> {
        let (start, end) = self.pass(id).accesses;
        start as usize..end as usize
    }

    pub(crate) fn accesses(&self, id: PassId) -> &[AccessDecl] {
        &self.accesses[self.access_range(id)]
    }

    pub(crate) fn copies(&self, id: PassId) -> &[CopyOp] {
        let (start, end) = self.pass(id).copies;
        &self.copies[start as usize..end as usize]
    }

    pub(crate) fn pass_ids(&self) -> impl DoubleEndedIterator<Item = PassId> + use<> {
        (0..self.passes.len() as u32).map(PassId)
    }

    /// The box that the access touches; `None` for all of the resource.
    #[inline]
    pub(crate) fn region(&self, access: &AccessDecl) -> Option<&Region> {
        self.subresources.get(access.subresource as usize).map(|subresource| &subresource.region)
    }

    /// Whether two accesses to one resource have any of it in common.
    #[inline]
    pub(crate) fn overlap(&self, a: &AccessDecl, b: &AccessDecl) -> bool {
        match (self.region(a), self.region(b)) {
            (Some(a), Some(b)) => a.overlaps(b),
            _ => true,
        }
    }

    /// Whether the first of two accesses to one resource touches all that the second does.
    #[inline]
    pub(crate) fn covers(&self, a: &AccessDecl, b: &AccessDecl) -> bool {
        match (self.region(a), self.region(b)) {
            (None, _) => true,
            (Some(_), None) => false,
            (Some(a), Some(b)) => a.contains(b),
        }
    }

    pub(crate) fn subresource(&self, access: &AccessDecl) -> Subresource {
        self.subresources
            .get(access.subresource as usize)
            .map_or(Subresource::FULL, |subresource| subresource.subresource)
    }

    pub(crate) fn contents(&self, access: &AccessDecl) -> Option<Contents> {
        match access.contents {
            WriteMode::ReadOnly => None,
            WriteMode::Clear(clear) => Some(Contents::Clear(self.clears[clear as usize])),
            WriteMode::Overwrite => Some(Contents::Overwrite),
            WriteMode::Preserve => Some(Contents::Preserve),
        }
    }

    /// Who made this version of a resource. Version 0 is what was there at first.
    pub(crate) fn writer(&self, resource: ResourceId, version: u32) -> Option<PassId> {
        let made = version.checked_sub(1)?;
        self.pass_ids().find(|&pass| {
            let mut accesses = self.accesses(pass).iter();
            accesses.any(|a| a.resource == resource && a.contents.writes() && a.version == made)
        })
    }

    pub(crate) fn resource_name(&self, id: ResourceId) -> &str {
        self.names.get(self.resource(id).name)
    }

    /// The pass's name with its nodes before it: `post/blur`.
    pub(crate) fn pass_path(&self, id: PassId) -> String {
        let mut path = String::new();
        self.write_pass_path(id, &mut path);
        path
    }

    /// Appends what [`pass_path`](Self::pass_path) returns.
    pub(crate) fn write_pass_path(&self, id: PassId, path: &mut String) {
        let pass = self.pass(id);
        if let Some(node) = pass.node {
            self.write_node_path(node, path);
            path.push('/');
        }
        path.push_str(self.names.get(pass.name));
    }

    /// The resource's name with the nodes that it was declared in before it.
    pub(crate) fn resource_path(&self, id: ResourceId) -> String {
        let mut path = String::new();
        if let Some(node) = self.resource(id).node {
            self.write_node_path(node, &mut path);
            path.push('/');
        }
        path + self.resource_name(id)
    }

    pub(crate) fn write_node_path(&self, id: NodeId, path: &mut String) {
        let node = &self.nodes[id.index()];
        if let Some(parent) = node.parent {
            self.write_node_path(parent, path);
            path.push('/');
        }
        path.push_str(self.names.get(node.name));
    }

    /// Compares two frames. What is short, or often differs, comes first.
    pub(crate) fn similarity(&self, other: &Self) -> FrameSimilarity {
        let Self { options, resources, passes, accesses, nodes, subresources, clears, copies, after, names } =
            self;
        let alike = resources.len() == other.resources.len()
            && passes.len() == other.passes.len()
            && accesses.len() == other.accesses.len()
            && *options == other.options
            && *clears == other.clears
            && *names == other.names
            && *subresources == other.subresources
            && *nodes == other.nodes
            && *copies == other.copies
            && *after == other.after
            && *passes == other.passes
            && *accesses == other.accesses;
        if !alike {
            return FrameSimilarity::Other;
        }
        let pairs = || resources.iter().zip(&other.resources);
        if pairs().all(|(a, b)| a == b) {
            FrameSimilarity::Same
        } else if pairs().all(|(a, b)| a.same_but_for_size(b)) {
            FrameSimilarity::OtherSizes
        } else {
            FrameSimilarity::Other
        }
    }
}

/// How two frames compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameSimilarity {
    Same,
    /// The same but for the sizes of textures and buffers.
    OtherSizes,
    Other,
}

impl ResourceDecl {
    fn same_but_for_size(&self, other: &Self) -> bool {
        let desc = match (self.desc, other.desc) {
            (ResourceDesc::Texture(own), ResourceDesc::Texture(other)) => {
                ResourceDesc::Texture(crate::TextureDesc { size: other.size, ..own })
            }
            (ResourceDesc::Buffer(_), ResourceDesc::Buffer(_)) => other.desc,
            (own, _) => own,
        };
        Self { desc, ..*self } == *other
    }
}
