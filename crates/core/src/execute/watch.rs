//! Recording with a copy of one version of a texture, for watching it while a program runs.

use super::Executed;
use super::capture::{PendingSnapshot, aspect};
use super::record::record;
use crate::capture::TextureSnapshot;
use crate::compile::watching;
use crate::compiled::Compiled;
use crate::context::Recording;
use crate::declaration::AccessDecl;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::PassId;
use crate::plan::Plan;
use crate::pool::Pool;
use crate::read_back::TexturePart;
use crate::subresource::Subresource;
use crate::timer::Timer;
use crate::watch::{WatchedPlan, WatchedTexture};
use std::sync::Arc;

/// A watched texture on its way to the CPU.
#[must_use = "only `wait` returns the texture"]
pub struct PendingTexture(PendingSnapshot);

impl PendingTexture {
    /// Returns whether the texels have arrived, so that waiting returns at once. A later `Queue::submit` or `Device::poll` notices that.
    pub fn is_ready(&self) -> bool {
        self.0.is_ready()
    }

    /// Waits for the submitted frame and returns the texture.
    ///
    /// # Errors
    /// When the device is lost, or the encoder was not submitted.
    pub fn wait(self, device: &wgpu::Device) -> Result<TextureSnapshot, Error> {
        let mut snapshots = Vec::new();
        self.0.decode(device, &mut snapshots)?;
        let missing =
            || Error::ReadBack { resource: "watched texture".into(), problem: "it has no texels".into() };
        snapshots.pop().ok_or_else(missing)
    }
}

/// Records a frame, and a copy of the watched version if the frame writes it.
pub(super) fn record_watched(
    mut compiled: Compiled<'_>,
    (pool, known): (&mut Pool, &mut Option<WatchedPlan>),
    watch: &WatchedTexture,
    (device, encoder): (&wgpu::Device, &mut wgpu::CommandEncoder),
    timer: Option<&mut Timer>,
) -> Result<Executed, Error> {
    let plan = compiled.plan.clone();
    let Some((position, access, desc)) = written(&plan, watch) else {
        return record(compiled, pool, device, encoder, timer, None);
    };
    let is_known = |known: &WatchedPlan| Arc::ptr_eq(&known.plan, &plan) && known.watch == *watch;
    compiled.plan = match known.take_if(|known| is_known(known)) {
        Some(WatchedPlan { watching, .. }) => watching,
        None => Arc::new(watching(&plan, position, access.resource)),
    };
    *known = Some(WatchedPlan { plan: plan.clone(), watch: watch.clone(), watching: compiled.plan.clone() });
    let writer = plan.order[position];
    let mut taken = None;
    let mut hook = |recording: &Recording<'_>, pass: PassId, encoder: &mut wgpu::CommandEncoder| {
        if pass == writer {
            let part = TexturePart {
                mip: watch.mip,
                layers: watch.layer..watch.layer + 1,
                aspect: aspect(&desc, Subresource::FULL),
                rect: None,
            };
            taken = Some(PendingSnapshot::new(recording, (pass, &access, &desc), part, encoder));
        }
        Ok(())
    };
    let mut executed = record(compiled, pool, device, encoder, timer, Some(&mut hook))?.with_plan(plan);
    executed.watched = taken.map(PendingTexture);
    Ok(executed)
}

/// Returns the position of the pass that writes the watched version, and its access to the texture, if that has the mip level and the layer.
fn written(plan: &Plan, watch: &WatchedTexture) -> Option<(usize, AccessDecl, TextureDesc)> {
    let decl = &plan.decl;
    let is_named = |access: &AccessDecl| {
        decl.resource_name(access.resource) == watch.texture
            || plan.resource_path(access.resource) == watch.texture
    };
    let mut writes = plan.order.iter().enumerate().flat_map(|(position, &pass)| {
        let writes = decl.accesses(pass).iter().filter(|access| access.contents.writes());
        writes.map(move |access| (position, access))
    });
    let wanted = |access: &AccessDecl| watch.version.is_none_or(|version| version == access.version + 1);
    let (position, access) = writes.rfind(|(_, access)| wanted(access) && is_named(access))?;
    match decl.resource(access.resource).desc {
        ResourceDesc::Texture(desc) if watch.mip < desc.mip_levels => {
            let layers = Subresource::FULL.layer_range(&desc, watch.mip);
            layers.contains(&watch.layer).then_some((position, *access, desc))
        }
        _ => None,
    }
}
