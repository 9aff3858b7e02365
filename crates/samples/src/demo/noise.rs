//! Procedural textures: tiling noise and helpers.

use glam::{DVec3, FloatExt};

use shadowgraph_scene::Image;

/// Width and height of a procedural texture, pixels.
pub(super) const SIZE: u32 = 256;

/// Creates a texture; `color` is evaluated at the centre of each pixel, (u, v) from the top left, 0 to 1, and returns
/// the encoded value, 0 to 1.
pub(crate) fn texture(name: &str, color: impl Fn(f64, f64) -> [f64; 4]) -> Image {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIZE);
    let byte = |value: f64| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
    let pixels = (0..SIZE).flat_map(|row| (0..SIZE).map(move |column| (column, row)));
    let rgba8 = pixels.flat_map(|(column, row)| color(at(column), at(row)).map(byte)).collect();
    Image::new(name, SIZE, SIZE, rgba8)
}

/// Creates the normal map of a tiling height field; `strength` is its depth relative to the width of the texture.
pub(super) fn normals(name: &str, strength: f64, height: impl Fn(f64, f64) -> f64) -> Image {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIZE);
    let heights: Vec<f64> = (0..SIZE * SIZE).map(|i| height(at(i % SIZE), at(i / SIZE))).collect();
    let sample = |column: u32, row: u32| heights[((row % SIZE) * SIZE + column % SIZE) as usize];
    texture(name, |u, v| {
        let (column, row) = ((u * f64::from(SIZE)) as u32, (v * f64::from(SIZE)) as u32);
        let slope = strength * f64::from(SIZE) * 0.5;
        let along_u = sample(column + 1, row) - sample(column + SIZE - 1, row);
        let along_v = sample(column, row + 1) - sample(column, row + SIZE - 1);
        // Green points to the top of the image, in the direction of decreasing v.
        let normal = DVec3::new(-along_u * slope, along_v * slope, 1.0).normalize();
        let encoded = normal * 0.5 + 0.5;
        [encoded.x, encoded.y, encoded.z, 1.0]
    })
}

/// Returns a hash of a lattice cell, 0 to 1.
pub(crate) fn cell(x: i64, y: i64, seed: u64) -> f64 {
    let mut bits = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F)
        ^ seed.wrapping_mul(0x1656_67B1_9E37_79F9);
    bits = (bits ^ (bits >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 32)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((bits >> 40) as f64) / f64::from(1_u32 << 24)
}

/// Smooth layered noise, 0 to 1, with a period of 1 in u and v.
pub(super) struct TilingNoise {
    layers: Vec<Lattice>,
}

/// One layer: a random value at each lattice point.
struct Lattice {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
    weight: f64,
}

impl TilingNoise {
    /// Creates noise with `cells` lattice cells along u and v in the first layer; each further layer is twice as fine
    /// and half as strong.
    pub(super) fn new(cells: [usize; 2], layers: u32, seed: u64) -> Self {
        let total = 2.0 - 0.5_f64.powi(layers as i32 - 1);
        let lattice = |layer: u32| {
            let (columns, rows) = (cells[0] << layer, cells[1] << layer);
            let at = |i: usize| cell((i % columns) as i64, (i / columns) as i64, seed + u64::from(layer));
            let weight = 0.5_f64.powi(layer as i32) / total;
            Lattice { columns, rows, values: (0..columns * rows).map(at).collect(), weight }
        };
        Self { layers: (0..layers).map(lattice).collect() }
    }

    /// Returns the noise at a point.
    pub(super) fn sample(&self, u: f64, v: f64) -> f64 {
        let (u, v) = (u - u.floor(), v - v.floor());
        self.layers.iter().map(|lattice| lattice.sample(u, v)).sum()
    }
}

impl Lattice {
    /// Returns the weighted value interpolated between the four lattice points around (u, v), both 0 to 1.
    fn sample(&self, u: f64, v: f64) -> f64 {
        let ease = |t: f64| t * t * (3.0 - 2.0 * t);
        let (x, y) = (u * self.columns as f64, v * self.rows as f64);
        let (left, top) = ((x as usize).min(self.columns - 1), (y as usize).min(self.rows - 1));
        let right = if left + 1 == self.columns { 0 } else { left + 1 };
        let bottom = if top + 1 == self.rows { 0 } else { top + 1 };
        let (s, t) = (ease(x - left as f64), ease(y - top as f64));
        let row = |row: usize| {
            let start = row * self.columns;
            self.values[start + left].lerp(self.values[start + right], s)
        };
        self.weight * row(top).lerp(row(bottom), t)
    }
}

/// Returns 0 below `low`, 1 above `high`, and a smooth transition in between.
pub(super) fn ramp(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Mixes two colours.
pub(super) fn mix(from: DVec3, to: DVec3, t: f64) -> DVec3 {
    from.lerp(to, t)
}

/// Returns an opaque colour.
pub(super) fn opaque(color: DVec3) -> [f64; 4] {
    [color.x, color.y, color.z, 1.0]
}
