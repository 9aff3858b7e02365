//! Allocations for random lights, compared with a reference that paints cells.
#![allow(clippy::unwrap_used, reason = "tests")]

mod crowded;
mod frames;
mod placement;
mod reference;
mod robustness;
mod sizes;
mod stability;

use proptest::prelude::*;

use super::*;

const CONFIG: AtlasConfig = AtlasConfig { map_px: 512, smallest_px: 32, largest_px: 256, growth: 0 };

fn request(owner: u32, tiles: u32, size_px: f64, importance: f64) -> TileRequest {
    TileRequest { owner, tiles, size_px, importance }
}

fn size_of(allocation: &AtlasAllocation, owner: u32) -> Option<u32> {
    allocation.for_owner(owner).map(|entry| entry.tile_px)
}

fn sizes(allocation: &AtlasAllocation) -> Vec<(u32, u32)> {
    allocation.owners.iter().map(|entry| (entry.owner, entry.tile_px)).collect()
}

/// Maps of up to 16 by 16 cells.
fn any_config() -> impl Strategy<Value = AtlasConfig> {
    let levels = prop_oneof![1 => (0_u32..=4, 0_u32..=4), 3 => (3_u32..=4, 1_u32..=3)];
    (0_u32..=5, levels, 0_u32..=2).prop_map(|(smallest, (map, largest), growth)| AtlasConfig {
        growth,
        map_px: 1 << (smallest + map),
        smallest_px: 1 << smallest,
        largest_px: 1 << (smallest + largest.min(map)),
    })
}

/// Sizes as logarithms relative to the smallest size: below, within and above the allowed range.
fn any_size() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1.0_f64..5.0, 1 => (-1_i32..5).prop_map(f64::from)]
}

/// Importances, many of them equal.
fn any_importance() -> impl Strategy<Value = f64> {
    prop_oneof![-1.0_f64..1.0, (-1_i32..=1).prop_map(f64::from)]
}

fn any_tiles() -> impl Strategy<Value = u32> {
    prop_oneof![3 => Just(1_u32), 2 => Just(6), 1 => 0_u32..=8]
}

/// Requests with sizes in pixels, owners not in order and not all in use.
fn any_requests(config: AtlasConfig, most: usize) -> impl Strategy<Value = Vec<TileRequest>> {
    let one = (any_tiles(), any_size(), any_importance());
    proptest::collection::vec(one, 0..=most).prop_map(move |requests| {
        let with_owner = |(i, (tiles, size, importance)): (usize, (u32, f64, f64))| {
            let owner = (i as u32 * 7 + 3) % 64;
            request(owner, tiles, f64::from(config.smallest_px) * size.exp2(), importance)
        };
        requests.into_iter().enumerate().map(with_owner).collect()
    })
}

fn config_and_requests(most: usize) -> impl Strategy<Value = (AtlasConfig, Vec<TileRequest>)> {
    any_config().prop_flat_map(move |config| (Just(config), any_requests(config, most)))
}

/// Requests, and a previous allocation with the same config for other requests of the same owners.
fn with_history(most: usize) -> impl Strategy<Value = (AtlasConfig, Vec<TileRequest>, AtlasAllocation)> {
    let two = move |config| (Just(config), any_requests(config, most), any_requests(config, most));
    any_config().prop_flat_map(two).prop_map(|(config, requests, before)| {
        let crowded = allocate_tiles(&config, &before, None);
        let fewer = before.get(before.len() / 3..).unwrap_or(&[]);
        (config, requests, allocate_tiles(&config, fewer, Some(&crowded)))
    })
}
