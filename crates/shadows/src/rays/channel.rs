//! Channels of textures, and how they are read: the same arithmetic as in `rays.wgsl`.

use glam::Vec2;

use super::Error;

/// What a texture shows outside of its square, along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Wrap {
    /// The same again.
    #[default]
    Repeat = 0,
    /// The same again, every other time mirrored.
    Mirror = 1,
    /// The texels of the edge.
    Clamp = 2,
}

/// What a texture shows between the centres of its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Filter {
    /// The texel around the point.
    Nearest = 0,
    /// The four nearest texels, mixed.
    #[default]
    Bilinear = 1,
}

/// One channel of a texture, alpha or a linear colour, always read at full size (its largest mip).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelTexture {
    size_px: [u32; 2],
    texels: Vec<u8>,
    wrap: [Wrap; 2],
    filter: Filter,
}

impl ChannelTexture {
    /// A texture of `size_px` columns and rows, row by row, 0 to 255.
    ///
    /// # Errors
    ///
    /// [`Error::Texels`] if there is not exactly one byte a pixel, if there is no pixel, or if there are
    /// more than 2^31 - 1 in a row or column.
    pub fn new(size_px: [u32; 2], texels: Vec<u8>, wrap: [Wrap; 2], filter: Filter) -> Result<Self, Error> {
        let [width, height] = size_px;
        let needed = u64::from(width) * u64::from(height);
        let countable = i32::try_from(width.max(height)).is_ok();
        if needed == 0 || needed != texels.len() as u64 || !countable {
            return Err(Error::Texels { width, height, bytes: texels.len() });
        }
        Ok(Self { size_px, texels, wrap, filter })
    }

    /// Columns and rows.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// The texels, row by row.
    #[must_use]
    pub fn texels(&self) -> &[u8] {
        &self.texels
    }

    /// What is outside of the square, along u and along v.
    #[must_use]
    pub fn wrap(&self) -> [Wrap; 2] {
        self.wrap
    }

    /// What is between the texels' centres.
    #[must_use]
    pub fn filter(&self) -> Filter {
        self.filter
    }

    /// The value at a point, 0 to 1.
    #[must_use]
    pub fn value(&self, uv: Vec2) -> f32 {
        let x = folded(uv.x, self.wrap[0]) * self.size_px[0] as f32;
        let y = folded(uv.y, self.wrap[1]) * self.size_px[1] as f32;
        if self.filter == Filter::Nearest {
            return self.texel(x as i32, y as i32);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right_part, bottom_part) = (x - left, y - top);
        let row = |y: i32| {
            let (a, b) = (self.texel(left as i32, y), self.texel(left as i32 + 1, y));
            a + (b - a) * right_part
        };
        let (a, b) = (row(top as i32), row(top as i32 + 1));
        a + (b - a) * bottom_part
    }

    /// The value of a texel, 0 to 1; columns and rows from -1 to the size.
    fn texel(&self, x: i32, y: i32) -> f32 {
        let column = inside(x, self.size_px[0], self.wrap[0]);
        let row = inside(y, self.size_px[1], self.wrap[1]);
        let index = row as usize * self.size_px[0] as usize + column as usize;
        f32::from(self.texels.get(index).copied().unwrap_or(u8::MAX)) * (1.0 / 255.0)
    }
}

/// A texture coordinate moved into the square, 0 to 1.
fn folded(at: f32, wrap: Wrap) -> f32 {
    match wrap {
        Wrap::Repeat => at - at.floor(),
        Wrap::Mirror => {
            let period = at - 2.0 * (at * 0.5).floor();
            period.min(2.0 - period)
        }
        Wrap::Clamp => at.clamp(0.0, 1.0),
    }
}

/// The texel that stands for one up to one step outside. A mirror shows the edge's texel twice, as a clamp does.
fn inside(index: i32, size: u32, wrap: Wrap) -> i32 {
    let size = size as i32;
    match wrap {
        Wrap::Repeat if index < 0 => index + size,
        Wrap::Repeat if index >= size => index - size,
        Wrap::Repeat => index,
        Wrap::Mirror | Wrap::Clamp => index.clamp(0, size - 1),
    }
}
