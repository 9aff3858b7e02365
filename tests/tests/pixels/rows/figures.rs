//! The choices that the source texts explain with figures: each brings shadows closer to ray tracing, or makes edges wider.

use shadowgraph::ViewOptions;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::ShadowFilter;

use super::{dark_and_between, greys, pillar_view, pillars, wrong};
use crate::stage::{gpu, sun, sun_direction};

/// Returns pillars, the last of which is 27 m away from the camera.
fn pillars_in_sun() -> Scene {
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    scene
}

/// Returns a view with visible texels: one lookup per pixel, and the filter of one tap.
fn texels(count: u32, map_size_px: u32, distance_m: f32) -> ViewOptions {
    pillar_view(|settings| {
        settings.distance_m = distance_m;
        settings.supersample = false;
        settings.cascades.count = count;
        settings.cascades.map_size_px = map_size_px;
        settings.cascades.filter = ShadowFilter::Tent2;
    })
}

#[test]
fn row_56_larger_maps_shorter_distances_and_more_cascades_are_closer_to_rays() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    let choices = [
        ("map size 256 and 4096", (1, 256, 60.0), (1, 4096, 60.0)),
        ("distance 100 m and 30 m", (1, 1024, 100.0), (1, 1024, 30.0)),
        ("one cascade and four", (1, 2048, 100.0), (4, 2048, 100.0)),
    ];
    for (name, before, after) in choices {
        let [before, after] = [before, after].map(|(count, map_size_px, distance_m)| {
            wrong(gpu, &scene, 0, &texels(count, map_size_px, distance_m))
        });
        println!("{name}: {before} and {after} wrong pixels");
        assert!(after * 2 < before, "{name}: {before} {after}");
    }
}

#[test]
fn row_56_wider_filters_have_wider_edges_in_one_map() {
    let Some(gpu) = gpu() else { return };
    let scene = pillars_in_sun();
    let between = ShadowFilter::ALL.map(|filter| {
        let mut options = texels(1, 2048, 60.0);
        options.shadows.cascades.filter = filter;
        dark_and_between(&greys(gpu, &scene, 0, &options)).1
    });
    println!("pixels in penumbra of each filter: {between:?}");
    assert!(between.windows(2).all(|pair| pair[1] * 5 > pair[0] * 6), "{between:?}");
}
