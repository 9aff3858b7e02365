//! Operations of resources that are accessed in part. An attachment loads and stores whole mips and layers, so the contents
//! of their other parts matter.

use super::{declared_clear, in_render_pass, is_written_attachment, need_after_frame, zero};
use crate::compile::coverage::Coverage;
use crate::declaration::{AccessDecl, Declaration, WriteMode};
use crate::desc::ResourceDesc;
use crate::handle::{PassId, ResourceId};
use crate::plan::{AttachmentOps, LoadAction, LoadReason, StoreAction, StoreReason};
use crate::subresource::{Region, RegionSet};
use wgpu_types::TextureDimension;

/// One access to a resource, in the final order.
struct Touch<'d> {
    pass: PassId,
    step: u32,
    index: usize,
    access: &'d AccessDecl,
    region: Region,
}

pub(super) fn ops(
    decl: &Declaration,
    order: &[PassId],
    steps: &[(u32, u32)],
    ops: &mut [Option<AttachmentOps>],
) {
    let mut touches: Vec<Vec<Touch<'_>>> = (0..decl.resources.len()).map(|_| Vec::new()).collect();
    for (step, &(start, end)) in steps.iter().enumerate() {
        for &pass in &order[start as usize..end as usize] {
            for (access, index) in decl.accesses(pass).iter().zip(decl.access_range(pass)) {
                if decl.resource(access.resource).has_partial_accesses {
                    let region = decl.region(access).copied().unwrap_or(Region::ALL);
                    let touch = Touch { pass, step: step as u32, index, access, region };
                    touches[access.resource.index()].push(touch);
                }
            }
        }
    }
    for (index, touches) in touches.iter().enumerate().filter(|(_, touches)| !touches.is_empty()) {
        ResourceOps { decl, resource: ResourceId(index as u32), touches }.ops(ops);
    }
}

/// The next use of some contents.
enum Need {
    Pass(PassId),
    After(StoreReason),
    None(StoreReason),
}

/// All accesses to one resource.
struct ResourceOps<'d> {
    decl: &'d Declaration,
    resource: ResourceId,
    touches: &'d [Touch<'d>],
}

impl ResourceOps<'_> {
    fn ops(&self, ops: &mut [Option<AttachmentOps>]) {
        let mut defined = Coverage::all_if(self.decl.resource(self.resource).origin.defined());
        let mut start = 0;
        while start < self.touches.len() {
            let step = self.touches[start].step;
            let end = start + self.touches[start..].iter().take_while(|touch| touch.step == step).count();
            let before = defined.clone();
            for touch in self.touches[start..end].iter().filter(|touch| touch.access.contents.writes()) {
                defined.add(self.decl.region(touch.access));
            }
            for at in (start..end).filter(|&at| is_written_attachment(self.touches[at].access)) {
                ops[self.touches[at].index] = Some(self.attachment((start, end), at, &before, &defined));
            }
            start = end;
        }
    }

    /// Returns the operations of one of the accesses `start..end` of a step.
    fn attachment(
        &self,
        (start, end): (usize, usize),
        at: usize,
        before: &Coverage,
        after: &Coverage,
    ) -> AttachmentOps {
        let touch = &self.touches[at];
        let whole = touch.region.without_rect();
        let of_attachment = |at: &usize| {
            is_written_attachment(self.touches[*at].access)
                && self.touches[*at].region.without_rect() == whole
        };
        let first = (start..end).find(of_attachment).unwrap_or(at);
        let last = (start..end).rev().find(of_attachment).unwrap_or(at);
        let load = self.load(start, first, before);
        let clear_drawn = declared_clear(self.decl, touch.access).is_some_and(|value| {
            let overwritten =
                self.touches[first..at].iter().any(|other| other.region.overlaps(&touch.region));
            load.0 != LoadAction::Clear(value) || overwritten
        });
        // wgpu does not track the slices of a volume: discarding one discards the whole mip.
        let kept_together = if self.is_volume() { whole.all_layers() } else { whole };
        let store = match self.need(after.intersection(&kept_together), end) {
            Need::Pass(pass) => (StoreAction::Store, StoreReason::NeededBy(pass)),
            Need::After(reason) => (StoreAction::Store, reason),
            Need::None(reason) => (StoreAction::Discard, reason),
        };
        in_render_pass((at == first, load), (at == last, store), clear_drawn)
    }

    fn is_volume(&self) -> bool {
        match self.decl.resource(self.resource).desc {
            ResourceDesc::Texture(desc) => desc.dimension == TextureDimension::D3,
            ResourceDesc::Buffer(_) => false,
        }
    }

    /// Returns the load operation of the access at `first`. Its step begins at `start`: an encoder pass may also read the
    /// attachment outside of what it draws, in any order.
    fn load(&self, start: usize, first: usize, before: &Coverage) -> (LoadAction, LoadReason) {
        let touch = &self.touches[first];
        let whole = touch.region.without_rect();
        let clear = declared_clear(self.decl, touch.access);
        let value = clear.unwrap_or(zero(touch.access.access));
        if let (Some(value), true) = (clear, touch.region == whole) {
            return (LoadAction::Clear(value), LoadReason::Declared);
        }
        match self.need(before.intersection(&whole), start) {
            Need::Pass(pass) if pass == touch.pass && touch.access.contents == WriteMode::Preserve => {
                let writes = |other: &&Touch<'_>| {
                    other.access.contents.writes() && other.region.overlaps(&touch.region)
                };
                let writer = self.touches[..first].iter().rev().find(writes).map(|other| other.pass);
                (LoadAction::Load, writer.map_or(LoadReason::PreservesImport, LoadReason::Preserves))
            }
            Need::Pass(pass) => (LoadAction::Load, LoadReason::RestNeededBy(pass)),
            Need::After(_) => (LoadAction::Load, LoadReason::RestOutlives),
            Need::None(_) => {
                let reason = match touch.access.contents {
                    WriteMode::Clear(_) => LoadReason::Declared,
                    _ if touch.region == whole => LoadReason::Overwritten,
                    _ => LoadReason::RestUnneeded,
                };
                (LoadAction::Clear(value), reason)
            }
        }
    }

    /// Returns what needs any of `contents`, which exist before the access at `from`.
    fn need(&self, mut contents: RegionSet, from: usize) -> Need {
        let mut overwriter = None;
        for touch in &self.touches[from..] {
            if contents.is_empty() {
                break;
            }
            if !contents.overlaps(&touch.region) {
                continue;
            }
            if touch.access.contents.needs() {
                return Need::Pass(touch.pass);
            }
            contents.subtract(&touch.region);
            overwriter = Some(touch.pass);
        }
        let left = if contents.is_empty() { None } else { need_after_frame(self.decl, self.resource) };
        match (left, overwriter) {
            (Some(reason), _) => Need::After(reason),
            (None, Some(pass)) if contents.is_empty() => Need::None(StoreReason::OverwrittenBy(pass)),
            (None, _) => Need::None(StoreReason::LastUse),
        }
    }
}
