//! One planted fault each: the metric that is for it sees it, and those that are not do not.

use super::picture::{Picture, above, grazing};
use crate::metrics::*;

fn pictures() -> [Picture; 2] {
    [above(), grazing()].map(|camera| {
        let mut picture = Picture::new([320, 180], &camera, 1e3, true);
        picture.soft_truth = Some(picture.truth.clone());
        picture
    })
}

/// About one in twenty, always the same.
fn salt(at: usize) -> bool {
    (at as u32).wrapping_mul(2_654_435_761).rotate_left(13).wrapping_mul(2_246_822_519) >> 16 < 3277
}

/// Every `n`th lit receiver outside the band gets this visibility. Returns how many that were.
fn plant(picture: &mut Picture, visibility: f32, lit: bool, chosen: impl Fn(usize) -> bool) -> usize {
    let samples = picture.seen();
    let band = band(&samples);
    let places: Vec<usize> = (0..samples.len())
        .filter(|&at| samples.is_receiver(at) && !band.contains(at) && chosen(at))
        .filter(|&at| (picture.truth[at] == 1.0) == lit)
        .collect();
    for &at in &places {
        picture.visibility[at] = visibility;
    }
    places.len()
}

fn no_contact_or_edge_fault(picture: &Picture) {
    let all = picture.all();
    assert_eq!((all.missing_contacts.missing, all.peter_panning.lost, all.peter_panning.cm.p99), (0, 0, 0.0));
    let edges = all.edges.unwrap();
    assert_eq!((edges.rmse, edges.width_ratio), (0.0, Some(1.0)));
}

#[test]
fn dark_salt_is_acne_only() {
    for mut picture in pictures() {
        let planted = plant(&mut picture, 0.0, true, salt);
        let Misclassified { outside, total } = picture.all().misclassified;
        assert!(planted > 1000, "{planted}");
        assert_eq!((outside.acne, total.acne, outside.leak, total.leak), (planted, planted, 0, 0));
        no_contact_or_edge_fault(&picture);
    }
}

#[test]
fn light_pepper_away_from_contacts_is_leak_only() {
    for mut picture in pictures() {
        let far: Vec<bool> = picture.blockers_m.iter().map(|distance| *distance > 0.3).collect();
        let planted = plant(&mut picture, 1.0, false, |at| salt(at) && far[at]);
        let Misclassified { outside, total } = picture.all().misclassified;
        assert!(planted > 50, "{planted}");
        assert_eq!((outside.leak, total.leak, outside.acne, total.acne), (planted, planted, 0, 0));
        no_contact_or_edge_fault(&picture);
    }
}

#[test]
fn faint_stripes_are_mean_error_and_no_pixel_is_misclassified() {
    for mut picture in pictures() {
        let planted = plant(&mut picture, 0.8, true, |at| at % 320 % 6 < 3);
        let all = picture.all();
        assert_eq!((all.misclassified.total.wrong, all.misclassified.outside.wrong), (0, 0));
        let expected = 20.0 * planted as f64 / all.misclassified.outside.receivers as f64;
        assert!(expected > 5.0 && (all.mean_error.outside_percent - expected).abs() < 1e-4, "{all:?}");
        no_contact_or_edge_fault(&picture);
    }
}

#[test]
fn a_shadow_that_begins_late_is_lost_contacts_and_leak_but_no_acne() {
    for mut picture in pictures() {
        let samples = picture.seen();
        let late: Vec<usize> = samples.receivers().filter(|&at| picture.blockers_m[at] < 0.15).collect();
        late.iter().for_each(|&at| picture.visibility[at] = 1.0);
        let (all, late) = (picture.all(), late.len());
        assert_eq!((all.missing_contacts.missing, all.misclassified.total.acne), (late, 0));
        assert_eq!(all.misclassified.total.leak, late);
        // 15 cm along a ray of 30 degrees are 13 cm along the floor.
        assert!((all.peter_panning.cm.mean - 13.0).abs() < 3.0, "{:?}", all.peter_panning);
    }
}

#[test]
fn only_contacts_with_a_blocker_nearer_than_25_cm_can_be_lost() {
    let mut picture = Picture::new([64, 48], &above(), 1e3, false).with_truth(|x, _| x >= 32);
    picture.blockers_m = picture.by_pixel(|x, _| if !(8..=40).contains(&x) { 0.24 } else { 0.25 });
    picture.visibility = picture.by_pixel(|x, _| f32::from(u8::from(!(2..20).contains(&x))));
    let missing = missing_contacts(&picture.seen());
    assert_eq!(missing, MissingContacts { contacts: 8 * 48, missing: 2 * 48, missing_percent: 25.0 });
}
