//! Objects that a graph keeps on one device from frame to frame.

mod attachments;
mod bind_group_cache;
mod histories;
mod pass_groups;
mod poison;
mod resolved_plan;
mod slots;
mod staging;
mod uniforms;
mod view_cache;

#[cfg(test)]
mod tests;

pub(crate) use attachments::DepthAttachment;
pub(crate) use bind_group_cache::{BindGroupCache, BoundResource, GroupKey};
pub(crate) use histories::Histories;
pub(crate) use pass_groups::EntryKey;
pub(crate) use poison::{PoisonBuffer, poison_value};
pub(crate) use resolved_plan::ResolvedPlan;
pub(crate) use slots::{PhysicalResource, Slots};
pub(crate) use staging::{Staging, aligned_range};
pub(crate) use uniforms::UniformBuffer;
pub(crate) use view_cache::{ViewCache, ViewUsage, create_view};

use crate::device::device_is_lost;
use crate::error::Error;
use crate::history::HistoryUse;
use crate::internal::RegionClears;
use crate::pipeline::PipelineCache;
use crate::plan::Plan;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Limits of what a graph keeps beyond what a frame needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoolLimits {
    /// Frames that a texture, buffer, view, bind group or history may be idle before it is dropped.
    pub idle_frames: u32,
    /// Bytes of textures and buffers above which those that the frame does not use are dropped, the longest idle first;
    /// `None` for no limit. Histories count towards it but are not dropped.
    pub budget_bytes: Option<u64>,
}

impl Default for PoolLimits {
    fn default() -> Self {
        Self { idle_frames: 8, budget_bytes: None }
    }
}

/// Physical textures and buffers, views, bind groups and staging memory of one device.
#[derive(Default)]
pub(crate) struct Pool {
    pub(crate) limits: PoolLimits,
    pub(crate) poison: bool,
    frame: u64,
    pub(crate) slots: Slots,
    pub(crate) histories: Histories,
    pub(crate) staging: Staging,
    pub(crate) uniforms: UniformBuffer,
    /// The last few plans with their objects, the most recent first.
    resolved_plans: Vec<ResolvedPlan>,
    caches: Mutex<Caches>,
}

/// Data that passes look up while they are recorded, possibly on several threads.
#[derive(Default)]
pub(crate) struct Caches {
    pub(crate) views: ViewCache,
    pub(crate) bind_groups: BindGroupCache,
    pub(crate) clears: RegionClears,
    pub(crate) poison_buffer: PoisonBuffer,
    pub(crate) pipelines: PipelineCache,
}

impl Pool {
    /// Switches the poison mode, for which objects need more usages.
    pub(crate) fn set_poison(&mut self, on: bool) {
        if self.poison != on {
            self.poison = on;
            self.resolved_plans.clear();
        }
    }

    /// Returns the bytes of all textures and buffers, without the driver's padding.
    pub(crate) fn bytes(&self) -> u64 {
        self.slots.bytes() + self.histories.bytes()
    }

    /// Starts a frame: all objects are free again, and those that have been idle too long are dropped.
    pub(crate) fn begin_frame(&mut self) -> u64 {
        self.frame += 1;
        let oldest = self.oldest_kept_frame();
        if self.slots.drop_idle(oldest) {
            self.resolved_plans.clear();
        }
        self.staging.end_frame(self.limits.idle_frames);
        let mut caches = self.caches();
        caches.views.begin_frame(self.frame, oldest);
        let kept = self.resolved_plans.iter().flat_map(ResolvedPlan::kept_groups);
        caches.bind_groups.begin_frame(self.frame, oldest, kept);
        caches.clears.begin_frame(self.frame, oldest);
        caches.pipelines.begin_frame(self.frame, oldest);
        drop(caches);
        self.frame
    }

    /// Returns the frame before whose last use objects are dropped.
    fn oldest_kept_frame(&self) -> u64 {
        self.frame.saturating_sub(self.limits.idle_frames.into())
    }

    /// Ends a recorded frame: passes its histories on to the next one.
    pub(crate) fn end_frame(&mut self, plan: &Plan, histories: &[HistoryUse]) {
        let oldest = self.oldest_kept_frame();
        self.histories.release((plan, histories), self.frame, oldest);
    }

    /// Returns the root cause of a frame's error: on a lost device every failure is [`Error::DeviceLost`]. When memory ran
    /// out, drops everything that the next frame can create again.
    pub(crate) fn classify_error(&mut self, device: &wgpu::Device, error: Error) -> Error {
        match error {
            Error::OutOfMemory { .. } => self.evict_all(),
            Error::DeviceLost => {}
            _ if device_is_lost(device) => return Error::DeviceLost,
            _ => {}
        }
        error
    }

    /// Drops all textures and buffers except histories and uniform blocks.
    fn evict_all(&mut self) {
        self.slots = Slots::default();
        self.staging = Staging::default();
        self.histories.discard_new();
        self.resolved_plans.clear();
        let mut caches = self.caches();
        (caches.views, caches.bind_groups) = Default::default();
        caches.poison_buffer = PoisonBuffer::default();
    }

    /// Returns an empty pool with the pipelines of this one, for a frame that must leave nothing but pipelines behind;
    /// [`return_pipelines`](Self::return_pipelines) moves them back.
    pub(crate) fn lend_pipelines(&mut self) -> Self {
        let scratch = Self { limits: self.limits, frame: self.frame, ..Self::default() };
        self.swap_pipelines(&scratch);
        scratch
    }

    pub(crate) fn return_pipelines(&mut self, scratch: Self) {
        self.swap_pipelines(&scratch);
    }

    fn swap_pipelines(&self, other: &Self) {
        let (mut own, mut others) = (self.caches(), other.caches());
        std::mem::swap(&mut own.clears, &mut others.clears);
        std::mem::swap(&mut own.pipelines, &mut others.pipelines);
    }

    /// Drops what the frame does not use until the pool is within its budget.
    pub(crate) fn enforce_budget(&mut self) {
        if let Some(budget) = self.limits.budget_bytes
            && self.slots.drop_above(budget.saturating_sub(self.histories.bytes()), self.frame)
        {
            self.resolved_plans.retain(|resolved| resolved.frame == self.frame);
        }
    }

    /// Locks the caches. They are consistent whenever the lock is free, so a lock poisoned by a panicking body can be ignored.
    pub(crate) fn caches(&self) -> MutexGuard<'_, Caches> {
        self.caches.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns an error if a resource needs more than the device's limit allows.
pub(crate) fn check_limit(name: &str, limit: &'static str, needed: u64, allowed: u64) -> Result<(), Error> {
    if needed <= allowed {
        return Ok(());
    }
    Err(Error::Limit { resource: name.into(), limit, needed, allowed })
}
