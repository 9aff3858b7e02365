//! Reasons of the compiler's decisions. `dump::describe` formats them.

use crate::declaration::PassKind;
use crate::handle::{PassId, ResourceId};
use serde::Serialize;

/// Reason why a pass does not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum CullReason {
    /// It writes nothing and is not kept.
    WritesNothing,
    /// Nothing reads what it writes.
    Unread(ResourceId),
    /// Only passes that are culled themselves, such as this one, read what it writes.
    OnlyCulledReaders(ResourceId, PassId),
    /// The second overwrites the first before anything reads it.
    Overwritten(ResourceId, PassId),
}

/// Reason why a pass is at its position in the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum OrderReason {
    /// The frame fixes the order of declaration.
    Fixed,
    /// It was the only pass whose dependencies had run.
    OnlyReady,
    /// It is the ready pass that continues the open render pass.
    ContinuesRenderPass,
    /// It is the ready pass that leaves the least memory in use: this many bytes less than before it (more if the number
    /// is negative).
    FreesMemory(i64),
    /// It was declared first of the ready passes that are best for memory.
    DeclaredFirst,
    /// The order of declaration, because choosing by memory would need more of it.
    DeclarationNeedsLess,
    /// The order chosen by memory from the last pass to the first, because it needs less memory than from the first to
    /// the last.
    BackwardsNeedsLess,
}

/// Reason why a pass shares the render pass of the one before it, or why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum MergeReason {
    /// It is the first pass of the frame.
    First,
    /// It has the same attachments, and no hazard forbids merging.
    Merged,
    /// Merging is switched off.
    Off,
    /// It is not a render pass.
    Kind(PassKind),
    /// The pass before it is not a render pass.
    KindBefore(PassKind),
    /// Their attachments differ.
    Attachments,
    /// It reads this resource, which this earlier pass of the render pass writes.
    Reads(ResourceId, PassId),
    /// It writes this resource, which this earlier pass of the render pass uses.
    Writes(ResourceId, PassId),
    /// It clears this whole attachment, which a load operation does for free.
    Clears(ResourceId),
    /// This attachment is resolved at the end of the pass before it.
    Resolves(ResourceId),
}

/// Reason why an attachment is cleared or loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum LoadReason {
    /// The pass declares the clear.
    Declared,
    /// The pass overwrites every texel, and a clear is the cheapest load operation.
    #[serde(rename = "Covered")]
    Overwritten,
    /// The pass draws into a part, and nothing needs the rest.
    RestUnneeded,
    /// The pass preserves what this pass wrote.
    Preserves(PassId),
    /// The pass preserves the contents from before the frame.
    PreservesImport,
    /// The pass draws into a part, and this pass needs the rest.
    RestNeededBy(PassId),
    /// The pass draws into a part, and the rest is needed after the frame.
    RestOutlives,
    /// It continues the render pass of the previous pass.
    Merged,
}

/// Reason why an attachment is stored or discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum StoreReason {
    /// This pass needs it.
    NeededBy(PassId),
    /// It is exported.
    Exported,
    /// It belongs to the caller.
    Imported,
    /// The next frame reads it as history.
    History,
    /// This pass overwrites it before anything reads it.
    OverwrittenBy(PassId),
    /// Nothing reads it afterwards.
    LastUse,
    /// The next pass continues the render pass.
    Merged,
}

/// Reason why a resource is in its slot, or in none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SlotReason {
    /// No pass that runs uses it.
    Unused,
    /// It belongs to the caller.
    Imported,
    /// It belongs to a history.
    History,
    /// It is the first of its class.
    FirstOfClass,
    /// Every slot of its class is in use, for example by this resource.
    AllBusy(ResourceId),
    /// It reuses the slot of this resource.
    After(ResourceId),
}
