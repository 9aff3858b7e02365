//! The physical objects of a plan.

use super::attachments::Attachments;
use super::bind_group_cache::GroupKey;
use super::pass_groups::PassGroups;
use super::poison::with_fill_usage;
use super::slots::{PhysicalResource, SlotKey};
use super::view_cache::{ViewCache, ViewUsage, create_view};
use super::{Pool, check_limit};
use crate::access::Access;
use crate::declaration::{Origin, PassKind};
use crate::desc::ResourceDesc;
use crate::device::MAX_COLOR_ATTACHMENTS;
use crate::error::Error;
use crate::handle::PassId;
use crate::plan::Plan;
use std::sync::Arc;

/// Plans whose objects are kept.
const MAX_KEPT_PLANS: usize = 4;

/// A plan with its objects on a device: physical textures and buffers, views of attachments, labels.
pub(crate) struct ResolvedPlan {
    plan: Arc<Plan>,
    /// The frame that used it last.
    pub(super) frame: u64,
    slots: Vec<SlotKey>,
    /// Physical slots by resource.
    pub(crate) objects: Vec<Option<PhysicalResource>>,
    /// Views of attachments in passes that run, by access.
    pub(crate) views: Vec<Option<wgpu::TextureView>>,
    /// Accesses of attachments whose objects change from frame to frame.
    changing_attachments: Vec<u32>,
    pub(crate) attachments: Attachments,
    labels: Labels,
    /// Present from the second frame on.
    pub(crate) pass_groups: Option<PassGroups>,
}

impl ResolvedPlan {
    /// Finds the objects of a plan, or takes them from the pool.
    pub(crate) fn acquire(
        plan: &Arc<Plan>,
        pool: &mut Pool,
        device: &wgpu::Device,
        frame: u64,
    ) -> Result<Self, Error> {
        let is_same = |known: &Self| known.plan.structure.is_same(plan.structure);
        if let Some(index) = pool.resolved_plans.iter().position(is_same) {
            let mut known = pool.resolved_plans.remove(index);
            if !Arc::ptr_eq(&known.plan, plan) {
                known.plan = plan.clone();
                known.attachments = Attachments::new(plan, pool.poison);
            }
            if frame - known.frame > pool.limits.idle_frames.into() {
                known.pass_groups = None;
            }
            known.pass_groups.get_or_insert_with(|| PassGroups::new(plan.pass_count()));
            known.frame = frame;
            pool.slots.touch(&known.slots, frame);
            return Ok(known);
        }
        check_colors(plan, &device.limits())?;
        let mut slots = Vec::with_capacity(plan.slots.len());
        let mut slot_objects = Vec::with_capacity(plan.slots.len());
        for (slot, described) in plan.slots.iter().zip(plan.slots()) {
            let name = described.resources.first().map_or("", |&resource| plan.decl.resource_name(resource));
            let slot = if pool.poison { with_fill_usage(*slot, device.features()) } else { *slot };
            let (key, object) = pool.slots.acquire(device, &slot, name, frame)?;
            slots.push(key);
            slot_objects.push(object);
        }
        let objects = plan
            .placements
            .iter()
            .map(|placement| Some(slot_objects[placement.slot?.index()].clone()))
            .collect();
        let mut resolved = Self {
            plan: plan.clone(),
            frame,
            slots,
            objects,
            views: vec![None; plan.decl.accesses.len()],
            changing_attachments: Vec::new(),
            attachments: Attachments::new(plan, pool.poison),
            labels: Labels::new(plan),
            pass_groups: None,
        };
        resolved.find_attachments(&mut pool.caches().views);
        Ok(resolved)
    }

    fn find_attachments(&mut self, views: &mut ViewCache) {
        let plan = &self.plan;
        for &pass in &plan.order {
            for index in plan.decl.access_range(pass) {
                let access = &plan.decl.accesses[index];
                if access.access.is_attachment() && plan.decl.pass(pass).kind == PassKind::Render {
                    match &self.objects[access.resource.index()] {
                        Some(PhysicalResource::Texture(texture)) => {
                            let part = plan.decl.subresource(access);
                            self.views[index] = Some(views.get(texture, part, ViewUsage::Attachment));
                        }
                        _ => self.changing_attachments.push(index as u32),
                    }
                }
            }
        }
    }

    /// Sets the objects of imports, which `imports` has by resource, and creates the views of attachments that are imports
    /// or histories.
    pub(crate) fn bind_imports(&mut self, imports: &[Option<PhysicalResource>], pool: &Pool) {
        for (index, resource) in self.plan.decl.resources.iter().enumerate() {
            if let Origin::Imported { .. } = resource.origin {
                self.objects[index] = imports[index].clone();
            }
        }
        for &index in &self.changing_attachments {
            let access = &self.plan.decl.accesses[index as usize];
            let Some(PhysicalResource::Texture(texture)) = &self.objects[access.resource.index()] else {
                continue;
            };
            let part = self.plan.decl.subresource(access);
            // Views of imports are not cached: a surface cannot be configured while a view of its texture exists.
            let imported = matches!(self.plan.decl.resource(access.resource).origin, Origin::Imported { .. });
            self.views[index as usize] = Some(if imported {
                create_view(texture, part, ViewUsage::Attachment)
            } else {
                pool.caches().views.get(texture, part, ViewUsage::Attachment)
            });
        }
    }

    /// Drops the objects of imports and histories and keeps the rest for the next frame with the same plan.
    pub(crate) fn release(mut self, pool: &mut Pool) {
        for (object, resource) in self.objects.iter_mut().zip(&self.plan.decl.resources) {
            if resource.origin != Origin::Transient {
                *object = None;
            }
        }
        for &index in &self.changing_attachments {
            self.views[index as usize] = None;
        }
        pool.resolved_plans.insert(0, self);
        pool.resolved_plans.truncate(MAX_KEPT_PLANS);
    }

    /// Returns the bind groups that passes have kept, and the frame that used them last.
    pub(super) fn kept_groups(&self) -> impl Iterator<Item = (GroupKey, u64)> {
        self.pass_groups.iter().flat_map(PassGroups::keys).map(|key| (key, self.frame))
    }

    pub(crate) fn label(&self, pass: PassId) -> &str {
        self.labels.get(pass)
    }
}

/// Checks the number of colour attachments of each pass and their bytes per texel.
fn check_colors(plan: &Plan, limits: &wgpu::Limits) -> Result<(), Error> {
    for &pass in &plan.order {
        let colors = || plan.decl.accesses(pass).iter().filter(|a| matches!(a.access, Access::Color(_)));
        if let Some(last) = colors().next_back() {
            let name = plan.decl.resource_name(last.resource);
            let count = colors().count() as u64;
            let allowed = u64::from(limits.max_color_attachments).min(MAX_COLOR_ATTACHMENTS as u64);
            check_limit(name, "max_color_attachments", count, allowed)?;
        }
        let mut bytes = 0u32;
        for access in colors() {
            let ResourceDesc::Texture(desc) = plan.decl.resource(access.resource).desc else { continue };
            // By the rules of WebGPU, each begins at a multiple of its alignment.
            bytes = bytes.next_multiple_of(desc.format.target_component_alignment().unwrap_or(1));
            bytes += desc.format.target_pixel_byte_cost().unwrap_or(0);
            let allowed = limits.max_color_attachment_bytes_per_sample;
            let name = plan.decl.resource_name(access.resource);
            check_limit(name, "max_color_attachment_bytes_per_sample", bytes.into(), allowed.into())?;
        }
    }
    Ok(())
}

/// The paths of all passes in one string.
struct Labels {
    text: String,
    /// Ends by pass.
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
