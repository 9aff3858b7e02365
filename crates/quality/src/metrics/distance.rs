//! Distance of each pixel to the nearest marked pixel.

/// Returns the squared distance from each pixel's centre to that of the nearest marked pixel, px², exactly;
/// infinite if none is marked. Two passes, each linear in the number of pixels: straight up and down, then
/// the lower envelope of a row's parabolas (Felzenszwalb and Huttenlocher 2012).
pub(super) fn squared_distances(marked: &[bool], width: usize) -> Vec<f32> {
    let width = width.max(1);
    let vertical = vertical_distances(marked, width);
    let mut squared = vec![f32::INFINITY; marked.len()];
    let mut envelope = Vec::with_capacity(width);
    for (row, out) in vertical.chunks_exact(width).zip(squared.chunks_exact_mut(width)) {
        row_distances(row, out, &mut envelope);
    }
    squared
}

/// There is no marked pixel in the column.
const NONE: u32 = u32::MAX;

fn vertical_distances(marked: &[bool], width: usize) -> Vec<u32> {
    let mut distances: Vec<u32> = marked.iter().map(|&marked| if marked { 0 } else { NONE }).collect();
    for at in width..distances.len() {
        distances[at] = distances[at].min(distances[at - width].saturating_add(1));
    }
    for at in (width..distances.len()).rev() {
        distances[at - width] = distances[at - width].min(distances[at].saturating_add(1));
    }
    distances
}

/// The parabola of a column: squared distances to its nearest marked pixel. It is the lowest one from `from` on.
struct Parabola {
    x: f64,
    base: f64,
    from: f64,
}

fn row_distances(vertical: &[u32], out: &mut [f32], envelope: &mut Vec<Parabola>) {
    envelope.clear();
    for (x, &distance) in vertical.iter().enumerate().filter(|(_, distance)| **distance != NONE) {
        let (x, base) = (x as f64, f64::from(distance) * f64::from(distance));
        let mut from = f64::NEG_INFINITY;
        while let Some(last) = envelope.last() {
            from = (base - last.base + x * x - last.x * last.x) / (2.0 * (x - last.x));
            if from > last.from {
                break;
            }
            envelope.pop();
            from = f64::NEG_INFINITY;
        }
        envelope.push(Parabola { x, base, from });
    }
    let mut lowest = envelope.iter().peekable();
    let Some(mut parabola) = lowest.next() else { return };
    for (x, out) in out.iter_mut().enumerate() {
        let x = x as f64;
        while let Some(next) = lowest.next_if(|next| next.from < x) {
            parabola = next;
        }
        *out = ((x - parabola.x) * (x - parabola.x) + parabola.base) as f32;
    }
}
