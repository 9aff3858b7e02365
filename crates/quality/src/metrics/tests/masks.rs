//! Made-up masks with numbers that can be worked out by hand.

use super::test_image::{TestImage, above, grazing};
use crate::metrics::*;

/// A bare floor, the left half of it dark, from above and at a grazing angle: the same masks on screen.
fn half_dark() -> [TestImage; 2] {
    [above(), grazing()]
        .map(|camera| TestImage::new([64, 48], &camera, 1e3, false).with_truth(|x, _| x >= 32))
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

#[test]
fn truth_itself_gives_zeros_for_every_metric() {
    for camera in [above(), grazing()] {
        let mut image = TestImage::new([160, 90], &camera, 1e3, true);
        image.soft_truth = Some(image.truth.clone());
        let all = image.all();
        let (outside, total) = (all.misclassified.outside, all.misclassified.total);
        assert!(outside.receivers > 1000 && total.receivers > outside.receivers, "{all:?}");
        assert_eq!((outside.misclassified, total.misclassified, total.acne, total.leak), (0, 0, 0, 0));
        assert_eq!(all.mean_error, MeanError::default());
        assert!(all.missing_contacts.contacts > 20 && all.missing_contacts.missing == 0, "{all:?}");
        assert!(all.peter_panning.cm.count > 10, "{all:?}");
        assert_eq!(
            (all.peter_panning.cm.p99, all.peter_panning.texels.p99, all.peter_panning.missing),
            (0.0, 0.0, 0)
        );
        let edges = all.edges.unwrap();
        assert_eq!((edges.rmse, edges.width_ratio, edges.unmeasured), (0.0, Some(1.0), 0));
    }
}

#[test]
fn truth_shifted_by_3_pixels_is_wrong_by_one_column_outside_the_band_of_2() {
    for mut image in half_dark() {
        image.visibility = image.by_pixel(|x, _| f32::from(u8::from(x >= 35)));
        let all = image.all();
        let (outside, total) = (all.misclassified.outside, all.misclassified.total);
        assert_eq!((total.receivers, total.acne, total.leak), (64 * 48, 3 * 48, 0));
        assert_eq!((outside.receivers, outside.acne, outside.leak), (60 * 48, 48, 0));
        assert!(
            close(outside.acne_percent, 100.0 / 60.0) && close(total.misclassified_percent, 300.0 / 64.0)
        );
        assert!(close(all.mean_error.outside_percent, 100.0 / 60.0));
        // The other way it is a leak.
        image.visibility = image.by_pixel(|x, _| f32::from(u8::from(x >= 29)));
        let Misclassified { outside, total } = image.all().misclassified;
        assert_eq!((total.leak, outside.leak, total.acne), (3 * 48, 48, 0));
    }
}

#[test]
fn a_shadow_texel_of_4_pixels_makes_a_band_of_6() {
    for mut image in half_dark() {
        image.texel_px.fill(4.0);
        image.visibility = image.by_pixel(|x, _| f32::from(u8::from(x >= 39)));
        let Misclassified { outside, total } = image.all().misclassified;
        assert_eq!((total.acne, outside.receivers, outside.acne), (7 * 48, 52 * 48, 48));
    }
}

#[test]
fn inverted_truth_is_wrong_everywhere() {
    for mut image in half_dark() {
        image.visibility = image.truth.iter().map(|truth| 1.0 - truth).collect();
        let all = image.all();
        let (outside, total) = (all.misclassified.outside, all.misclassified.total);
        assert_eq!(
            (total.misclassified_percent, total.acne_percent, total.leak_percent),
            (100.0, 50.0, 50.0)
        );
        assert_eq!((outside.acne, outside.leak), (30 * 48, 30 * 48));
        assert_eq!(all.mean_error, MeanError { outside_percent: 100.0, total_percent: 100.0 });
    }
}

/// A dark rectangle of 20 x 10 pixels, grown by some pixels on each side.
fn rectangle(x: usize, y: usize, grown: usize) -> bool {
    (20 - grown..40 + grown).contains(&x) && (15 - grown..25 + grown).contains(&y)
}

#[test]
fn a_shadow_dilated_by_5_pixels_is_acne_of_its_ring_less_the_band() {
    for camera in [above(), grazing()] {
        let mut image = TestImage::new([64, 48], &camera, 1e3, false).with_truth(|x, y| !rectangle(x, y, 0));
        image.visibility = image.by_pixel(|x, y| f32::from(u8::from(!rectangle(x, y, 5))));
        let Misclassified { outside, total } = image.all().misclassified;
        assert_eq!((total.acne, total.leak), (30 * 20 - 20 * 10, 0));
        // Of the ring, the band has two pixels along each side and three at each corner: (1, 1), (2, 1) and
        // (1, 2) from the corner, at most 1.5 from the edge's outer pixels (1, 0) and (0, 1).
        let in_band = 2 * (2 * 20 + 2 * 10) + 4 * 3;
        assert_eq!((outside.acne, outside.leak), (400 - in_band, 0));
        // Inside the rectangle, the band leaves 16 x 6 pixels.
        let receivers = 64 * 48 - 200 - in_band + 16 * 6;
        assert_eq!(outside.receivers, receivers);
    }
}

#[test]
fn exactly_one_half_is_right_on_both_sides() {
    let [mut image, _] = half_dark();
    image.visibility.fill(0.5);
    let all = image.all();
    assert_eq!(all.misclassified.total.misclassified, 0);
    assert_eq!(all.mean_error.total_percent, 50.0);
}

#[test]
fn acne_is_counted_by_how_the_surface_is_turned_to_the_light() {
    let [mut image, _] = half_dark();
    image.truth.fill(1.0);
    image.visibility.fill(0.0);
    // Eight columns each; the bins include their upper ends. The first eight are no receivers.
    let cosines = [0.05, 0.06, 0.1, 0.2, 0.25, 0.5, 0.51, 1.0];
    image.n_dot_l = image.by_pixel(|x, _| cosines[x / 8]);
    image.visibility[63] = 1.0;
    let total = image.all().misclassified.total;
    assert_eq!((total.receivers, total.acne), (56 * 48, 56 * 48 - 1));
    let bins = total.acne_by_n_dot_l;
    assert_eq!(bins.map(|bin| bin.n_dot_l_above), [0.05, 0.1, 0.25, 0.5]);
    assert_eq!(bins.map(|bin| bin.receivers), [16 * 48, 16 * 48, 8 * 48, 16 * 48]);
    assert_eq!(bins.map(|bin| bin.acne), [16 * 48, 16 * 48, 8 * 48, 16 * 48 - 1]);
    assert!(close(bins[3].acne_percent, 100.0 * 767.0 / 768.0) && bins[0].acne_percent == 100.0);
}

#[test]
fn a_image_of_nothing_gives_zeros_and_no_nan() {
    for size in [[0, 0], [0, 3], [3, 0], [8, 4]] {
        let camera = grazing();
        let mut image = TestImage::new(size, &camera, 0.0, false);
        image.soft_truth = Some(image.truth.clone());
        let all = image.all();
        assert!(!format!("{all:?}").contains("NaN"));
        assert_eq!((all.misclassified.total.receivers, all.missing_contacts.missing_percent), (0, 0.0));
        assert_eq!(all.edges.unwrap(), EdgeError::default());
        assert_eq!(all.peter_panning, PeterPanning::default());
    }
}
