//! Fitting of two colours and places between them to the pixels of a block.

use super::Block;

/// How often the end colours are adjusted to the weights and the weights to the end colours.
const ROUNDS: usize = 4;

/// A colour as a point in space.
type Point = [f32; 4];

/// Two colours, and the number of a weight for each pixel.
#[derive(Clone, Copy)]
pub(super) struct Ramp {
    /// The colours of the lowest and of the highest weight.
    pub(super) ends: [[u8; 4]; 2],
    /// Which of the weights each pixel has.
    pub(super) weights: [usize; 16],
}

/// Finds a good ramp for a block. The weights say how far each step lies from the first end colour to the
/// second, in 64ths of the way.
pub(super) fn fit(block: &Block, weights: &[i32]) -> Ramp {
    let pixels = block.map(|pixel| pixel.map(f32::from));
    let (mut error, mut best) = choose_weights(block, extremes(&pixels), weights);
    let mut ramp = best;
    for _ in 0..ROUNDS {
        let Some(ends) = least_squares(&pixels, ramp.weights.map(|number| weights[number])) else {
            break;
        };
        let (new_error, new_ramp) = choose_weights(block, ends, weights);
        ramp = new_ramp;
        if new_error < error {
            (error, best) = (new_error, new_ramp);
        }
    }
    best
}

/// Chooses the best weight for each pixel. Returns the sum of the squared errors and the ramp.
fn choose_weights(block: &Block, ends: [[u8; 4]; 2], weights: &[i32]) -> (i32, Ramp) {
    let mut total_error = 0;
    let chosen = block.map(|pixel| {
        let errors = weights.iter().map(|&weight| {
            let differences = (0..4).map(|channel| blend(ends, channel, weight) - i32::from(pixel[channel]));
            differences.map(|difference| difference * difference).sum::<i32>()
        });
        let (error, number) = errors.zip(0..).min().unwrap_or_default();
        total_error += error;
        number
    });
    (total_error, Ramp { ends, weights: chosen })
}

/// Returns a channel of the colour at a weight, rounded in the way of the decoder.
fn blend(ends: [[u8; 4]; 2], channel: usize, weight: i32) -> i32 {
    let [first, second] = ends.map(|end| i32::from(end[channel]) * 257);
    ((first * (64 - weight) + second * weight + 32) >> 6) >> 8
}

/// Returns the ends of the pixels along the direction in which they differ most.
fn extremes(pixels: &[Point; 16]) -> [[u8; 4]; 2] {
    let mean: Point =
        std::array::from_fn(|channel| pixels.iter().map(|pixel| pixel[channel]).sum::<f32>() / 16.0);
    let offsets = pixels.map(|pixel| std::array::from_fn(|channel| pixel[channel] - mean[channel]));
    let direction = main_direction(&offsets);
    let distances = offsets.map(|offset| dot(offset, direction));
    let ends = [distances.into_iter().fold(0.0, f32::min), distances.into_iter().fold(0.0, f32::max)];
    ends.map(|distance| {
        to_bytes(std::array::from_fn(|channel| mean[channel] + direction[channel] * distance))
    })
}

/// Returns the direction of length 1 in which points spread most around the origin.
fn main_direction(offsets: &[Point; 16]) -> Point {
    // Every multiplication by the covariance turns a direction nearer to the main one. The farthest point
    // is never at a right angle to all others, since it is not to itself.
    let farthest = |a: &Point, b: &Point| dot(*a, *a).total_cmp(&dot(*b, *b));
    let mut direction = offsets.iter().copied().max_by(farthest).unwrap_or_default();
    for _ in 0..8 {
        let scales = offsets.map(|offset| dot(offset, direction));
        let turned: Point = std::array::from_fn(|channel| {
            offsets.iter().zip(scales).map(|(offset, scale)| offset[channel] * scale).sum()
        });
        let length = dot(turned, turned).sqrt();
        direction = turned.map(|value| value / length.max(f32::MIN_POSITIVE));
    }
    direction
}

/// Returns the end colours with the least squared error for the places of the pixels, in 64ths of the
/// way, or nothing if all are the same.
fn least_squares(pixels: &[Point; 16], places: [i32; 16]) -> Option<[[u8; 4]; 2]> {
    let shares = places.map(|place| (1.0 - place as f32 / 64.0, place as f32 / 64.0));
    let sum = |term: fn((f32, f32)) -> f32| shares.into_iter().map(term).sum::<f32>();
    let (first, second, both) = (sum(|s| s.0 * s.0), sum(|s| s.1 * s.1), sum(|s| s.0 * s.1));
    let determinant = first * second - both * both;
    if determinant < 1e-3 {
        return None;
    }
    let mut ends = [Point::default(); 2];
    for channel in 0..4 {
        let (mut to_first, mut to_second) = (0.0, 0.0);
        for (pixel, share) in pixels.iter().zip(shares) {
            to_first += pixel[channel] * share.0;
            to_second += pixel[channel] * share.1;
        }
        ends[0][channel] = (to_first * second - to_second * both) / determinant;
        ends[1][channel] = (to_second * first - to_first * both) / determinant;
    }
    Some(ends.map(to_bytes))
}

/// Returns the scalar product.
fn dot(a: Point, b: Point) -> f32 {
    a.into_iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the nearest colour of whole numbers.
fn to_bytes(point: Point) -> [u8; 4] {
    point.map(|value| value.round().clamp(0.0, 255.0) as u8)
}
