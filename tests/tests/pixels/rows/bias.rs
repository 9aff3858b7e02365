//! Biases.

use super::{count, cube_view, greys, pillar_view, pillars, plan, wrong};
use crate::stage::{cube_on_floor, gpu, sun, sun_direction};
use glam::DVec3;
use shadowgraph::Renderer;
use shadowgraph::options::Aov;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{
    BiasMethod, BiasSettings, LightRef, LightShadows, NormalBias, PCF, ShadowFilter, VIRTUAL,
};

fn low_sun() -> Scene {
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(sun_direction(25.0, 130.0)));
    scene
}

const NO_BIAS: BiasSettings = BiasSettings {
    method: BiasMethod::Slope,
    normal_texels: 0.0,
    normal: NormalBias::Sine,
    slope: 0.0,
    min_slope: 0.0,
    max_slope: 10.0,
    depth_texels: 0.0,
};

/// Counts the pixels that are too dark.
fn acne(bias: BiasSettings, change: impl FnOnce(&mut shadowgraph::shadows::ShadowSettings)) -> Option<usize> {
    let gpu = gpu()?;
    let mut options = cube_view(|settings| {
        settings.bias = bias;
        settings.cascades.map_size_px = 1024;
    });
    change(&mut options.shadows);
    Some(count(&greys(gpu, &low_sun(), 0, &options), |grey| grey < 200))
}

#[test]
fn row_19_slope_scale_and_normal_bias_each_remove_acne() {
    let Some(none) = acne(NO_BIAS, |_| ()) else { return };
    let usual = acne(BiasSettings::default(), |_| ()).unwrap();
    let slope = BiasSettings { slope: 3.0, depth_texels: 1.0, ..NO_BIAS };
    let normal =
        BiasSettings { normal_texels: 1.0, normal: NormalBias::Filter, depth_texels: 0.5, ..NO_BIAS };
    for bias in [slope, normal] {
        let with = acne(bias.clone(), |_| ()).unwrap();
        assert!(with * 2 < none && with < usual + usual / 4, "{bias:?}: {none} {with} {usual}");
    }
}

#[test]
fn row_19_normal_bias_is_a_texels_diagonal_times_the_filters_radius_and_one() {
    for (filter, radius) in ShadowFilter::ALL.into_iter().zip([0.0, 1.0, 2.0, 3.0]) {
        let mut options = cube_view(|settings| {
            settings.cascades.filter = filter;
            settings.bias.normal_texels = 1.0;
            settings.bias.normal = NormalBias::Filter;
        });
        let texels = plan(&low_sun(), &options).lights[0].normal_bias_texels;
        assert!((texels - std::f32::consts::SQRT_2 * (1.0 + radius)).abs() < 1e-6, "{texels}");
        options.shadows.bias.normal = NormalBias::Sine;
        assert_eq!(plan(&low_sun(), &options).lights[0].normal_bias_texels, 1.0);
    }
}

#[test]
fn row_31_each_cascade_has_its_own_bias() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    // Without bias in the first cascade, acne appears only near the camera, in the lower part of the image.
    let dark = |method, scales: Vec<f32>| {
        let options = pillar_view(|settings| {
            settings.bias = BiasSettings { method, slope: 1.5, depth_texels: 1.0, ..NO_BIAS };
            settings.cascades.bias_scales = scales;
            settings.cascades.select = shadowgraph::shadows::CascadeSelection::Depth;
            settings.cascades.split = shadowgraph::shadows::SplitScheme::Metres(vec![12.0, 20.0, 30.0]);
        });
        let greys = greys(gpu, &scene, 0, &options);
        // Between the pillars the floor is farther away the higher its row; 12 m away at row 111.
        let floor = |rows: std::ops::Range<usize>| -> Vec<_> {
            rows.flat_map(|row| greys[row * 320 + 140..row * 320 + 180].to_vec()).collect()
        };
        [floor(80..105), floor(115..180)].map(|part| count(&part, |grey| grey < 200))
    };
    for method in [NO_BIAS.method, BiasMethod::Gradient] {
        let (even, first) = (dark(method, vec![]), dark(method, vec![0.0]));
        assert!(first[1] > even[1] + even[1] / 4, "{method:?}, near: {even:?} {first:?}");
        assert!(first[0] <= even[0] + even[0] / 50, "{method:?}, far: {even:?} {first:?}");
    }
}

#[test]
fn row_31_a_bias_that_follows_the_maps_gradient_removes_acne() {
    let without = BiasSettings { method: BiasMethod::Gradient, depth_texels: 0.5, ..NO_BIAS };
    let Some(none) = acne(without.clone(), |_| ()) else { return };
    let with = acne(BiasSettings { slope: 3.5, ..without }, |_| ()).unwrap();
    let usual = acne(BiasSettings::default(), |_| ()).unwrap();
    assert!(with * 2 < none && with < usual + usual / 4, "{none} {with} {usual}");
}

fn raster(slope: f32) -> BiasSettings {
    BiasSettings { method: BiasMethod::Raster, slope, depth_texels: 1.0, ..NO_BIAS }
}

#[test]
fn row_51_casters_drawn_with_a_slope_scaled_bias_give_no_acne() {
    let Some(none) = acne(raster(0.0), |_| ()) else { return };
    let usual = acne(BiasSettings::default(), |_| ()).unwrap();
    let [without_cache, with] = [false, true].map(|cache| {
        acne(raster(3.0), |settings| (settings.cascades.cache, settings.atlas.cache) = (cache, cache))
            .unwrap()
    });
    assert!(with * 2 < none && with < usual + usual / 4, "{none} {with} {usual}");
    assert_eq!(with, without_cache);
}

#[test]
fn row_51_tiles_and_pages_are_drawn_again_with_another_bias_and_lights_may_have_their_own() {
    let Some(gpu) = gpu() else { return };
    for technique in [PCF, VIRTUAL] {
        let mut options = cube_view(|settings| settings.cascades.map_size_px = 1024);
        let aov = Aov::Visibility(0);
        let mut renderer = Renderer::with_config(gpu, low_sun(), &options.camera, aov, technique).unwrap();
        let mut images = Vec::new();
        for slope in [0.0, 3.0, 0.0] {
            options.shadows.bias = raster(slope);
            images.push(renderer.draw(gpu, &options).unwrap().image.rgba8);
        }
        assert!(images[0] == images[2]);
        let dark = |image: &[u8]| image.chunks_exact(4).filter(|rgba| rgba[0] < 200).count();
        let [none, with] = [0, 1].map(|index: usize| dark(&images[index]));
        assert!(with + with / 20 < none, "{}: {none} {with}", technique.name);
        let own = LightShadows { slope: Some(3.0), ..LightShadows::new(LightRef::Index(0)) };
        options.shadows.lights = vec![own];
        assert!(renderer.draw(gpu, &options).unwrap().image.rgba8 == images[1]);
    }
}

#[test]
fn row_20_a_near_offset_extends_the_depth_range_towards_the_light() {
    let Some(gpu) = gpu() else { return };
    let mut scene = low_sun();
    let direction = sun_direction(60.0, 130.0);
    scene.set_lights([sun(direction)]);
    crate::stage::add_cube(&mut scene, -direction * 30.0);
    let near = |near_offset_m| {
        let options = cube_view(|settings| settings.cascades.near_offset_m = near_offset_m);
        let depth = plan(&scene, &options).views[0].depth_range_m;
        (depth, wrong(gpu, &scene, 0, &options))
    };
    let ((usual, pancaked), (deep, unclamped)) = (near(0.0), near(100.0));
    assert!(deep >= usual + 100.0, "{usual} {deep}");
    // Flattened to the near plane or not, a caster casts the same shadow.
    assert!(pancaked < 200 && unclamped < 200, "{pancaked} {unclamped}");
}
