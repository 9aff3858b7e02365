//! The instrument that measures shadows, on what a GPU draws: small errors where there are few, and each planted fault
//! seen by the measure that is for it.

use crate::stage::{SIZE_PX, gpu};
use shadowgraph::measure::{Instrument, ViewErrors, built_in_cases};
use shadowgraph::options::Aov;
use shadowgraph::scene::trials::trial;
use shadowgraph::shadows::{BiasSettings, ShadowSettings};
use shadowgraph::{Renderer, ViewOptions};

/// Measures a trial under the sun of 30 degrees, from near.
fn measured(name: &str, shadows: ShadowSettings) -> Option<ViewErrors> {
    let gpu = gpu()?;
    let cases = built_in_cases().unwrap().cases;
    let case = cases.iter().find(|case| case.name() == name).unwrap();
    let mut scene = trial(name).unwrap();
    scene.add_light(case.sun(30.0));
    let options = ViewOptions { camera: case.views[0].camera(), size_px: SIZE_PX, shadows };
    let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Visibility(0)).unwrap();
    let mut instrument = Instrument::new(gpu, &renderer, 0).unwrap();
    let compared = instrument.measure(&mut renderer, &options).unwrap();
    assert_eq!(compared.pictures.errors_rgba8().len(), (SIZE_PX[0] * SIZE_PX[1] * 4) as usize);
    Some(compared.errors)
}

fn with_bias(bias: BiasSettings) -> ShadowSettings {
    ShadowSettings { bias, ..ShadowSettings::default() }
}

#[test]
fn the_shadow_of_a_cube_is_nearly_the_true_one() {
    let Some(errors) = measured("cube", ShadowSettings::default()) else { return };
    let (outside, total) = (errors.misclassified.outside, errors.misclassified.total);
    assert!(total.receivers > 30_000, "{total:?}");
    assert_eq!((outside.acne, outside.leak), (0, 0), "{outside:?}");
    assert!(total.wrong_percent < 0.1 && errors.mean_error.outside_percent < 0.05, "{errors:?}");
    assert!(errors.lost_contacts.contacts > 100 && errors.lost_contacts.lost_percent < 5.0, "{errors:?}");
    assert!(errors.detachment.cm.count > 20 && errors.detachment.cm.mean < 2.0, "{errors:?}");
}

#[test]
fn without_bias_acne_is_seen() {
    let bias =
        BiasSettings { normal_texels: 0.0, slope: 0.0, min_slope: 0.0, max_slope: 1.0, depth_texels: 0.0 };
    let Some(errors) = measured("cube", with_bias(bias)) else { return };
    let good = measured("cube", ShadowSettings::default()).unwrap();
    let (acne, none) = (errors.misclassified.outside.acne, good.misclassified.outside.acne);
    assert!(acne > 500 && none == 0, "{acne} and {none}");
    assert!(errors.mean_error.outside_percent > 5.0, "{:?}", errors.mean_error);
    assert!(errors.misclassified.outside.leak_percent < 0.05, "{:?}", errors.misclassified);
}

#[test]
fn a_large_bias_is_seen_as_detachment_and_lost_contacts() {
    let bias = BiasSettings { depth_texels: 16.0, normal_texels: 4.0, ..BiasSettings::default() };
    let coarse = |bias| {
        let mut settings = with_bias(bias);
        settings.cascades.map_size_px = 512;
        measured("cube", settings)
    };
    let Some(errors) = coarse(bias) else { return };
    let good = coarse(BiasSettings::default()).unwrap();
    assert!(errors.detachment.cm.mean > 4.0 * good.detachment.cm.mean.max(1.0), "{errors:?} {good:?}");
    assert!(
        errors.lost_contacts.lost_percent > 2.0 * good.lost_contacts.lost_percent.max(5.0),
        "{errors:?} {good:?}"
    );
}
