//! What a graph keeps on one device from frame to frame.

mod bind_groups;
mod histories;
mod slots;
mod staging;
mod uniforms;
mod views;

#[cfg(test)]
mod tests;

pub(crate) use bind_groups::{BindGroups, Bound, GroupKey};
pub(crate) use histories::Histories;
pub(crate) use slots::{Physical, SlotKey, Slots};
pub(crate) use staging::{Staging, place};
pub(crate) use uniforms::UniformBuffer;
pub(crate) use views::{Purpose, Views, view};

use crate::compiled::Compiled;
use crate::device::device_is_lost;
use crate::error::Error;
use crate::execute::{Pattern, Realised};
use crate::internal::RegionClears;
use crate::shader_pass::Pipelines;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How long and how much a graph keeps beyond what a frame needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoolLimits {
    /// Frames that a texture, buffer, view, bind group or history may lie idle before it is dropped.
    pub idle_frames: u32,
    /// Bytes of textures and buffers above which those that the frame does not need are dropped, the longest idle
    /// first; `None` for no such limit. Histories count, but are not dropped for it.
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
    /// What the last few plans stand on, the most recent first.
    pub(crate) realised: Vec<Realised>,
    caches: Mutex<Caches>,
}

/// What passes look up while they are recorded, on several threads if need be.
#[derive(Default)]
pub(crate) struct Caches {
    pub(crate) views: Views,
    pub(crate) bind_groups: BindGroups,
    pub(crate) clears: RegionClears,
    pub(crate) pattern: Pattern,
    pub(crate) pipelines: Pipelines,
}

impl Pool {
    /// Switches the filling with loud values, for which objects need more usages.
    pub(crate) fn set_poison(&mut self, on: bool) {
        if self.poison != on {
            self.poison = on;
            self.realised.clear();
        }
    }

    /// Returns the bytes of all textures and buffers, without the driver's padding.
    pub(crate) fn bytes(&self) -> u64 {
        self.slots.bytes() + self.histories.bytes()
    }

    /// Starts a frame: everything is free again, and what has been idle for long goes.
    pub(crate) fn begin_frame(&mut self) -> u64 {
        self.frame += 1;
        let oldest = self.oldest();
        if self.slots.drop_idle(oldest) {
            self.realised.clear();
        }
        self.staging.end_frame(self.limits.idle_frames);
        let mut caches = self.caches();
        caches.views.begin_frame(self.frame, oldest);
        caches.bind_groups.begin_frame(self.frame, oldest);
        caches.clears.begin_frame(self.frame, oldest);
        caches.pipelines.begin_frame(self.frame, oldest);
        drop(caches);
        self.frame
    }

    /// What was last used before this frame goes.
    fn oldest(&self) -> u64 {
        self.frame.saturating_sub(self.limits.idle_frames.into())
    }

    /// Notes that a frame was recorded, for the histories that it used.
    pub(crate) fn end_frame(&mut self, compiled: &Compiled<'_>) {
        let oldest = self.oldest();
        self.histories.leave(compiled, self.frame, oldest);
    }

    /// The error that a frame ended with, in the words that help most: whatever fails on a lost device fails for that. Where
    /// memory ran out, all goes that the next frame can make anew.
    pub(crate) fn explain(&mut self, device: &wgpu::Device, error: Error) -> Error {
        match error {
            Error::OutOfMemory { .. } => self.let_go(),
            Error::DeviceLost => {}
            _ if device_is_lost(device) => return Error::DeviceLost,
            _ => {}
        }
        error
    }

    /// Drops all textures and buffers but histories and uniform blocks.
    fn let_go(&mut self) {
        self.slots = Slots::default();
        self.staging = Staging::default();
        self.histories.forget_fresh();
        self.realised.clear();
        let mut caches = self.caches();
        (caches.views, caches.bind_groups) = Default::default();
        caches.pattern = Pattern::default();
    }

    /// Returns an empty pool that has the pipelines of this one, for a frame that shall leave nothing but pipelines
    /// behind; [`take_pipelines`](Self::take_pipelines) brings them back.
    pub(crate) fn lend_pipelines(&mut self) -> Self {
        let scratch = Self { limits: self.limits, frame: self.frame, ..Self::default() };
        self.swap_pipelines(&scratch);
        scratch
    }

    pub(crate) fn take_pipelines(&mut self, scratch: Self) {
        self.swap_pipelines(&scratch);
    }

    fn swap_pipelines(&self, other: &Self) {
        let (mut own, mut others) = (self.caches(), other.caches());
        std::mem::swap(&mut own.clears, &mut others.clears);
        std::mem::swap(&mut own.pipelines, &mut others.pipelines);
    }

    /// Drops what the frame does not use until the budget is kept.
    pub(crate) fn keep_budget(&mut self) {
        if let Some(budget) = self.limits.budget_bytes
            && self.slots.drop_above(budget.saturating_sub(self.histories.bytes()), self.frame)
        {
            self.realised.retain(|realised| realised.frame == self.frame);
        }
    }

    /// The caches; they are whole between any two statements, so a body that panicked did not spoil them.
    pub(crate) fn caches(&self) -> MutexGuard<'_, Caches> {
        self.caches.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// An error if a resource needs more of something than the device allows.
pub(crate) fn limit(name: &str, limit: &'static str, needed: u64, allowed: u64) -> Result<(), Error> {
    if needed <= allowed {
        return Ok(());
    }
    Err(Error::Limit { resource: name.into(), limit, needed, allowed })
}
