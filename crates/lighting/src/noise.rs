//! Noise that is blue in space and converges in time.

/// The side of the noise, pixels: it repeats over the image. `SIDE` of `frame_noise.wgsl`.
const SIDE: usize = 32;

/// The number of frames after which the noise repeats, elsewhere in the image.
const FRAMES: usize = 16;

/// Frame by frame and row by row, 0 to 255. `cargo xtask noise` writes the file.
static BLUE_NOISE: &[u8; SIDE * SIDE * FRAMES] = include_bytes!("blue_noise.bin");

/// Returns the member `noise` of `View` of `shadowgraph::view`: a byte for each pixel, zeros without a frame.
pub(crate) fn noise_of(frame: Option<u32>) -> Vec<u8> {
    let Some(frame) = frame.map(|frame| frame as usize) else { return vec![0; SIDE * SIDE] };
    let slice = frame % FRAMES * SIDE * SIDE;
    // Moved by the fractions of the plastic number (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018), so that a
    // pixel gets other values each time.
    let moved = |fraction: f64| ((frame / FRAMES) as f64 * fraction).fract() * SIDE as f64;
    let (x, y) = (moved(0.754_877_666) as usize, moved(0.569_840_290) as usize);
    let row = |row: usize| {
        let start = slice + (row + y) % SIDE * SIDE;
        let (left, right) = BLUE_NOISE[start..start + SIDE].split_at(x);
        right.iter().chain(left).copied()
    };
    (0..SIDE).flat_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// The mean power of a frame's frequencies between two numbers of periods over the side, relative to that of white noise.
    fn power(noise: &[u8], from: f64, to: f64) -> f64 {
        let value = |x: usize, y: usize| (f64::from(noise[y * SIDE + x]) + 0.5) / 256.0 - 0.5;
        let of_white = (SIDE * SIDE) as f64 / 12.0;
        let (mut sum, mut count) = (0.0, 0.0);
        for v in 0..SIDE {
            for u in 0..=SIDE / 2 {
                let periods = (u as f64).hypot(v.min(SIDE - v) as f64);
                if (from..to).contains(&periods) {
                    let angle = |x, y| TAU * ((u * x + v * y) % SIDE) as f64 / SIDE as f64;
                    let wave = |part: fn(f64) -> f64| {
                        let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
                        pixels.map(|(x, y)| value(x, y) * part(angle(x, y))).sum::<f64>()
                    };
                    sum += (wave(f64::cos).powi(2) + wave(f64::sin).powi(2)) / of_white;
                    count += 1.0;
                }
            }
        }
        sum / count
    }

    #[test]
    fn every_frame_is_blue_and_has_each_value_equally_often() {
        for frame in [0, 7, 15, 40] {
            let noise = noise_of(Some(frame));
            let (low, high) = (power(&noise, 0.5, 6.0), power(&noise, 11.0, 16.0));
            assert!(low < 0.05 && high > 0.8, "frame {frame}: {low} at low frequencies, {high} at high ones");
            let mut counts = [0; 256];
            noise.iter().for_each(|value| counts[usize::from(*value)] += 1);
            assert_eq!(counts, [SIDE * SIDE / 256; 256]);
        }
    }

    #[test]
    fn the_mean_of_a_pixel_converges_faster_than_that_of_white_noise() {
        // Within the file, and across its end.
        for (first, frames, factor) in [(0, 16, 3.0), (0, 8, 2.0), (12, 16, 2.0)] {
            let noises: Vec<_> = (first..first + frames).map(|frame| noise_of(Some(frame))).collect();
            for threshold in [64, 128, 200u8] {
                let expected = f64::from(threshold) / 256.0;
                let error = |pixel: usize| {
                    let below = noises.iter().filter(|noise| noise[pixel] < threshold).count();
                    (below as f64 / f64::from(frames) - expected).powi(2)
                };
                let rmse = ((0..SIDE * SIDE).map(error).sum::<f64>() / (SIDE * SIDE) as f64).sqrt();
                let white = (expected * (1.0 - expected) / f64::from(frames)).sqrt();
                assert!(rmse < white / factor, "{frames} frames from {first}: {rmse}, white noise {white}");
            }
        }
    }

    #[test]
    fn the_size_is_that_of_the_wgsl_and_a_later_round_differs() {
        assert_eq!(noise_of(None), [0; SIDE * SIDE]);
        assert_eq!(noise_of(Some(3)).len(), SIDE * SIDE);
        assert_ne!(noise_of(Some(3)), noise_of(Some(19)));
        assert_eq!(noise_of(Some(u32::MAX)).len(), SIDE * SIDE);
    }
}
