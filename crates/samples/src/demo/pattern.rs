//! Pictures made by code: noise that tiles, and what pictures are written with.

use glam::{DVec3, FloatExt};

use shadowgraph_scene::Image;

/// Pixels along each side of a made picture.
pub(super) const SIZE: u32 = 256;

/// Draws a picture; `color` is asked at the middle of each pixel, (u, v) from the top left, 0 to 1, and answers
/// in the picture's own encoding, 0 to 1.
pub(super) fn picture(name: &str, color: impl Fn(f64, f64) -> [f64; 4]) -> Image {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIZE);
    let byte = |value: f64| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
    let pixels = (0..SIZE).flat_map(|row| (0..SIZE).map(move |column| (column, row)));
    let rgba8 = pixels.flat_map(|(column, row)| color(at(column), at(row)).map(byte)).collect();
    Image { name: name.to_owned(), width: SIZE, height: SIZE, rgba8 }
}

/// Draws the normals of a height field that tiles; `strength` is its depth over the picture's width.
pub(super) fn normals(name: &str, strength: f64, height: impl Fn(f64, f64) -> f64) -> Image {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIZE);
    let heights: Vec<f64> = (0..SIZE * SIZE).map(|i| height(at(i % SIZE), at(i / SIZE))).collect();
    let sample = |column: u32, row: u32| heights[((row % SIZE) * SIZE + column % SIZE) as usize];
    picture(name, |u, v| {
        let (column, row) = ((u * f64::from(SIZE)) as u32, (v * f64::from(SIZE)) as u32);
        let slope = strength * f64::from(SIZE) * 0.5;
        let along_u = sample(column + 1, row) - sample(column + SIZE - 1, row);
        let along_v = sample(column, row + 1) - sample(column, row + SIZE - 1);
        // Green points to the top of the picture, where v falls.
        let normal = DVec3::new(-along_u * slope, along_v * slope, 1.0).normalize();
        let encoded = normal * 0.5 + 0.5;
        [encoded.x, encoded.y, encoded.z, 1.0]
    })
}

/// A grey value of its own for each cell of a lattice, 0 to 1.
pub(super) fn cell(x: i64, y: i64, seed: u64) -> f64 {
    let mut bits = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F)
        ^ seed.wrapping_mul(0x1656_67B1_9E37_79F9);
    bits = (bits ^ (bits >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 32)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((bits >> 40) as f64) / f64::from(1_u32 << 24)
}

/// Smooth noise, 0 to 1, in layers, that repeats after (u, v) = 1.
pub(super) struct Clouds {
    layers: Vec<Lattice>,
}

/// One layer: a random value at each lattice point.
struct Lattice {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
    weight: f64,
}

impl Clouds {
    /// This many lattice cells along u and v in the first of `layers`; each next one is twice as fine and half
    /// as strong.
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

    /// The noise at a place.
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let (u, v) = (u - u.floor(), v - v.floor());
        self.layers.iter().map(|lattice| lattice.at(u, v)).sum()
    }
}

impl Lattice {
    /// The weighted value between the four lattice points around (u, v), both 0 to 1.
    fn at(&self, u: f64, v: f64) -> f64 {
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

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn ramp(low: f64, high: f64, value: f64) -> f64 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Mixes two colours.
pub(super) fn mix(from: DVec3, to: DVec3, t: f64) -> DVec3 {
    from.lerp(to, t)
}

/// An opaque colour.
pub(super) fn opaque(color: DVec3) -> [f64; 4] {
    [color.x, color.y, color.z, 1.0]
}
