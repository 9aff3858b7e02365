//! The declaration of a frame, as plain data in flat arrays: the only input of the compiler.
//!
//! Two frames with equal declarations have the same plan, so plans are reused by comparing declarations. Therefore
//! everything that the compiler reads must be in here, and nothing else.

use crate::access::{Access, ClearValue, Contents};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId, ResourceId};
use crate::name::{Names, Text};
use crate::pass_name::{PassName, SourceLocations};
use crate::subresource::{Region, Subresource};
use serde::Serialize;
use std::ops::Range;
use wgpu_types::{BufferUsages, TextureUsages};

/// The kind of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum PassKind {
    /// Draws into attachments.
    Render,
    /// Dispatches compute work.
    Compute,
    /// Copies and uploads, recorded by the graph.
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

/// One copy of a copy pass. The pass declares the subresources of `source` and `target`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum CopyOp {
    /// Texture to texture.
    TextureToTexture {
        /// Source of the copy.
        source: ResourceId,
        /// Target of the copy.
        target: ResourceId,
    },
    /// Buffer to buffer.
    BufferToBuffer {
        /// Source of the copy.
        source: ResourceId,
        /// Target of the copy.
        target: ResourceId,
    },
    /// Texture to buffer, rows padded to 256 bytes.
    TextureToBuffer {
        /// Source of the copy.
        source: ResourceId,
        /// Target of the copy.
        target: ResourceId,
    },
    /// CPU memory to buffer.
    Upload {
        /// Target of the upload.
        target: ResourceId,
        /// Index of the upload in the frame.
        upload: u32,
    },
}

/// The origin of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Origin {
    /// Lives within the frame, in a slot of the pool.
    Transient,
    /// Belongs to the caller.
    Imported {
        /// Whether it has contents when the frame begins.
        defined: bool,
    },
    /// Contents of a history from the previous frame, read only.
    Previous {
        /// Index of the history in the frame.
        history: u32,
    },
    /// Contents of a history for the next frame.
    Current {
        /// Index of the history in the frame.
        history: u32,
    },
}

impl Origin {
    /// Returns whether the resource has contents when the frame begins.
    pub(crate) fn defined(self) -> bool {
        matches!(self, Self::Imported { defined: true } | Self::Previous { .. })
    }

    /// Returns whether the contents are needed after the frame.
    pub(crate) fn outlives(self) -> bool {
        matches!(self, Self::Imported { .. } | Self::Current { .. })
    }
}

/// Order of passes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub enum OrderPolicy {
    /// First continue the open render pass, then free the most memory, then keep the order of declaration.
    #[default]
    Automatic,
    /// First free the most memory, then keep the order of declaration.
    Memory,
    /// Keep the order of declaration.
    Declared,
}

/// Optimizations that the compiler may apply to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Options {
    /// Order of passes.
    pub order: OrderPolicy,
    /// Whether adjacent render passes with the same attachments are merged.
    pub merge: bool,
    /// Whether attachments that are used only within one render pass are transient
    /// (`TextureUsages::TRANSIENT_ATTACHMENT`), which takes no memory on tile-based GPUs.
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
    /// Resource of the first attachment.
    pub(crate) attachment: Option<ResourceId>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AccessDecl {
    pub(crate) resource: ResourceId,
    pub(crate) access: Access,
    pub(crate) contents: WriteMode,
    /// Version that is read or overwritten.
    pub(crate) version: u32,
    /// Index of the subresource in the frame; [`ALL_OF_RESOURCE`] for the full resource.
    pub(crate) subresource: u32,
}

pub(crate) const ALL_OF_RESOURCE: u32 = u32::MAX;

/// Effect of an access on the contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WriteMode {
    /// Only reads them.
    ReadOnly,
    /// Clears them to one of the frame's clear values.
    Clear(u32),
    /// Overwrites all of them.
    Overwrite,
    /// Preserves what it does not write.
    Preserve,
}

impl WriteMode {
    /// Returns whether the earlier contents are needed.
    pub(crate) fn needs(self) -> bool {
        matches!(self, Self::ReadOnly | Self::Preserve)
    }

    pub(crate) fn writes(self) -> bool {
        self != Self::ReadOnly
    }
}

/// What a note is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum NoteSubject {
    Pass(PassId),
    Resource(ResourceId),
}

/// A sentence of the declaration's author about a pass or a resource.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoteDecl {
    pub(crate) subject: NoteSubject,
    pub(crate) text: Text,
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
    /// Number of declared writes.
    pub(crate) version: u32,
    /// Exported version.
    pub(crate) exported: Option<u32>,
    /// Whether any access is to a subresource.
    pub(crate) has_partial_accesses: bool,
    /// Usages that an export needs, or that an imported object has.
    pub(crate) texture_usage: TextureUsages,
    pub(crate) buffer_usage: BufferUsages,
}

/// All of a frame's declarations.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Declaration {
    pub(crate) options: Options,
    pub(crate) resources: Vec<ResourceDecl>,
    pub(crate) passes: Vec<PassDecl>,
    pub(crate) places: SourceLocations,
    pub(crate) accesses: Vec<AccessDecl>,
    pub(crate) nodes: Vec<NodeDecl>,
    pub(crate) subresources: Vec<SubresourceDecl>,
    pub(crate) clears: Vec<ClearValue>,
    pub(crate) copies: Vec<CopyOp>,
    /// Explicit orders: the first pass runs before the second.
    pub(crate) after: Vec<(PassId, PassId)>,
    pub(crate) notes: Vec<NoteDecl>,
    pub(crate) names: Names,
}

impl Declaration {
    pub(crate) fn clear(&mut self) {
        let Self {
            options,
            resources,
            passes,
            places,
            accesses,
            nodes,
            subresources,
            clears,
            copies,
            after,
            notes,
            names,
        } = self;
        *options = Options::default();
        resources.clear();
        passes.clear();
        places.0.clear();
        accesses.clear();
        nodes.clear();
        subresources.clear();
        clears.clear();
        copies.clear();
        after.clear();
        notes.clear();
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

    /// Returns the region of the access; `None` for the full resource.
    #[inline]
    pub(crate) fn region(&self, access: &AccessDecl) -> Option<&Region> {
        self.subresources.get(access.subresource as usize).map(|subresource| &subresource.region)
    }

    /// Returns whether two accesses to one resource overlap.
    #[inline]
    pub(crate) fn overlap(&self, a: &AccessDecl, b: &AccessDecl) -> bool {
        match (self.region(a), self.region(b)) {
            (Some(a), Some(b)) => a.overlaps(b),
            _ => true,
        }
    }

    /// Returns whether the first of two accesses to one resource covers the second.
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

    /// Returns the pass that wrote a version of a resource. Version 0 has no writer.
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

    /// Returns the pass's path, such as `post/blur`.
    pub(crate) fn pass_path(&self, id: PassId) -> String {
        let mut path = String::new();
        self.write_pass_path(id, &mut path);
        path
    }

    /// Returns the pass for an error.
    pub(crate) fn pass_name(&self, id: PassId) -> PassName {
        self.pass_name_at(id, &self.places)
    }

    /// Returns the pass of a frame with other places for an error.
    pub(crate) fn pass_name_at(&self, id: PassId, places: &SourceLocations) -> PassName {
        PassName::new(self.pass_path(id), places.0.get(id.index()).copied())
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

    /// Returns the resource's path, such as `post/half`.
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

    /// Compares two frames. Fields that are short or often differ are compared first.
    pub(crate) fn similarity(&self, other: &Self) -> FrameSimilarity {
        let Self {
            options,
            resources,
            passes,
            places: _,
            accesses,
            nodes,
            subresources,
            clears,
            copies,
            after,
            notes,
            names,
        } = self;
        let same_structure = resources.len() == other.resources.len()
            && passes.len() == other.passes.len()
            && accesses.len() == other.accesses.len()
            && *options == other.options
            && clears.len() == other.clears.len()
            && *names == other.names
            && *subresources == other.subresources
            && *nodes == other.nodes
            && *copies == other.copies
            && *after == other.after
            && *notes == other.notes
            && *passes == other.passes
            && *accesses == other.accesses;
        if !same_structure {
            return FrameSimilarity::Other;
        }
        let pairs = || resources.iter().zip(&other.resources);
        if pairs().all(|(a, b)| a == b) {
            if *clears == other.clears { FrameSimilarity::Same } else { FrameSimilarity::OtherClears }
        } else if *clears != other.clears {
            FrameSimilarity::Other
        } else if pairs().all(|(a, b)| a.same_except_size(b)) {
            FrameSimilarity::OtherSizes
        } else {
            FrameSimilarity::Other
        }
    }
}

/// The result of comparing two frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameSimilarity {
    Same,
    /// The same except for clear values.
    OtherClears,
    /// The same except for sizes of textures and buffers.
    OtherSizes,
    Other,
}

impl ResourceDecl {
    fn same_except_size(&self, other: &Self) -> bool {
        let desc = match (self.desc, other.desc) {
            (ResourceDesc::Texture(own), ResourceDesc::Texture(other)) => {
                ResourceDesc::Texture(crate::TextureDesc { size: other.size, ..own })
            }
            (ResourceDesc::Buffer(own), ResourceDesc::Buffer(other)) => {
                ResourceDesc::Buffer(crate::BufferDesc { bytes: other.bytes, ..own })
            }
            (own, _) => own,
        };
        Self { desc, ..*self } == *other
    }
}
