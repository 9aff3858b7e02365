//! The enabled nodes of a document and their connections.

use super::document::NodeEntry;
use crate::nodes::kind::NodeKind;
use crate::nodes::port::Port;

/// An enabled node of the document.
pub(super) struct EnabledNode<'d> {
    pub(super) entry: &'d NodeEntry,
    pub(super) kind: NodeKind,
    /// The index of the value of its first output.
    pub(super) first_value: usize,
}

/// An output of an enabled node.
#[derive(Clone, Copy)]
pub(super) struct OutputRef {
    pub(super) node: usize,
    /// The index among the node's outputs.
    pub(super) port: usize,
}

/// An input, the index of its value, and the node that produces it.
pub(super) struct ConnectedInput {
    pub(super) port: Port,
    pub(super) value: Option<usize>,
    pub(super) producer: Option<usize>,
}
