//! What a frame declares, as plain data: the only input of the compiler.

use crate::access::{Access, Contents};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId, ResourceId};
use serde::Serialize;
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
    /// Returns the kind in one word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Render => "render",
            Self::Compute => "compute",
            Self::Copy => "copy",
            Self::Encoder => "encoder",
        }
    }
}

/// One transfer of a copy pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum CopyOp {
    /// The whole of one texture to another of the same size and format, mip 0.
    TextureToTexture {
        /// Copied from.
        source: ResourceId,
        /// Copied to.
        target: ResourceId,
    },
    /// The whole of one buffer to another at least as large.
    BufferToBuffer {
        /// Copied from.
        source: ResourceId,
        /// Copied to.
        target: ResourceId,
    },
    /// Mip 0 of a texture to a buffer, rows padded to 256 bytes.
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
}

#[derive(Clone, Debug)]
pub(crate) struct NodeDecl {
    pub(crate) name: String,
    pub(crate) parent: Option<NodeId>,
}

#[derive(Clone, Debug)]
pub(crate) struct PassDecl {
    pub(crate) name: String,
    pub(crate) node: Option<NodeId>,
    pub(crate) kind: PassKind,
    pub(crate) accesses: Vec<AccessDecl>,
    pub(crate) copies: Vec<CopyOp>,
    pub(crate) keep: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct AccessDecl {
    pub(crate) resource: ResourceId,
    pub(crate) access: Access,
    /// For writes only.
    pub(crate) contents: Option<Contents>,
    /// The version read, or written over.
    pub(crate) version: u32,
}

#[derive(Clone, Debug)]
pub(crate) struct ResourceDecl {
    pub(crate) name: String,
    pub(crate) desc: ResourceDesc,
    pub(crate) origin: Origin,
    /// The version that is taken out of the frame.
    pub(crate) exported: Option<u32>,
    /// Usages asked for from outside (exports), or allowed by the caller's object (imports).
    pub(crate) texture_usage: TextureUsages,
    pub(crate) buffer_usage: BufferUsages,
    /// The pass that made each version; index 0 is version 1. Version 0 is what was there at first.
    pub(crate) writers: Vec<PassId>,
}

impl ResourceDecl {
    pub(crate) fn version(&self) -> u32 {
        self.writers.len() as u32
    }
}

/// All of a frame's declarations.
#[derive(Clone, Debug, Default)]
pub(crate) struct Declaration {
    pub(crate) nodes: Vec<NodeDecl>,
    pub(crate) passes: Vec<PassDecl>,
    pub(crate) resources: Vec<ResourceDecl>,
}

impl Declaration {
    pub(crate) fn pass(&self, id: PassId) -> &PassDecl {
        &self.passes[id.index()]
    }

    pub(crate) fn resource(&self, id: ResourceId) -> &ResourceDecl {
        &self.resources[id.index()]
    }

    /// The pass's name for messages, with its nodes before it: `post/blur`.
    pub(crate) fn pass_path(&self, id: PassId) -> String {
        let pass = self.pass(id);
        let mut parts = vec![pass.name.as_str()];
        let mut node = pass.node;
        while let Some(id) = node {
            parts.push(&self.nodes[id.index()].name);
            node = self.nodes[id.index()].parent;
        }
        parts.reverse();
        parts.join("/")
    }
}
