//! One planted fault each: the metric that is for it sees it, and those that are not do not.

use super::test_image::{TestImage, above, grazing};
use crate::metrics::*;

fn images() -> [TestImage; 2] {
    [above(), grazing()].map(|camera| {
        let mut image = TestImage::new([320, 180], &camera, 1e3, true);
        image.soft_truth = Some(image.truth.clone());
        image
    })
}

/// About one in twenty, always the same.
fn salt(at: usize) -> bool {
    (at as u32).wrapping_mul(2_654_435_761).rotate_left(13).wrapping_mul(2_246_822_519) >> 16 < 3277
}

/// Every `n`th lit receiver outside the band gets this visibility. Returns how many that were.
fn plant(image: &mut TestImage, visibility: f32, lit: bool, chosen: impl Fn(usize) -> bool) -> usize {
    let samples = image.seen();
    let band = band(&samples);
    let places: Vec<usize> = (0..samples.len())
        .filter(|&at| samples.is_receiver(at) && !band.contains(at) && chosen(at))
        .filter(|&at| (image.truth[at] == 1.0) == lit)
        .collect();
    for &at in &places {
        image.visibility[at] = visibility;
    }
    places.len()
}

fn check_no_contact_or_edge_error(image: &TestImage) {
    let all = image.all();
    assert_eq!(
        (all.missing_contacts.missing, all.peter_panning.missing, all.peter_panning.cm.p99),
        (0, 0, 0.0)
    );
    let edges = all.edges.unwrap();
    assert_eq!((edges.rmse, edges.width_ratio), (0.0, Some(1.0)));
}

#[test]
fn dark_salt_is_acne_only() {
    for mut image in images() {
        let planted = plant(&mut image, 0.0, true, salt);
        let Misclassified { outside, total } = image.all().misclassified;
        assert!(planted > 1000, "{planted}");
        assert_eq!((outside.acne, total.acne, outside.leak, total.leak), (planted, planted, 0, 0));
        check_no_contact_or_edge_error(&image);
    }
}

#[test]
fn light_pepper_away_from_contacts_is_leak_only() {
    for mut image in images() {
        let far: Vec<bool> = image.blockers_m.iter().map(|distance| *distance > 0.3).collect();
        let planted = plant(&mut image, 1.0, false, |at| salt(at) && far[at]);
        let Misclassified { outside, total } = image.all().misclassified;
        assert!(planted > 50, "{planted}");
        assert_eq!((outside.leak, total.leak, outside.acne, total.acne), (planted, planted, 0, 0));
        check_no_contact_or_edge_error(&image);
    }
}

#[test]
fn faint_stripes_are_mean_error_and_no_pixel_is_misclassified() {
    for mut image in images() {
        let planted = plant(&mut image, 0.8, true, |at| at % 320 % 6 < 3);
        let all = image.all();
        assert_eq!((all.misclassified.total.misclassified, all.misclassified.outside.misclassified), (0, 0));
        let expected = 20.0 * planted as f64 / all.misclassified.outside.receivers as f64;
        assert!(expected > 5.0 && (all.mean_error.outside_percent - expected).abs() < 1e-4, "{all:?}");
        check_no_contact_or_edge_error(&image);
    }
}

#[test]
fn a_shadow_that_begins_late_is_lost_contacts_and_leak_but_no_acne() {
    for mut image in images() {
        let samples = image.seen();
        let late: Vec<usize> = samples.receivers().filter(|&at| image.blockers_m[at] < 0.15).collect();
        late.iter().for_each(|&at| image.visibility[at] = 1.0);
        let (all, late) = (image.all(), late.len());
        assert_eq!((all.missing_contacts.missing, all.misclassified.total.acne), (late, 0));
        assert_eq!(all.misclassified.total.leak, late);
        // 15 cm along a ray of 30 degrees are 13 cm along the floor.
        assert!((all.peter_panning.cm.mean - 13.0).abs() < 3.0, "{:?}", all.peter_panning);
    }
}

#[test]
fn only_contacts_with_a_blocker_nearer_than_25_cm_can_be_lost() {
    let mut image = TestImage::new([64, 48], &above(), 1e3, false).with_truth(|x, _| x >= 32);
    image.blockers_m = image.by_pixel(|x, _| if !(8..=40).contains(&x) { 0.24 } else { 0.25 });
    image.visibility = image.by_pixel(|x, _| f32::from(u8::from(!(2..20).contains(&x))));
    let missing = missing_contacts(&image.seen());
    assert_eq!(missing, MissingContacts { contacts: 8 * 48, missing: 2 * 48, missing_percent: 25.0 });
}
