use proptest::prelude::*;

use super::*;
use crate::cull::samples::{cone, nested, plane, sphere, tangency};

/// Checks what [`ConvexShape`] promises.
fn keeps_inclusions(shape: &impl ConvexShape, [outer, inner]: &[Aabb; 2]) -> Result<(), TestCaseError> {
    prop_assert!(!shape.intersects(inner) || shape.intersects(outer), "intersects only the inner box");
    prop_assert!(!shape.contains(outer) || shape.contains(inner), "contains only the outer box");
    prop_assert!(
        !shape.contains(inner) || shape.intersects(inner),
        "contains a box that it does not intersect"
    );
    prop_assert!(!shape.contains(outer) || shape.intersects(inner), "contains only the outer box");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000.max(ProptestConfig::default().cases)))]

    #[test]
    fn a_plane_decides_for_a_box_as_for_all_boxes_within(boxes in nested(), tangency in tangency()) {
        keeps_inclusions(&plane(&tangency, &boxes), &boxes)?;
    }

    #[test]
    fn a_sphere_decides_for_a_box_as_for_all_boxes_within(boxes in nested(), tangency in tangency()) {
        keeps_inclusions(&sphere(&tangency, &boxes), &boxes)?;
    }

    #[test]
    fn a_cone_decides_for_a_box_as_for_all_boxes_within(boxes in nested(), tangency in tangency()) {
        keeps_inclusions(&PreparedCone::new(&cone(&tangency, &boxes)), &boxes)?;
    }
}
