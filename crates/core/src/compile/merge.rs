//! Merging: which passes share one render pass of the encoder.

use crate::access::Access;
use crate::declaration::{AccessDecl, Declaration, PassKind, WriteMode};
use crate::handle::{PassId, ResourceId};
use crate::plan::MergeReason;
use crate::subresource::Region;

/// Returns the ranges of the order that are recorded as one pass, and for each position why it is merged with the
/// previous pass or not.
pub(super) fn merge(decl: &Declaration, order: &[PassId]) -> (Vec<(u32, u32)>, Vec<MergeReason>) {
    let mut group = Group::new(decl);
    let mut steps: Vec<(u32, u32)> = Vec::with_capacity(order.len());
    let mut reasons = Vec::with_capacity(order.len());
    for (position, &pass) in order.iter().enumerate() {
        let reason = group.can_merge(decl, pass);
        group.add(decl, pass, reason == MergeReason::Merged);
        let end = position as u32 + 1;
        match steps.last_mut() {
            Some(step) if reason == MergeReason::Merged => step.1 = end,
            _ => steps.push((position as u32, end)),
        }
        reasons.push(reason);
    }
    (steps, reasons)
}

/// The open render pass while passes are added in order.
pub(super) struct Group {
    passes: Option<(PassId, PassId)>,
    /// Number of the group; marks of other groups are ignored.
    epoch: u32,
    /// Last use of each resource in the group.
    marks: Vec<Mark>,
}

#[derive(Clone, Copy)]
struct Mark {
    epoch: u32,
    pass: PassId,
    written: bool,
}

impl Group {
    pub(super) fn new(decl: &Declaration) -> Self {
        let none = Mark { epoch: 0, pass: PassId(0), written: false };
        Self { passes: None, epoch: 0, marks: vec![none; decl.resources.len()] }
    }

    /// Returns the first attachment of the open pass: a pass that continues it must have it too.
    pub(super) fn attachment(&self, decl: &Declaration) -> Option<ResourceId> {
        let (first, _) = self.passes?;
        decl.pass(first).attachment
    }

    /// Returns whether the pass can continue the open render pass, or why not.
    pub(super) fn can_merge(&self, decl: &Declaration, pass: PassId) -> MergeReason {
        let Some((first, last)) = self.passes else { return MergeReason::First };
        if !decl.options.merge {
            return MergeReason::Off;
        }
        let (kind, before) = (decl.pass(pass).kind, decl.pass(first).kind);
        if kind != PassKind::Render {
            return MergeReason::Kind(kind);
        }
        if before != PassKind::Render {
            return MergeReason::KindBefore(before);
        }
        if decl.pass(pass).attachment != decl.pass(first).attachment {
            return MergeReason::Attachments;
        }
        let mut own = attachments(decl, pass);
        let same = attachments(decl, first)
            .all(|other| own.next().is_some_and(|own| same_attachment(decl, own, other)));
        if !same || own.next().is_some() {
            return MergeReason::Attachments;
        }
        let resolve = decl.accesses(last).iter().find(|a| matches!(a.access, Access::Resolve(_)));
        if let Some(resolve) = resolve {
            return MergeReason::Resolves(resolve.resource);
        }
        decl.accesses(pass).iter().find_map(|access| self.hazard(decl, access)).unwrap_or(MergeReason::Merged)
    }

    fn hazard(&self, decl: &Declaration, access: &AccessDecl) -> Option<MergeReason> {
        let resource = access.resource;
        if matches!(access.access, Access::Color(_) | Access::Depth | Access::DepthRead) {
            let clears = matches!(access.contents, WriteMode::Clear(_))
                && decl.region(access).is_none_or(|region| *region == region.without_rect());
            return clears.then_some(MergeReason::Clears(resource));
        }
        let mark = self.marks[resource.index()];
        if mark.epoch != self.epoch {
            return None;
        }
        match (access.contents.writes(), mark.written) {
            (true, _) => Some(MergeReason::Writes(resource, mark.pass)),
            (false, true) => Some(MergeReason::Reads(resource, mark.pass)),
            (false, false) => None,
        }
    }

    /// Adds a pass to the open group, or starts a new group.
    pub(super) fn add(&mut self, decl: &Declaration, pass: PassId, joins: bool) {
        self.passes = match self.passes {
            Some((first, _)) if joins => Some((first, pass)),
            _ => {
                self.epoch += 1;
                Some((pass, pass))
            }
        };
        if decl.pass(pass).kind != PassKind::Render {
            return;
        }
        for access in decl.accesses(pass) {
            let mark = &mut self.marks[access.resource.index()];
            let written = access.contents.writes() || mark.epoch == self.epoch && mark.written;
            *mark = Mark { epoch: self.epoch, pass, written };
        }
    }
}

/// Returns the attachments of a pass without resolve targets, in order of declaration.
fn attachments(decl: &Declaration, pass: PassId) -> impl Iterator<Item = &AccessDecl> {
    let is_attached =
        |a: &&AccessDecl| matches!(a.access, Access::Color(_) | Access::Depth | Access::DepthRead);
    decl.accesses(pass).iter().filter(is_attached)
}

/// Returns whether two accesses attach the same mip, layer and aspects of one texture in the same way.
fn same_attachment(decl: &Declaration, a: &AccessDecl, b: &AccessDecl) -> bool {
    let whole = |access| decl.region(access).map_or(Region::ALL, |region| region.without_rect());
    let both_whole = || decl.region(a).is_none() && decl.region(b).is_none();
    a.access == b.access && a.resource == b.resource && (both_whole() || whole(a) == whole(b))
}
