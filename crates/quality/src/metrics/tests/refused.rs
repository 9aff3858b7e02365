//! Invalid images.

use super::test_image::{TestImage, grazing};
use crate::metrics::*;

fn image() -> TestImage {
    TestImage::new([16, 9], &grazing(), 1e3, false)
}

#[test]
fn an_image_of_another_size_is_an_error_that_names_it() {
    let mut short = image();
    short.texel_px.pop();
    let error = Samples::new(short.images()).unwrap_err();
    assert_eq!(error, MetricsError::Length { list: "texel_px", has: 143, needs: 144 });
    assert_eq!(error.to_string(), "`texel_px` has 143 entries; expected 144");
}

#[test]
fn invalid_numbers_are_errors() {
    let invalid = |change: &dyn Fn(&mut TestImage)| {
        let mut image = image();
        change(&mut image);
        match Samples::new(image.images()) {
            Err(MetricsError::Value { list, index, .. }) => (list, index),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(invalid(&|p| p.visibility[5] = f32::NAN), ("visibility", 5));
    assert_eq!(invalid(&|p| p.visibility[5] = 1.5), ("visibility", 5));
    assert_eq!(invalid(&|p| p.truth[6] = -1.0), ("truth", 6));
    assert_eq!(invalid(&|p| p.depths_m[7] = f32::NAN), ("view_depths_m", 7));
    assert_eq!(invalid(&|p| p.n_dot_l[8] = f32::NAN), ("n_dot_l", 8));
    assert_eq!(invalid(&|p| p.positions[9].x = f32::INFINITY), ("positions", 9));
    assert_eq!(invalid(&|p| p.blockers_m[9] = f32::NAN), ("blocker_distances_m", 9));
    assert_eq!(invalid(&|p| p.soft_truth = Some(vec![2.0; 144])), ("soft_truth", 0));
}

#[test]
fn pixels_that_are_not_receivers_may_contain_anything() {
    let mut image = image();
    image.depths_m[3] = f32::INFINITY;
    image.positions[3].x = f32::NAN;
    image.visibility[3] = f32::NAN;
    image.n_dot_l[4] = 0.0;
    image.visibility[4] = f32::NAN;
    assert!(Samples::new(image.images()).is_ok());
}
