//! Strips and fans as triangle lists.

use ::gltf::json::mesh::Mode;

/// Turns the indices of a primitive into a triangle list; triangles that use a vertex twice are left out.
///
/// `None` for points and lines. What is left over at the end of a list is dropped.
pub(super) fn triangles(mode: Mode, indices: &[u32]) -> Option<Vec<u32>> {
    let mut list = Vec::with_capacity(triangle_count(mode, indices.len())?.saturating_mul(3));
    let mut add = |triangle: [u32; 3]| {
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            list.extend(triangle);
        }
    };
    match (mode, indices) {
        (Mode::Triangles, _) => indices.as_chunks().0.iter().for_each(|triangle| add(*triangle)),
        (Mode::TriangleStrip, _) => {
            for (i, corners) in indices.array_windows::<3>().enumerate() {
                let [a, b, c] = *corners;
                // Every second triangle of a strip is wound the other way round.
                add(if i % 2 == 0 { [a, b, c] } else { [a, c, b] });
            }
        }
        (Mode::TriangleFan, [hub, rim @ ..]) => {
            rim.array_windows().for_each(|[a, b]| add([*a, *b, *hub]));
        }
        _ => {}
    }
    Some(list)
}

/// Returns how many triangles a number of indices makes; `None` for points and lines.
pub(super) fn triangle_count(mode: Mode, indices: usize) -> Option<usize> {
    match mode {
        Mode::Triangles => Some(indices / 3),
        Mode::TriangleStrip | Mode::TriangleFan => Some(indices.saturating_sub(2)),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 3]), Some(vec![0, 1, 2, 1, 3, 2]));
        assert_eq!(triangles(Mode::TriangleFan, &[0, 1, 2, 3]), Some(vec![1, 2, 0, 2, 3, 0]));
    }

    #[test]
    fn leftovers_and_collapsed_triangles_are_dropped() {
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3, 3, 4, 5]), Some(vec![0, 1, 2]));
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 1, 2]), Some(vec![]));
        assert_eq!(triangles(Mode::TriangleFan, &[]), Some(vec![]));
        assert_eq!(triangles(Mode::Points, &[0, 1, 2]), None);
    }
}
