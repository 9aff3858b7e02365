//! Why the compiler decided as it did. The words for these are in `dump::describe`.

use crate::declaration::PassKind;
use crate::handle::{PassId, ResourceId};
use serde::Serialize;

/// Why a pass does not run.
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

/// Why a pass stands where it does in the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum OrderReason {
    /// The frame fixes the order of declaration.
    Fixed,
    /// It was the only pass whose dependencies were done.
    OnlyReady,
    /// Of the passes that were ready, it goes on with the open render pass.
    ContinuesRenderPass,
    /// Of the passes that were ready, it leaves the least memory in use: this many bytes less than before it (more,
    /// where the number is negative).
    FreesMemory(i64),
    /// Of the passes that were ready and no better in memory, it was declared first.
    DeclaredFirst,
    /// Choosing by memory would have needed more of it than the order of declaration, so that was taken.
    DeclarationNeedsLess,
    /// Choosing by memory from the last pass to the first needs less of it than from the first to the last, so that
    /// was taken.
    BackwardsNeedsLess,
}

/// Why a pass shares the render pass of the one before it, or why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum MergeReason {
    /// It is the first pass of the frame.
    First,
    /// It goes on with the same attachments, and no hazard forbids it.
    Merged,
    /// Merging is switched off.
    Off,
    /// It is not a render pass.
    Kind(PassKind),
    /// The pass before it is not a render pass.
    KindBefore(PassKind),
    /// Their attachments are not the same.
    Attachments,
    /// It reads this resource, which this pass of the same render pass would have drawn or written.
    Reads(ResourceId, PassId),
    /// It writes this resource, which this pass of the same render pass would have touched.
    Writes(ResourceId, PassId),
    /// It clears all of this attachment, which a load operation does for free.
    Clears(ResourceId),
    /// This attachment is resolved at the end of the pass before it.
    Resolves(ResourceId),
}

/// Why an attachment is cleared or loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum LoadReason {
    /// The pass declares the clear.
    Declared,
    /// The pass covers every texel, and a clear is the cheapest load there is.
    #[serde(rename = "Covered")]
    Overwritten,
    /// The pass draws into a part, and nothing needs what the rest held.
    RestUnneeded,
    /// The pass preserves what this pass wrote.
    Preserves(PassId),
    /// The pass preserves what was there when the frame began.
    PreservesImport,
    /// The pass draws into a part, and this pass needs what the rest holds.
    RestNeededBy(PassId),
    /// The pass draws into a part, and the rest is needed after the frame.
    RestOutlives,
    /// The render pass goes on from the pass before it.
    Merged,
}

/// Why an attachment is stored or discarded.
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
    /// Nothing reads it any more.
    LastUse,
    /// The next pass draws on in the same render pass.
    Merged,
}

/// Why a resource lives where it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SlotReason {
    /// Nothing that runs touches it.
    Unused,
    /// It belongs to the caller.
    Imported,
    /// It is one half of a history.
    History,
    /// It is the first of its shape.
    FirstOfClass,
    /// Every slot of its shape is in use at the time, such as by this resource.
    AllBusy(ResourceId),
    /// It takes over the slot that this resource is done with.
    After(ResourceId),
}
