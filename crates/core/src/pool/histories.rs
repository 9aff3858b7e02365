//! The textures behind histories, from frame to frame.

use super::slots::{Physical, create_texture};
use crate::compiled::Compiled;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::frame::{HistoryUse, Resize};
use crate::graph::PriorHistory;
use crate::internal::{Resampler, resamples};
use crate::plan::Plan;
use std::sync::Arc;
use wgpu::TextureUsages;

/// One history and its two halves.
struct History {
    known: PriorHistory,
    usage: TextureUsages,
    /// First what the last frame wrote: the next one's `previous`.
    halves: [wgpu::Texture; 2],
    /// The frame that used it last.
    used: u64,
}

/// All histories of a graph. A frame that is executed finds its textures by [`arrive`](Self::arrive), and by
/// [`leave`](Self::leave) hands them on to the next. Until then nothing changes, so a frame that fails, or is never
/// executed, does not count.
#[derive(Default)]
pub(crate) struct Histories {
    all: Vec<History>,
    /// Made for the frame being recorded.
    fresh: Vec<History>,
    resampler: Resampler,
    known: Arc<Vec<PriorHistory>>,
}

impl Histories {
    /// Returns the histories that hold contents.
    pub(crate) fn known(&self) -> Arc<Vec<PriorHistory>> {
        self.known.clone()
    }

    /// Returns the bytes of all halves, without the driver's padding.
    pub(crate) fn bytes(&self) -> u64 {
        self.all.iter().map(|history| 2 * history.known.desc.bytes()).sum()
    }

    /// Drops what was made for a frame that failed.
    pub(crate) fn forget_fresh(&mut self) {
        self.fresh.clear();
    }

    /// Puts the textures of the frame's histories among its objects. Where they are not there yet or will not do, new
    /// ones are made, and the encoder carries over the contents that fit.
    pub(crate) fn arrive(
        &mut self,
        compiled: &Compiled<'_>,
        objects: &mut [Option<Physical>],
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), Error> {
        self.fresh.clear();
        for own in &compiled.frame.work.histories {
            let Some(wanted) = Wanted::new(&compiled.plan, own, device.features()) else { continue };
            let before = self.all.iter().find(|history| history.is(&compiled.plan, own));
            let [previous, current] = match before {
                Some(history) if history.serves(&wanted) => history.halves.clone(),
                _ => {
                    let history = wanted.make(before, &mut self.resampler, device, encoder)?;
                    let halves = history.halves.clone();
                    self.fresh.push(history);
                    halves
                }
            };
            objects[own.previous.index()] = Some(Physical::Texture(previous));
            objects[own.current.index()] = Some(Physical::Texture(current));
        }
        Ok(())
    }

    /// Swaps the halves of what frame `frame` used, and drops what was last used before frame `oldest`.
    pub(crate) fn leave(&mut self, compiled: &Compiled<'_>, frame: u64, oldest: u64) {
        let (mut changed, before) = (!self.fresh.is_empty(), self.all.len());
        for fresh in self.fresh.drain(..) {
            match self.all.iter_mut().find(|old| old.known.is_same_history(&fresh.known)) {
                Some(old) => *old = fresh,
                None => self.all.push(fresh),
            }
        }
        for own in &compiled.frame.work.histories {
            if let Some(history) = self.all.iter_mut().find(|history| history.is(&compiled.plan, own)) {
                history.halves.swap(0, 1);
                history.used = frame;
            }
        }
        self.all.retain(|history| history.used >= oldest);
        changed |= self.all.len() != before;
        // Frames that were given out before may still hold the old list.
        if changed {
            self.known = Arc::new(self.all.iter().map(|history| history.known.clone()).collect());
        }
    }
}

impl History {
    fn is(&self, plan: &Plan, own: &HistoryUse) -> bool {
        self.known.is(&plan.decl, own.view, own.current)
    }

    fn serves(&self, wanted: &Wanted<'_>) -> bool {
        self.known.desc == wanted.desc && self.usage.contains(wanted.usage)
    }
}

/// What a frame needs of a history.
struct Wanted<'p> {
    plan: &'p Plan,
    own: &'p HistoryUse,
    desc: TextureDesc,
    usage: TextureUsages,
}

impl<'p> Wanted<'p> {
    fn new(plan: &'p Plan, own: &'p HistoryUse, features: wgpu::Features) -> Option<Self> {
        let ResourceDesc::Texture(desc) = plan.decl.resource(own.current).desc else { return None };
        // Copies carry the contents over when a usage is added.
        let mut usage = TextureUsages::COPY_SRC | TextureUsages::COPY_DST;
        for half in [own.previous, own.current] {
            usage |= plan.placements[half.index()].texture_usage;
        }
        if own.resize == Resize::Resample && resamples(&desc, features).is_ok() {
            usage |= TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
        }
        if desc.samples > 1 {
            usage |= TextureUsages::RENDER_ATTACHMENT;
        }
        Some(Self { plan, own, desc, usage })
    }

    /// Creates both halves, with all usages that the history ever had, and fills the first with what `before` holds.
    /// Where it does not fit, wgpu's zeros stay.
    fn make(
        &self,
        before: Option<&History>,
        resampler: &mut Resampler,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<History, Error> {
        let (decl, desc) = (&self.plan.decl, &self.desc);
        let alike = before.filter(|before| before.known.differs_in_size_only(desc));
        let usage = alike.map_or(self.usage, |before| before.usage | self.usage);
        let name = decl.resource_name(self.own.current);
        let halves = [create_texture(device, desc, usage, name)?, create_texture(device, desc, usage, name)?];
        if let Some(before) = before.filter(|before| before.known.fits(desc, self.own.resize)) {
            let source = &before.halves[0];
            if before.known.desc == *desc {
                copy(encoder, source, &halves[0]);
            } else {
                let drawn = resampler.record(device, encoder, source, &halves[0]);
                debug_assert_eq!(drawn, Ok(()), "what fits can be drawn");
            }
        }
        let mut view = String::new();
        if let Some(node) = self.own.view {
            decl.write_node_path(node, &mut view);
        }
        let bound = usage.contains(TextureUsages::TEXTURE_BINDING);
        let resamples = bound && resamples(desc, device.features()).is_ok();
        let known = PriorHistory { view, name: name.into(), desc: *desc, resamples };
        Ok(History { known, usage, halves, used: 0 })
    }
}

/// Copies all of a texture to another of its shape; also depth and several samples, since whole mips are copied.
fn copy(encoder: &mut wgpu::CommandEncoder, source: &wgpu::Texture, target: &wgpu::Texture) {
    for mip in 0..source.mip_level_count() {
        let size = source.size().mip_level_size(mip, source.dimension()).physical_size(source.format());
        let at = |texture| wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: mip,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        };
        encoder.copy_texture_to_texture(at(source), at(target), size);
    }
}
