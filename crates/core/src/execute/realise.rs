//! What stands behind a plan on a device.

use super::attachments::COLORS;
use super::last_groups::LastGroups;
use super::poison;
use crate::access::Access;
use crate::declaration::Origin;
use crate::desc::ResourceDesc;
use crate::error::Error;
use crate::frame::Work;
use crate::handle::PassId;
use crate::plan::Plan;
use crate::pool::{Physical, Pool, Purpose, SlotKey, Views, limit, view};
use std::sync::Arc;

/// Plans whose objects are kept.
const KEPT: usize = 4;

/// The objects of a plan: physical textures and buffers, views of attachments, labels.
pub(crate) struct Realised {
    plan: Arc<Plan>,
    /// The frame that used it last.
    pub(crate) frame: u64,
    slots: Vec<SlotKey>,
    /// By resource.
    pub(crate) objects: Vec<Option<Physical>>,
    /// By access: the views of attachments in passes that run.
    pub(crate) views: Vec<Option<wgpu::TextureView>>,
    /// Attachments whose objects are others in each frame.
    moving: Vec<u32>,
    labels: Labels,
    /// From the second frame on.
    pub(super) last_groups: Option<LastGroups>,
}

impl Realised {
    /// Finds the objects of a plan, or takes them from the pool.
    pub(super) fn take(
        plan: &Arc<Plan>,
        pool: &mut Pool,
        device: &wgpu::Device,
        frame: u64,
    ) -> Result<Self, Error> {
        if let Some(index) = pool.realised.iter().position(|own| Arc::ptr_eq(&own.plan, plan)) {
            let mut own = pool.realised.remove(index);
            if frame - own.frame > pool.limits.idle_frames.into() {
                own.last_groups = None;
            }
            own.last_groups.get_or_insert_with(|| LastGroups::new(plan.pass_count()));
            own.frame = frame;
            pool.slots.touch(&own.slots, frame);
            return Ok(own);
        }
        check_colors(plan, &device.limits())?;
        let mut slots = Vec::with_capacity(plan.slots.len());
        let mut behind = Vec::with_capacity(plan.slots.len());
        for (slot, described) in plan.slots.iter().zip(plan.slots()) {
            let name = described.resources.first().map_or("", |&tenant| plan.decl.resource_name(tenant));
            let slot = if pool.poison { poison::fillable(*slot, device.features()) } else { *slot };
            let (key, physical) = pool.slots.acquire(device, &slot, name, frame)?;
            slots.push(key);
            behind.push(physical);
        }
        let objects =
            plan.placements.iter().map(|placement| Some(behind[placement.slot?.index()].clone())).collect();
        let (labels, plan) = (Labels::new(plan), plan.clone());
        let views = vec![None; plan.decl.accesses.len()];
        let mut own =
            Self { plan, frame, slots, objects, views, moving: Vec::new(), labels, last_groups: None };
        own.find_attachments(&mut pool.caches().views);
        Ok(own)
    }

    fn find_attachments(&mut self, views: &mut Views) {
        let plan = &self.plan;
        for &pass in &plan.order {
            for index in plan.decl.access_range(pass) {
                let access = &plan.decl.accesses[index];
                if access.access.is_attachment() && plan.decl.pass(pass).kind == crate::PassKind::Render {
                    match &self.objects[access.resource.index()] {
                        Some(Physical::Texture(texture)) => {
                            let part = plan.decl.subresource(access);
                            self.views[index] = Some(views.get(texture, part, Purpose::Attachment));
                        }
                        _ => self.moving.push(index as u32),
                    }
                }
            }
        }
    }

    /// Puts in what belongs to the caller or to a history.
    pub(super) fn arrive(&mut self, work: &Work<'_>, pool: &Pool) {
        for (index, resource) in self.plan.decl.resources.iter().enumerate() {
            if let Origin::Imported { .. } = resource.origin {
                self.objects[index] = work.imports[index].clone();
            }
        }
        for &index in &self.moving {
            let access = &self.plan.decl.accesses[index as usize];
            let Some(Physical::Texture(texture)) = &self.objects[access.resource.index()] else { continue };
            let part = self.plan.decl.subresource(access);
            // A view of the caller's is not kept: a surface cannot be configured while one of its texture is.
            let own = matches!(self.plan.decl.resource(access.resource).origin, Origin::Imported { .. });
            self.views[index as usize] = Some(if own {
                view(texture, part, Purpose::Attachment)
            } else {
                pool.caches().views.get(texture, part, Purpose::Attachment)
            });
        }
    }

    /// Lets go of what [`arrive`](Self::arrive) put in, and keeps the rest for a frame with the same plan.
    pub(super) fn leave(mut self, pool: &mut Pool) {
        for (object, resource) in self.objects.iter_mut().zip(&self.plan.decl.resources) {
            if resource.origin != Origin::Transient {
                *object = None;
            }
        }
        for &index in &self.moving {
            self.views[index as usize] = None;
        }
        pool.realised.insert(0, self);
        pool.realised.truncate(KEPT);
    }

    pub(super) fn label(&self, pass: PassId) -> &str {
        self.labels.get(pass)
    }
}

/// An error if a pass draws into more than the device can hold of one texel.
fn check_colors(plan: &Plan, limits: &wgpu::Limits) -> Result<(), Error> {
    for &pass in &plan.order {
        let colors = || plan.decl.accesses(pass).iter().filter(|a| matches!(a.access, Access::Color(_)));
        if let Some(last) = colors().next_back() {
            let name = plan.decl.resource_name(last.resource);
            let count = colors().count() as u64;
            let allowed = u64::from(limits.max_color_attachments).min(COLORS as u64);
            limit(name, "max_color_attachments", count, allowed)?;
        }
        let mut bytes = 0u32;
        for access in colors() {
            let ResourceDesc::Texture(desc) = plan.decl.resource(access.resource).desc else { continue };
            // As WebGPU adds them up: each begins at a multiple of its own alignment.
            bytes = bytes.next_multiple_of(desc.format.target_component_alignment().unwrap_or(1));
            bytes += desc.format.target_pixel_byte_cost().unwrap_or(0);
            let allowed = limits.max_color_attachment_bytes_per_sample;
            let name = plan.decl.resource_name(access.resource);
            limit(name, "max_color_attachment_bytes_per_sample", bytes.into(), allowed.into())?;
        }
    }
    Ok(())
}

/// The paths of all passes in one string.
struct Labels {
    text: String,
    /// By pass.
    ends: Vec<u32>,
}

impl Labels {
    fn new(plan: &Plan) -> Self {
        let mut text = String::new();
        let mut ends = Vec::with_capacity(plan.pass_count());
        for pass in plan.decl.pass_ids() {
            plan.decl.write_pass_path(pass, &mut text);
            ends.push(text.len() as u32);
        }
        Self { text, ends }
    }

    fn get(&self, pass: PassId) -> &str {
        let start = pass.index().checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.text[start as usize..self.ends[pass.index()] as usize]
    }
}
