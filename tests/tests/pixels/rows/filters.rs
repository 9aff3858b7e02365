//! Filters, and which of them apply to a light.

use super::{cube_under_spot, cube_view, dark_and_between, greys, pillar_view, pillars, plan};
use crate::stage::{cube_on_floor, gpu, sun, sun_direction};
use glam::DVec3;
use shadowgraph::shadows::{CommonLookup, LightShadows, LookupSource, LookupVariant, MapUse, ShadowFilter};

#[test]
fn row_06_the_shader_is_compiled_for_the_filters_of_the_frame() {
    let mut scene = cube_on_floor(DVec3::ZERO);
    let mut options = cube_view(|_| ());
    assert_eq!(plan(&scene, &options).variant(), LookupVariant::Unshadowed);
    scene.insert_light(sun(sun_direction(40.0, 30.0)));
    let sun_only = CommonLookup {
        source: LookupSource::OneLight,
        taps: 3,
        map: Some(MapUse::Cascades),
        simple: true,
        untinted: true,
    };
    assert_eq!(plan(&scene, &options).variant(), LookupVariant::Shadowed(sun_only));
    scene.insert_light(super::spot(DVec3::new(-3.0, 3.5, 1.0), DVec3::ZERO, 0.6));
    let Some(gpu) = gpu() else { return };
    let one = greys(gpu, &scene, 0, &options);
    let hard = LightShadows { filter: Some(ShadowFilter::Tent2), ..LightShadows::new(1.into()) };
    options.shadows.lights = vec![hard];
    let mixed = CommonLookup { source: LookupSource::Uniform, taps: 0, map: None, ..sun_only };
    assert_eq!(plan(&scene, &options).variant(), LookupVariant::Shadowed(mixed));
    // The sun's shadows are the same with either shader, and the spot light's are not.
    assert_eq!(greys(gpu, &scene, 0, &options), one);
    let soft = greys(gpu, &scene, 1, &cube_view(|_| ()));
    assert!(greys(gpu, &scene, 1, &options) != soft);
}

#[test]
fn row_14_cascades_and_atlas_have_separate_filters() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_under_spot();
    scene.insert_light(sun(sun_direction(40.0, 30.0)));
    let between = |light, cascades, atlas| {
        let options = cube_view(|settings| {
            settings.cascades.filter = cascades;
            settings.atlas.filter = atlas;
            // Texels that are visible.
            settings.cascades.map_size_px = 1024;
            settings.atlas.map_size_px = 512;
        });
        dark_and_between(&greys(gpu, &scene, light, &options)).1
    };
    let (hard, soft) = (ShadowFilter::Tent2, ShadowFilter::Tent7);
    let sun = [between(0, hard, soft), between(0, soft, hard)];
    let spot = [between(1, hard, soft), between(1, soft, hard)];
    assert!(sun[0] * 2 < sun[1] && spot[1] * 2 < spot[0], "{sun:?} {spot:?}");
}

#[test]
fn row_21_wider_filters_have_wider_edges() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(sun_direction(40.0, 30.0)));
    // One cascade, so that texels have the same size everywhere.
    let between = ShadowFilter::ALL.map(|filter| {
        let options = cube_view(|settings| {
            settings.cascades.count = 1;
            settings.cascades.filter = filter;
            settings.cascades.map_size_px = 1024;
        });
        dark_and_between(&greys(gpu, &scene, 0, &options)).1
    });
    assert!(between.windows(2).all(|pair| pair[0] * 5 < pair[1] * 4), "{between:?}");
}

#[test]
fn row_32_the_filter_gets_narrower_with_distance() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    // One cascade, so that texels have the same size everywhere.
    let between = |far_filter| {
        let options = pillar_view(|settings| {
            settings.supersample = false;
            settings.cascades.count = 1;
            settings.cascades.far_filter = far_filter;
        });
        let greys = greys(gpu, &scene, 0, &options);
        // The upper half of the image is far away.
        let far = greys[..greys.len() / 2].to_vec();
        (dark_and_between(&far).1, dark_and_between(&greys).1)
    };
    let (narrow, wide) = (between(0.2), between(1.0));
    assert!(narrow.0 * 10 < wide.0 * 9, "{narrow:?} {wide:?}");
}
