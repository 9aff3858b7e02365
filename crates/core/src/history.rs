//! Histories as both frames and the pool of their textures know them.

use crate::declaration::Declaration;
use crate::desc::{Extent, TextureDesc};
use crate::handle::{NodeId, ResourceId};

/// Effect of a change of size on a history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resize {
    /// The contents are dropped: `valid` is false for one frame.
    Reset,
    /// The contents are resampled to the new size, filtered where the format allows it; the number of mips may change
    /// too. What cannot be resampled is reset: stencil, formats that are not renderable, multisampled, 1D and 3D
    /// textures, and a history that was declared with `Reset` before, unless it was sampled.
    Resample,
}

/// A history of a frame.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "the executor reads the rest"))]
pub(crate) struct HistoryUse {
    pub(crate) previous: ResourceId,
    pub(crate) current: ResourceId,
    pub(crate) resize: Resize,
    pub(crate) view: Option<NodeId>,
}

/// A history of a graph that holds contents.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PriorHistory {
    /// Path of the view; empty without a view.
    pub(crate) view: String,
    pub(crate) name: String,
    pub(crate) desc: TextureDesc,
    /// Whether its contents can be resampled to another size.
    pub(crate) can_resample: bool,
}

impl PriorHistory {
    /// Returns whether this is the history of that name and view.
    pub(crate) fn matches(&self, decl: &Declaration, view: Option<NodeId>, resource: ResourceId) -> bool {
        self.name == decl.resource_name(resource) && is_path(decl, view, &self.view)
    }

    #[cfg(feature = "gpu")]
    pub(crate) fn is_same_history(&self, other: &Self) -> bool {
        (&self.view, &self.name) == (&other.view, &other.name)
    }

    /// Returns whether these contents can be carried over to a texture of this shape. A frame uses it when it declares the
    /// history and the pool when it acquires the textures, so that both decide the same.
    pub(crate) fn fits(&self, desc: &TextureDesc, resize: Resize) -> bool {
        self.desc == *desc
            || resize == Resize::Resample && self.can_resample && self.differs_in_size_only(desc)
    }

    /// Returns whether the shapes differ at most in width, height and mip levels.
    pub(crate) fn differs_in_size_only(&self, desc: &TextureDesc) -> bool {
        let Extent { width, height, .. } = desc.size;
        let size = Extent { width, height, ..self.desc.size };
        TextureDesc { size, mip_levels: desc.mip_levels, ..self.desc } == *desc
    }
}

/// Compares a node's path with a string, without allocating it.
fn is_path(decl: &Declaration, node: Option<NodeId>, path: &str) -> bool {
    let Some(node) = node else { return path.is_empty() };
    let node = &decl.nodes[node.index()];
    let Some(rest) = path.strip_suffix(decl.names.get(node.name)) else { return false };
    match node.parent {
        None => rest.is_empty(),
        Some(_) => rest.strip_suffix('/').is_some_and(|rest| is_path(decl, node.parent, rest)),
    }
}
