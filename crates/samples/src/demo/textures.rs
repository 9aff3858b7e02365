//! The demo scene's textures: paving, masonry, stone, earth, wood, cloth and a wrought-iron fence.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::noise::{SIZE, TilingNoise, cell, mix, normals, opaque, ramp, texture};
use shadowgraph_scene::Image;

/// Width and height of one fence panel and of its texture, metres.
pub(super) const FENCE_PANEL: DVec2 = DVec2::new(2.0, 1.8);

/// Returns the cell of a 4 x 4 grid of square slabs, and the distance (0 to 0.5 of a slab) from its edge.
fn slab(u: f64, v: f64) -> (i64, i64, f64) {
    let (x, y) = (u * 4.0, v * 4.0);
    let inside = |t: f64| (t - t.floor()).min(t.ceil() - t);
    (x.floor() as i64, y.floor() as i64, inside(x).min(inside(y)))
}

/// Returns light and dark slabs with joints between them.
pub(super) fn paving() -> Image {
    let noise = TilingNoise::new([8, 8], 4, 11);
    texture("paving", |u, v| {
        let (x, y, edge) = slab(u, v);
        let dark = (x + y).rem_euclid(2) == 1;
        let base = if dark { DVec3::new(0.53, 0.47, 0.42) } else { DVec3::new(0.80, 0.75, 0.67) };
        let tone = 0.9 + 0.14 * cell(x, y, 5) + 0.16 * (noise.sample(u, v) - 0.5);
        opaque(mix(DVec3::new(0.30, 0.27, 0.23), base * tone, ramp(0.012, 0.035, edge)))
    })
}

/// Returns the normal map of [`paving`].
pub(super) fn paving_normals() -> Image {
    let noise = TilingNoise::new([16, 16], 3, 17);
    normals("paving normals", 0.006, |u, v| {
        let (x, y, edge) = slab(u, v);
        ramp(0.0, 0.045, edge) + 0.25 * noise.sample(u, v) + 0.1 * cell(x, y, 3)
    })
}

/// Returns the cell of 2:1 blocks in four courses, each shifted by half a block, and the distance from its edge in
/// heights of a course.
fn block(u: f64, v: f64) -> (i64, i64, f64) {
    let course = (v * 4.0).floor();
    let shift = if (course as i64).rem_euclid(2) == 1 { 0.5 } else { 0.0 };
    let (x, y) = (u * 2.0 + shift, v * 4.0);
    let inside = |t: f64| (t - t.floor()).min(t.ceil() - t);
    ((x.floor() as i64).rem_euclid(2), course as i64, (inside(x) * 2.0).min(inside(y)))
}

/// Returns hewn blocks of sandstone.
pub(super) fn masonry() -> Image {
    let noise = TilingNoise::new([6, 6], 5, 29);
    texture("masonry", |u, v| {
        let (x, y, edge) = block(u, v);
        let tone = 0.9 + 0.16 * cell(x, y, 23) + 0.2 * (noise.sample(u, v) - 0.5);
        let base = DVec3::new(0.76, 0.68, 0.55) * tone;
        opaque(mix(DVec3::new(0.52, 0.46, 0.38), base, ramp(0.01, 0.05, edge)))
    })
}

/// Returns the normal map of [`masonry`].
pub(super) fn masonry_normals() -> Image {
    let noise = TilingNoise::new([12, 12], 4, 31);
    normals("masonry normals", 0.008, |u, v| {
        let (_, _, edge) = block(u, v);
        ramp(0.0, 0.07, edge) + 0.4 * noise.sample(u, v)
    })
}

/// Returns pale stone without joints.
pub(super) fn stone() -> Image {
    let (noise, veins) = (TilingNoise::new([4, 4], 5, 37), TilingNoise::new([3, 3], 4, 41));
    texture("stone", |u, v| {
        let tone = 0.86 + 0.28 * (noise.sample(u, v) - 0.3);
        let vein = 1.0 - 0.12 * ramp(0.06, 0.0, (veins.sample(u, v) - 0.5).abs());
        opaque(DVec3::new(0.80, 0.75, 0.66) * tone * vein)
    })
}

/// Returns dry grass and earth.
pub(super) fn earth() -> Image {
    let (patches, grains) = (TilingNoise::new([5, 5], 5, 43), TilingNoise::new([128, 128], 1, 47));
    texture("earth", |u, v| {
        let patch = ramp(0.35, 0.65, patches.sample(u, v));
        let grain = 0.88 + 0.24 * grains.sample(u, v);
        opaque(mix(DVec3::new(0.58, 0.53, 0.34), DVec3::new(0.43, 0.48, 0.27), patch) * grain)
    })
}

/// Returns four upright planks.
pub(super) fn planks() -> Image {
    let grains = TilingNoise::new([48, 3], 3, 53);
    texture("planks", |u, v| {
        let x = u * 4.0;
        let gap = (x - x.floor()).min(x.ceil() - x);
        let plank = x.floor() as i64;
        let grain = grains.sample(u, v + 0.37 * plank as f64);
        let tone = (0.8 + 0.25 * cell(plank, 0, 59)) * (0.75 + 0.45 * grain);
        opaque(DVec3::new(0.58, 0.40, 0.24) * tone * ramp(0.0, 0.05, gap).max(0.25))
    })
}

/// Returns the normal map of [`planks`].
pub(super) fn planks_normals() -> Image {
    let grains = TilingNoise::new([48, 3], 3, 53);
    normals("planks normals", 0.008, |u, v| {
        let x = u * 4.0;
        let gap = (x - x.floor()).min(x.ceil() - x);
        ramp(0.0, 0.06, gap) + 0.3 * grains.sample(u, v + 0.37 * x.floor())
    })
}

/// Returns red cloth with a golden border and a sun.
pub(super) fn cloth() -> Image {
    texture("cloth", |u, v| {
        let border = ramp(0.045, 0.055, u.min(1.0 - u)) - ramp(0.075, 0.085, u.min(1.0 - u));
        let from_center = DVec2::new(u - 0.5, v - 0.5);
        let (distance, angle) = (from_center.length(), from_center.y.atan2(from_center.x));
        let disc = ramp(0.145, 0.135, distance);
        // Twelve rays that taper to their points.
        let ray = ((angle / TAU * 12.0).rem_euclid(1.0) - 0.5).abs();
        let rays = ramp(0.02, -0.02, ray - 0.42 * (0.29 - distance) / 0.13) * ramp(0.165, 0.175, distance);
        let gold = (1.0 - border).min(1.0 - disc).min(1.0 - rays.clamp(0.0, 1.0));
        let thread = 0.93 + 0.07 * ((u * 128.0 * TAU).sin() * (v * 128.0 * TAU).sin());
        opaque(mix(DVec3::new(0.93, 0.70, 0.24), DVec3::new(0.60, 0.09, 0.08), gold) * thread)
    })
}

/// Returns black iron in alpha: upright bars, three rails, rings between them, and spear points.
pub(super) fn fence() -> Image {
    let grains = TilingNoise::new([64, 64], 1, 61);
    let pixel = FENCE_PANEL.x / f64::from(SIZE);
    texture("wrought iron", |u, v| {
        let distance = fence_distance(DVec2::new(u, 1.0 - v) * FENCE_PANEL);
        let alpha = (0.5 - distance / pixel).clamp(0.0, 1.0);
        let tone = 0.16 + 0.06 * grains.sample(u, v);
        [tone * 0.95, tone, tone, alpha]
    })
}

/// Returns the signed distance from the iron, metres, negative inside, at a point of the panel (x to the right, y up).
fn fence_distance(point: DVec2) -> f64 {
    const SPACING: f64 = 0.2;
    // Relative to the nearest bar.
    let x = (point.x - SPACING * 0.5).rem_euclid(SPACING);
    let x = if x > SPACING * 0.5 { x - SPACING } else { x };
    let between = SPACING * 0.5 - x.abs();
    let bar = if point.y < 1.64 { x.abs() - 0.013 } else { f64::INFINITY };
    let spear = (x.abs() / 0.034 + (point.y - 1.69).abs() / 0.09 - 1.0) * 0.03;
    let rail = |y: f64| (point.y - y).abs() - 0.019;
    let circle = |y: f64, radius: f64| (DVec2::new(between, point.y - y).length() - radius).abs() - 0.011;
    let rails = rail(0.12).min(rail(1.30)).min(rail(1.56));
    let rings = circle(1.43, 0.085).min(circle(0.235, 0.07));
    bar.min(spear).min(rails).min(rings)
}
