//! Pictures that cannot be measured.

use super::picture::{Picture, grazing};
use crate::metrics::*;

fn picture() -> Picture {
    Picture::new([16, 9], &grazing(), 1e3, false)
}

#[test]
fn a_picture_of_another_size_is_refused_by_name() {
    let mut short = picture();
    short.texel_px.pop();
    let error = Samples::new(short.images()).unwrap_err();
    assert_eq!(error, MetricsError::Length { list: "texel_px", has: 143, needs: 144 });
    assert_eq!(error.to_string(), "`texel_px` has 143 entries; it needs 144");
}

#[test]
fn numbers_that_would_count_as_right_unseen_are_refused() {
    let refused = |change: &dyn Fn(&mut Picture)| {
        let mut picture = picture();
        change(&mut picture);
        match Samples::new(picture.images()) {
            Err(MetricsError::Value { list, index, .. }) => (list, index),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(refused(&|p| p.visibility[5] = f32::NAN), ("visibility", 5));
    assert_eq!(refused(&|p| p.visibility[5] = 1.5), ("visibility", 5));
    assert_eq!(refused(&|p| p.truth[6] = -1.0), ("truth", 6));
    assert_eq!(refused(&|p| p.depths_m[7] = f32::NAN), ("view_depths_m", 7));
    assert_eq!(refused(&|p| p.n_dot_l[8] = f32::NAN), ("n_dot_l", 8));
    assert_eq!(refused(&|p| p.positions[9].x = f32::INFINITY), ("positions", 9));
    assert_eq!(refused(&|p| p.blockers_m[9] = f32::NAN), ("blocker_distances_m", 9));
    assert_eq!(refused(&|p| p.soft_truth = Some(vec![2.0; 144])), ("soft_truth", 0));
}

#[test]
fn what_is_not_drawn_or_no_receiver_may_hold_anything() {
    let mut picture = picture();
    picture.depths_m[3] = f32::INFINITY;
    picture.positions[3].x = f32::NAN;
    picture.visibility[3] = f32::NAN;
    picture.n_dot_l[4] = 0.0;
    picture.visibility[4] = f32::NAN;
    assert!(Samples::new(picture.images()).is_ok());
}
