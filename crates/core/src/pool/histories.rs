//! The textures of histories, from frame to frame.

use super::slots::{PhysicalResource, create_texture};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::history::{HistoryUse, PriorHistory, Resize};
use crate::internal::{Resampler, can_resample};
use crate::plan::Plan;
use std::sync::Arc;
use wgpu::TextureUsages;

/// One history and its two halves.
struct PooledHistory {
    prior: PriorHistory,
    usage: TextureUsages,
    /// The half that the last frame wrote comes first: it is the next frame's `previous`.
    halves: [wgpu::Texture; 2],
    /// The frame that used it last.
    used: u64,
}

/// All histories of a graph. Executing a frame acquires its textures by [`acquire`](Self::acquire) and passes them on to
/// the next frame by [`release`](Self::release). Until then nothing changes, so a frame that fails, or is never executed,
/// has no effect.
#[derive(Default)]
pub(crate) struct Histories {
    all: Vec<PooledHistory>,
    /// Created for the frame being recorded.
    new: Vec<PooledHistory>,
    resampler: Resampler,
    prior: Arc<Vec<PriorHistory>>,
}

impl Histories {
    /// Returns the histories that hold contents.
    pub(crate) fn prior(&self) -> Arc<Vec<PriorHistory>> {
        self.prior.clone()
    }

    /// Returns the bytes of all halves, without the driver's padding.
    pub(crate) fn bytes(&self) -> u64 {
        self.all.iter().map(|history| 2 * history.prior.desc.bytes()).sum()
    }

    /// Drops what was created for a frame that failed.
    pub(crate) fn discard_new(&mut self) {
        self.new.clear();
    }

    /// Sets the textures of a frame's histories in `objects`, which are by resource. Where a history has none yet, or they
    /// are not compatible, creates new ones and records into the encoder the transfer of contents that fit.
    pub(crate) fn acquire(
        &mut self,
        (plan, uses): (&Plan, &[HistoryUse]),
        objects: &mut [Option<PhysicalResource>],
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), Error> {
        self.new.clear();
        for used in uses {
            let Some(request) = HistoryRequest::new(plan, used, device.features()) else { continue };
            let before = self.all.iter().find(|history| history.matches(plan, used));
            let [previous, current] = match before {
                Some(history) if history.is_compatible(&request) => history.halves.clone(),
                _ => {
                    let history = request.create(before, &mut self.resampler, device, encoder)?;
                    let halves = history.halves.clone();
                    self.new.push(history);
                    halves
                }
            };
            objects[used.previous.index()] = Some(PhysicalResource::Texture(previous));
            objects[used.current.index()] = Some(PhysicalResource::Texture(current));
        }
        Ok(())
    }

    /// Swaps the halves of the histories that frame `frame` used, and drops what was last used before frame `oldest`.
    pub(crate) fn release(&mut self, (plan, uses): (&Plan, &[HistoryUse]), frame: u64, oldest: u64) {
        let (mut changed, before) = (!self.new.is_empty(), self.all.len());
        for new in self.new.drain(..) {
            match self.all.iter_mut().find(|old| old.prior.is_same_history(&new.prior)) {
                Some(old) => *old = new,
                None => self.all.push(new),
            }
        }
        for used in uses {
            if let Some(history) = self.all.iter_mut().find(|history| history.matches(plan, used)) {
                history.halves.swap(0, 1);
                history.used = frame;
            }
        }
        self.all.retain(|history| history.used >= oldest);
        changed |= self.all.len() != before;
        // Frames that were started before may still hold the old list.
        if changed {
            self.prior = Arc::new(self.all.iter().map(|history| history.prior.clone()).collect());
        }
    }
}

impl PooledHistory {
    fn matches(&self, plan: &Plan, used: &HistoryUse) -> bool {
        self.prior.matches(&plan.decl, used.view, used.current)
    }

    fn is_compatible(&self, request: &HistoryRequest<'_>) -> bool {
        self.prior.desc == request.desc && self.usage.contains(request.usage)
    }
}

/// Requirements of a frame on a history.
struct HistoryRequest<'p> {
    plan: &'p Plan,
    used: &'p HistoryUse,
    desc: TextureDesc,
    usage: TextureUsages,
}

impl<'p> HistoryRequest<'p> {
    fn new(plan: &'p Plan, used: &'p HistoryUse, features: wgpu::Features) -> Option<Self> {
        let ResourceDesc::Texture(desc) = plan.decl.resource(used.current).desc else { return None };
        // Copies transfer the contents when a usage is added.
        let mut usage = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        for half in [used.previous, used.current] {
            usage |= plan.placements[half.index()].texture_usage;
        }
        if used.resize == Resize::Resample && can_resample(&desc, features).is_ok() {
            usage |= TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
        }
        if desc.samples > 1 {
            usage |= TextureUsages::RENDER_ATTACHMENT;
        }
        Some(Self { plan, used, desc, usage })
    }

    /// Creates both halves, with all usages that the history ever had, and fills the first with the contents of `before`.
    /// Contents that do not fit are replaced by wgpu's zeros.
    fn create(
        &self,
        before: Option<&PooledHistory>,
        resampler: &mut Resampler,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<PooledHistory, Error> {
        let (decl, desc) = (&self.plan.decl, &self.desc);
        let same_shape = before.filter(|before| before.prior.differs_in_size_only(desc));
        let usage = same_shape.map_or(self.usage, |before| before.usage | self.usage);
        let name = decl.resource_name(self.used.current);
        let halves = [create_texture(device, desc, usage, name)?, create_texture(device, desc, usage, name)?];
        if let Some(before) = before.filter(|before| before.prior.fits(desc, self.used.resize)) {
            let source = &before.halves[0];
            if before.prior.desc == *desc {
                copy_texture(encoder, source, &halves[0]);
            } else {
                let resampled = resampler.record(device, encoder, source, &halves[0]);
                debug_assert_eq!(resampled, Ok(()), "contents that fit can be resampled");
            }
        }
        let mut view = String::new();
        if let Some(node) = self.used.view {
            decl.write_node_path(node, &mut view);
        }
        let can_resample =
            usage.contains(TextureUsages::TEXTURE_BINDING) && can_resample(desc, device.features()).is_ok();
        let prior = PriorHistory { view, name: name.into(), desc: *desc, can_resample };
        Ok(PooledHistory { prior, usage, halves, used: 0 })
    }
}

/// Copies all of a texture to another of the same shape. Depth and multisampled textures allow it, since whole mips are
/// copied.
fn copy_texture(encoder: &mut wgpu::CommandEncoder, source: &wgpu::Texture, target: &wgpu::Texture) {
    for mip in 0..source.mip_level_count() {
        let size = source.size().mip_level_size(mip, source.dimension()).physical_size(source.format());
        let location = |texture| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: mip,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        };
        encoder.copy_texture_to_texture(location(source), location(target), size);
    }
}
