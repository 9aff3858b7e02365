//! Counts the draws of shadow casters.

use std::sync::atomic::{AtomicU64, Ordering};

use shadowgraph_scene::{Aabb, CullVolume};
use shadowgraph_shadows::rays::GpuRayScene;
use shadowgraph_shadows::{CasterView, LayeredCasters, Mobility, ShadowCasters};

use shadowgraph::SceneCasters;

/// Casters of a scene, with counters of their draws and triangles.
pub(super) struct CountingCasters<'a> {
    casters: &'a SceneCasters,
    draws: AtomicU64,
    triangles: AtomicU64,
}

impl<'a> CountingCasters<'a> {
    pub(super) fn new(casters: &'a SceneCasters) -> Self {
        Self { casters, draws: AtomicU64::new(0), triangles: AtomicU64::new(0) }
    }

    /// Returns the numbers of draws and triangles so far.
    pub(super) fn counts(&self) -> (u64, u64) {
        (self.draws.load(Ordering::Relaxed), self.triangles.load(Ordering::Relaxed))
    }
}

impl ShadowCasters for CountingCasters<'_> {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        self.casters.cull(volume, casters);
    }

    fn bounds(&self) -> Aabb {
        self.casters.bounds()
    }

    fn caster_bounds(&self, caster: u32) -> Aabb {
        self.casters.caster_bounds(caster)
    }

    fn version(&self, caster: u32) -> Option<u64> {
        self.casters.version(caster)
    }

    fn mobility(&self, caster: u32) -> Mobility {
        self.casters.mobility(caster)
    }

    fn caster_name(&self, caster: u32) -> Option<&str> {
        self.casters.caster_name(caster)
    }

    fn tints(&self, caster: u32) -> bool {
        self.casters.tints(caster)
    }

    fn receivers(&self) -> Aabb {
        self.casters.receivers()
    }

    fn has_receiver_in(&self, volume: &CullVolume) -> bool {
        self.casters.has_receiver_in(volume)
    }

    fn rays(&self) -> Option<&GpuRayScene> {
        self.casters.rays()
    }

    fn layered(&self) -> Option<&dyn LayeredCasters> {
        // The GPU knows what is drawn: not counted.
        self.casters.layered()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32 {
        self.draws.fetch_add(casters.len() as u64, Ordering::Relaxed);
        self.triangles.fetch_add(self.casters.triangle_count(casters), Ordering::Relaxed);
        self.casters.draw(pass, view, casters)
    }
}
