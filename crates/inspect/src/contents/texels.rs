//! Differences of values.

use serde::Serialize;
use shadowgraph_core::{Extent, ResourceDesc, Subresource, TexelLayout, TextureDesc};

/// The place where values differ most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestDifference {
    /// Of textures x, y and layer; of buffers the byte.
    pub at: Vec<u64>,
    /// The value of each channel in the first frame.
    pub before: Vec<f64>,
    /// In the second frame.
    pub after: Vec<f64>,
}

/// What differs between the bytes of two parts, of the same size.
pub(super) struct ValueDifference {
    /// Number of texels, or of words of a buffer.
    pub(super) count: u64,
    /// Of how many.
    pub(super) of: u64,
    pub(super) largest: Option<LargestDifference>,
}

/// Compares parts of a resource. Numbers that differ by at most `tolerance` times the larger one, or times 1 if both are smaller, are equal.
pub(super) fn compare(
    desc: &ResourceDesc,
    part: &Subresource,
    [before, after]: [&[u8]; 2],
    tolerance: f64,
) -> ValueDifference {
    match desc {
        ResourceDesc::Texture(desc) => compare_texels(desc, part, [before, after], tolerance),
        ResourceDesc::Buffer(_) => compare_buffers(part, [before, after], tolerance),
    }
}

fn compare_texels(
    desc: &TextureDesc,
    part: &Subresource,
    [before, after]: [&[u8]; 2],
    tolerance: f64,
) -> ValueDifference {
    let Some(layout) = TexelLayout::for_format(desc.format, part.selected_aspect()) else {
        return ValueDifference { count: 1, of: 1, largest: None };
    };
    let [x, y, width, height] = rect(desc, part);
    let pairs = before.chunks_exact(layout.bytes()).zip(after.chunks_exact(layout.bytes()));
    let mut found = ValueDifference { count: 0, of: pairs.len() as u64, largest: None };
    let mut largest = 0.0;
    for ((was, is), index) in pairs.zip(0u64..) {
        if was == is {
            continue;
        }
        let (was, is) = (layout.values(was).unwrap_or_default(), layout.values(is).unwrap_or_default());
        let excess = was.iter().zip(&is).map(|(&a, &b)| excess(a, b, tolerance)).fold(0.0, f64::max);
        if excess <= 0.0 {
            continue;
        }
        found.count += 1;
        if excess > largest {
            largest = excess;
            let [column, row] = [index % u64::from(width), index / u64::from(width)];
            let [row, layer] = [row % u64::from(height), row / u64::from(height)];
            let layer = layer + u64::from(part.first_layer());
            let at = vec![u64::from(x) + column, u64::from(y) + row, layer];
            found.largest = Some(LargestDifference { at, before: was, after: is });
        }
    }
    found
}

/// Returns the first texel and the size of a part, which has one mip level.
fn rect(desc: &TextureDesc, part: &Subresource) -> [u32; 4] {
    if let Some(rect) = part.bounds() {
        return [rect.x, rect.y, rect.width, rect.height];
    }
    let Extent { width, height, .. } = desc.size.mip_level_size(part.first_mip(), desc.dimension);
    [0, 0, width, height]
}

/// Compares words as floats where both are, else as integers.
fn compare_buffers(part: &Subresource, [before, after]: [&[u8]; 2], tolerance: f64) -> ValueDifference {
    let words = |bytes: &[u8]| -> Vec<u32> {
        bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect()
    };
    let (before, after) = (words(before), words(after));
    let mut found = ValueDifference { count: 0, of: before.len() as u64, largest: None };
    let mut largest = 0.0;
    for ((&was, &is), index) in before.iter().zip(&after).zip(0u64..) {
        if was == is {
            continue;
        }
        let [float_was, float_is] = [was, is].map(f32::from_bits);
        // Small integers are tiny floats.
        let are_floats = [float_was, float_is].iter().all(|float| *float == 0.0 || float.is_normal());
        let (was, is) = match are_floats {
            true => (f64::from(float_was), f64::from(float_is)),
            false => (f64::from(was), f64::from(is)),
        };
        let tolerance = if are_floats { tolerance } else { 0.0 };
        let excess = excess(was, is, tolerance);
        if excess <= 0.0 {
            continue;
        }
        found.count += 1;
        if excess > largest {
            largest = excess;
            let at = vec![part.first_byte() + 4 * index];
            found.largest = Some(LargestDifference { at, before: vec![was], after: vec![is] });
        }
    }
    found
}

/// Returns by how much two numbers differ beyond the tolerance; 0 if they do not.
fn excess(a: f64, b: f64, tolerance: f64) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let difference = (a - b).abs();
    if !difference.is_finite() {
        return f64::INFINITY;
    }
    if difference <= tolerance * a.abs().max(b.abs()).max(1.0) { 0.0 } else { difference }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_within_the_tolerance_are_equal() {
        assert_eq!(excess(0.5, 0.5, 0.0), 0.0);
        assert_eq!(excess(f64::NAN, f64::NAN, 0.0), 0.0);
        assert_eq!(excess(1.0, f64::NAN, 0.1), f64::INFINITY);
        assert_eq!(excess(f64::INFINITY, f64::INFINITY, 0.0), 0.0);
        assert_eq!(excess(1.0, 1.05, 0.1), 0.0);
        assert!(excess(1.0, 1.05, 0.01) > 0.0);
        assert_eq!(excess(1000.0, 1001.0, 0.01), 0.0);
    }
}
