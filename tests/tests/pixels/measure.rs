//! Measurements of shadows that a GPU renders: small errors with good settings, and each error caused on purpose
//! found by its metric.

use crate::stage::{SIZE_PX, gpu, move_instances};
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Scene};
use shadowgraph::shadows::{
    BiasSettings, EVSM, MSM, PCF, PCSS, RAYTRACED, ShadowSettings, SplitScheme, TechniqueKind,
};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_quality::metrics::Stability;
use shadowgraph_quality::report::{Motion, Moving};
use shadowgraph_quality::{
    Comparator, MeasuredScene, MotionMeasured, MotionTask, Points, Probe, Query, ViewErrors, built_in_cases,
    measure_flicker, measure_motion, measure_seam, metrics,
};
use shadowgraph_samples::test_scenes::test_scene;

/// Returns a test scene under the sun at 30 degrees, and its camera nearby.
fn sunlit(name: &str) -> (Scene, Camera) {
    let cases = built_in_cases().unwrap().cases;
    let case = cases.iter().find(|case| case.name() == name).unwrap();
    let mut scene = test_scene(name).unwrap();
    scene.insert_light(case.sun(30.0));
    (scene, case.views[0].camera())
}

/// Measures a test scene under the sun at 30 degrees, from nearby.
fn measured(name: &str, shadows: ShadowSettings) -> Option<ViewErrors> {
    let gpu = gpu()?;
    let (scene, camera) = sunlit(name);
    let options = ViewOptions { camera, size_px: SIZE_PX, shadows };
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(0)).unwrap();
    let mut comparator = Comparator::new(gpu, &renderer, 0).unwrap();
    let compared = comparator.measure(&mut renderer, &options).unwrap();
    assert_eq!(compared.images.errors_rgba8().len(), (SIZE_PX[0] * SIZE_PX[1] * 4) as usize);
    Some(compared.errors)
}

fn with_bias(bias: BiasSettings) -> ShadowSettings {
    ShadowSettings { bias, ..ShadowSettings::default() }
}

#[test]
fn the_shadow_of_a_cube_is_close_to_ground_truth() {
    let Some(errors) = measured("cube", ShadowSettings::default()) else { return };
    let (outside, total) = (errors.misclassified.outside, errors.misclassified.total);
    assert!(total.receivers > 30_000, "{total:?}");
    assert_eq!((outside.acne, outside.leak), (0, 0), "{outside:?}");
    assert!(total.misclassified_percent < 0.1 && errors.mean_error.outside_percent < 0.05, "{errors:?}");
    assert!(
        errors.missing_contacts.contacts > 100 && errors.missing_contacts.missing_percent < 5.0,
        "{errors:?}"
    );
    assert!(errors.peter_panning.cm.count > 20 && errors.peter_panning.cm.mean < 2.0, "{errors:?}");
}

#[test]
fn penumbrae_of_pcss_and_of_several_rays_are_closer_to_ground_truth_than_those_of_pcf() {
    let Some(gpu) = gpu() else { return };
    let (scene, camera) = sunlit("columns");
    let options = ViewOptions { camera, size_px: [640, 360], shadows: ShadowSettings::default() };
    let mut renderers = [PCF, PCSS, RAYTRACED].map(|technique| {
        Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Visibility(0), technique).unwrap()
    });
    let mut comparator = Comparator::new(gpu, &renderers[0], 0).unwrap();
    let reference = comparator.reference(&mut renderers[0], &options, 16).unwrap();
    let [pcf, pcss, raytraced] = renderers.map(|mut renderer| {
        comparator.compare(&mut renderer, &options, &reference).unwrap().edges.unwrap().rmse
    });
    assert!(pcss < 0.8 * pcf && raytraced < 0.8 * pcf, "{pcf} {pcss} {raytraced}");
}

#[test]
fn acne_is_measured_without_bias() {
    let bias = BiasSettings {
        normal_texels: 0.0,
        slope: 0.0,
        min_slope: 0.0,
        max_slope: 1.0,
        depth_texels: 0.0,
        ..BiasSettings::default()
    };
    let Some(errors) = measured("cube", with_bias(bias)) else { return };
    let good = measured("cube", ShadowSettings::default()).unwrap();
    let (acne, none) = (errors.misclassified.outside.acne, good.misclassified.outside.acne);
    assert!(acne > 500 && none == 0, "{acne} and {none}");
    assert!(errors.mean_error.outside_percent > 5.0, "{:?}", errors.mean_error);
    assert!(errors.misclassified.outside.leak_percent < 0.05, "{:?}", errors.misclassified);
}

#[test]
fn a_large_bias_is_measured_as_peter_panning_and_missing_contacts() {
    let bias = BiasSettings { depth_texels: 16.0, normal_texels: 4.0, ..BiasSettings::default() };
    let coarse = |bias| {
        let mut settings = with_bias(bias);
        settings.cascades.map_size_px = 256;
        measured("cube", settings)
    };
    let Some(errors) = coarse(bias) else { return };
    let good = coarse(BiasSettings::default()).unwrap();
    assert!(errors.peter_panning.cm.mean > 4.0 * good.peter_panning.cm.mean.max(1.0), "{errors:?} {good:?}");
    assert!(
        errors.missing_contacts.missing_percent > 2.0 * good.missing_contacts.missing_percent.max(5.0),
        "{errors:?} {good:?}"
    );
}

/// Evaluates the technique at the visible surfaces of the slats with the scene and the camera moved together: the same image
/// over texels at other positions.
fn visibility_with_scene_at(gpu: &shadowgraph::Gpu, offset: DVec3) -> (Vec<f32>, Vec<f32>) {
    let (mut scene, mut camera) = sunlit("slats");
    move_instances(&mut scene, offset);
    camera.world_from_view.translation += offset;
    let options = ViewOptions { camera, size_px: SIZE_PX, shadows: ShadowSettings::default() };
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(0)).unwrap();
    let mut comparator = Comparator::new(gpu, &renderer, 0).unwrap();
    let reference = comparator.reference(&mut renderer, &options, 0).unwrap();
    let (probe, points) = (Probe::new(gpu, &renderer).unwrap(), Points::new(gpu, &reference.surfaces));
    let query = Query { light: 0, coarser: false };
    let results = probe.evaluate(gpu, &renderer, &options, &points, query).unwrap();
    (results.visibility, reference.truth.hard)
}

#[test]
fn texels_that_slide_over_a_scene_are_measured_as_flicker_and_fixed_ones_are_not() {
    let Some(gpu) = gpu() else { return };
    // Texels are fixed in the world. Moving the scene over them has the effect of cascades that follow the camera without
    // snapping to whole texels.
    let frames =
        (0..4).map(|frame| visibility_with_scene_at(gpu, DVec3::new(0.0017, 0.0, 0.0009) * f64::from(frame)));
    let (sliding, truths): (Vec<_>, Vec<_>) = frames.unzip();
    let sliding = metrics::flicker(&sliding, &truths).unwrap();
    assert!(sliding.p99 > 10.0 / 255.0, "{sliding:?}");

    let (scene, camera) = sunlit("slats");
    let options = ViewOptions { camera, size_px: SIZE_PX, shadows: ShadowSettings::default() };
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(0)).unwrap();
    let found = measure_flicker(gpu, &mut renderer, PCF.into(), &options, 0, 4).unwrap();
    assert_eq!(found.len(), 6);
    for flicker in found.iter().filter(|flicker| flicker.motion != Motion::Zoom) {
        assert!(flicker.change.count > 50_000 && flicker.change.p99 <= 1.0 / 255.0, "{flicker:?}");
    }
}

#[test]
fn cascades_of_different_resolution_are_measured_at_their_seam() {
    let Some(gpu) = gpu() else { return };
    let (scene, camera) = sunlit("slats");
    let seam = |shadows: ShadowSettings| {
        let options = ViewOptions { camera: camera.clone(), size_px: SIZE_PX, shadows };
        let mut renderer = Renderer::new(gpu, scene.clone(), &options.camera, Aov::Visibility(0)).unwrap();
        let reference =
            Comparator::new(gpu, &renderer, 0).unwrap().reference(&mut renderer, &options, 0).unwrap();
        let probe = Probe::new(gpu, &renderer).unwrap();
        let (seam, cost) = measure_seam(gpu, &renderer, &probe, &options, &reference, 0).unwrap();
        assert!(
            cost.draws > 0
                && cost.triangles.is_some_and(|count| count > 500)
                && cost.texture_bytes >= 4096 * 2048 * 4,
            "{cost:?}"
        );
        seam.unwrap()
    };
    let fine = seam(ShadowSettings::default());
    // Two metres in fine texels, then 150 metres in coarse ones.
    let mut two = ShadowSettings::default();
    two.cascades.count = 2;
    two.cascades.split = SplitScheme::Ratios(vec![0.016]);
    let coarse = seam(two);
    assert!(fine.count > 100 && coarse.count > 100, "{fine:?} {coarse:?}");
    assert!(coarse.mean > 2.0 * fine.mean && coarse.p99 > 0.5, "{fine:?} {coarse:?}");
}

/// Measures the slats from afar, moved by an offset, while something moves.
fn stability(
    gpu: &Gpu,
    technique: TechniqueKind,
    moving: Moving,
    offset: DVec3,
    settings: ShadowSettings,
) -> Stability {
    let cases = built_in_cases().unwrap().cases;
    let case = cases.iter().find(|case| case.name() == "slats").unwrap();
    let mut scene = test_scene("slats").unwrap();
    scene.insert_light(case.sun(52.0));
    move_instances(&mut scene, offset);
    let mut camera = case.views[1].camera();
    camera.world_from_view.translation += offset;
    let scene = MeasuredScene::new("slats", scene, vec![("far".to_owned(), camera)]).unwrap();
    let task = MotionTask {
        techniques: vec![technique.into()],
        size_px: [240, 135],
        settings,
        distance: None,
        moving: vec![moving],
        frames: 6,
        soft_rays: 128,
    };
    let mut found = Vec::new();
    let keep = &mut |measured: MotionMeasured| {
        found.push(measured.report.stability);
        Ok::<_, shadowgraph_quality::Error>(())
    };
    measure_motion(gpu, &scene, &task, keep).unwrap();
    println!("{}, {moving:?}, {offset}: {found:?}", technique.name);
    assert_eq!(found.len(), 1);
    found.remove(0)
}

#[test]
fn a_turn_of_the_sun_changes_at_most_thrice_the_pixels_that_the_truth_changes_far_from_the_origin_too() {
    let Some(gpu) = gpu() else { return };
    // The axes turn around the world's origin: 10 km away from it, texels are somewhere else in each frame.
    for (offset, most) in [(DVec3::ZERO, 1.5), (DVec3::new(8_000.0, 0.0, 6_000.0), 3.0)] {
        let found = stability(gpu, PCF, Moving::Sun, offset, ShadowSettings::default());
        let ratio = found.ratio().unwrap();
        assert!(found.truth_changed > 20.0 && ratio < most, "{ratio} {found:?}");
        assert!(found.excess.mean < 0.0005, "{found:?}");
    }
}

#[test]
fn moments_in_wide_pixels_are_steady_as_the_sun_turns() {
    let Some(gpu) = gpu() else { return };
    for technique in [EVSM, MSM] {
        let mut settings = ShadowSettings::default();
        settings.cascades.map_size_px = 2048;
        let found = stability(gpu, technique, Moving::Sun, DVec3::ZERO, settings);
        assert!(found.truth_changed > 20.0 && found.changed < 0.2 * found.truth_changed, "{found:?}");
    }
}

#[test]
fn moments_of_several_texels_stay_the_same_as_the_camera_moves() {
    let Some(gpu) = gpu() else { return };
    for technique in [EVSM, MSM] {
        let found = stability(gpu, technique, Moving::Camera, DVec3::ZERO, ShadowSettings::default());
        assert!(found.excess.count > 1_000 && found.changed < 1.0, "{found:?}");
    }
}
