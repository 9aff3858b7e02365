//! Settings of `virtual`.

use crate::declare_settings;
use crate::settings::{NamedSettings, ShadowFilter};

declare_settings! {
    /// Settings of the technique `virtual`.
    pub struct VirtualSettings {
        /// Memory of the pool of physical pages: 64 MiB are 1,800 pages. The buffer that pages are drawn into takes twice as much; as the largest
        /// buffer of a device with the default limits of WebGPU has 128 MiB, the pool has at most 64 MiB there. Where the pool is too small for
        /// what a frame needs, all levels are coarser.
        pool_mib: u32 = 64, power_of_two 4..=1024, in "MiB";
        /// Levels by which maps are coarser (above 0) or finer (below 0) than pixels: with 0, texels are at most as wide as the pixels that they
        /// are read from; with -1, at most half as wide, with harder edges. Thin casters keep more of their shadows where texels are narrow.
        level_bias: f32 = -1.25, -3..=4, in "levels";
        /// Filter of lights without their own, in place of `cascades.filter` and `atlas.filter`; it is narrower where penumbrae are.
        filter: ShadowFilter = ShadowFilter::Tent7;
        /// Penumbrae widen with the distance to the blocker, for lights with the radii of the settings of `pcss`.
        penumbrae: bool = false;
        /// Maximum radius of penumbrae.
        max_penumbra_m: f32 = 1.0, 0.01..=10, in "metres";
    }
}

impl NamedSettings for VirtualSettings {
    const NAME: &'static str = "virtual";
}
