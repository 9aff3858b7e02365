use crate::Aabb;
use proptest::prelude::*;

use super::*;
use crate::cull::samples::{cone, graze, nested, plane, sphere};

/// Checks what [`Part`] promises.
fn keeps_inclusions(part: &impl Part, [outer, inner]: &[Aabb; 2]) -> Result<(), TestCaseError> {
    prop_assert!(!part.touches(inner) || part.touches(outer), "touches only the inner box");
    prop_assert!(!part.holds(outer) || part.holds(inner), "holds only the outer box");
    prop_assert!(!part.holds(inner) || part.touches(inner), "holds what it does not touch");
    prop_assert!(!part.holds(outer) || part.touches(inner), "does not touch what lies in what it holds");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn a_plane_decides_for_a_box_as_for_all_boxes_within(boxes in nested(), graze in graze()) {
        keeps_inclusions(&plane(&graze, &boxes), &boxes)?;
    }

    #[test]
    fn a_sphere_decides_for_a_box_as_for_all_boxes_within(boxes in nested(), graze in graze()) {
        keeps_inclusions(&sphere(&graze, &boxes), &boxes)?;
    }

    #[test]
    fn a_cone_decides_for_a_box_as_for_all_boxes_within(boxes in nested(), graze in graze()) {
        keeps_inclusions(&ConeFrame::new(&cone(&graze, &boxes)), &boxes)?;
    }
}
