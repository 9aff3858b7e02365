//! Channels of textures, and their sampling: the same arithmetic as in `rays.wgsl`.

use glam::Vec2;

use super::{Error, gpu_structs::RayTexture};

/// The address mode of a texture along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum Wrap {
    /// Repeats the texture.
    #[default]
    Repeat = 0,
    /// Repeats the texture, mirrored every other time.
    Mirror = 1,
    /// Extends the texels of the edge.
    Clamp = 2,
}

/// The filter between the centres of texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u32)]
pub enum Filter {
    /// The texel that contains the point.
    Nearest = 0,
    /// The four nearest texels, interpolated.
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
    /// Creates a texture of `size_px` columns and rows. `texels` has them row by row, 0 to 255.
    ///
    /// # Errors
    ///
    /// [`Error::Texels`] if there is not exactly one byte per texel, if there is no texel, or if there are
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

    /// Returns the texels, row by row.
    pub(crate) fn texels(&self) -> &[u8] {
        &self.texels
    }

    /// Returns the description for the shader of the channel whose texels begin at `first_texel`.
    pub(crate) fn header(&self, first_texel: u32) -> RayTexture {
        let ([width, height], [wrap_u, wrap_v]) = (self.size_px, self.wrap);
        let sampling = wrap_u as u32 | (wrap_v as u32) << 2 | (self.filter as u32) << 4;
        RayTexture { first_texel, width, height, sampling }
    }

    /// Returns the value at a point, 0 to 1.
    #[must_use]
    pub fn value(&self, uv: Vec2) -> f32 {
        Channel { size_px: self.size_px, texels: &self.texels, wrap: self.wrap, filter: self.filter }
            .value(uv)
    }
}

/// A channel of a texture whose texels are elsewhere.
pub(crate) struct Channel<'t> {
    size_px: [u32; 2],
    texels: &'t [u8],
    wrap: [Wrap; 2],
    filter: Filter,
}

impl<'t> Channel<'t> {
    /// Returns the channel that the shader reads. `texels` are those of all textures.
    pub(crate) fn new(header: RayTexture, texels: &'t [u8]) -> Self {
        let wrap = |bits: u32| match bits & 3 {
            0 => Wrap::Repeat,
            1 => Wrap::Mirror,
            _ => Wrap::Clamp,
        };
        let RayTexture { first_texel, width, height, sampling } = header;
        Self {
            size_px: [width, height],
            texels: texels.get(first_texel as usize..).unwrap_or_default(),
            wrap: [wrap(sampling), wrap(sampling >> 2)],
            filter: if sampling & 16 == 0 { Filter::Nearest } else { Filter::Bilinear },
        }
    }

    /// Returns the value at a point, 0 to 1.
    pub(crate) fn value(&self, uv: Vec2) -> f32 {
        let x = folded(uv.x, self.wrap[0]) * self.size_px[0] as f32;
        let y = folded(uv.y, self.wrap[1]) * self.size_px[1] as f32;
        if self.filter == Filter::Nearest {
            return self.texel(x as i32, y as i32);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right_weight, bottom_weight) = (x - left, y - top);
        let row = |y: i32| {
            let (a, b) = (self.texel(left as i32, y), self.texel(left as i32 + 1, y));
            a + (b - a) * right_weight
        };
        let (a, b) = (row(top as i32), row(top as i32 + 1));
        a + (b - a) * bottom_weight
    }

    /// Returns the value of a texel, 0 to 1; columns and rows are from -1 to the size.
    fn texel(&self, x: i32, y: i32) -> f32 {
        let column = wrapped(x, self.size_px[0], self.wrap[0]);
        let row = wrapped(y, self.size_px[1], self.wrap[1]);
        let index = row as usize * self.size_px[0] as usize + column as usize;
        f32::from(self.texels.get(index).copied().unwrap_or(u8::MAX)) * (1.0 / 255.0)
    }
}

/// Returns a texture coordinate wrapped into 0 to 1.
fn folded(coordinate: f32, wrap: Wrap) -> f32 {
    match wrap {
        Wrap::Repeat => coordinate - coordinate.floor(),
        Wrap::Mirror => {
            let period = coordinate - 2.0 * (coordinate * 0.5).floor();
            period.min(2.0 - period)
        }
        Wrap::Clamp => coordinate.clamp(0.0, 1.0),
    }
}

/// Wraps the index of a texel that is at most one step outside. A mirror repeats the edge's texel, as a clamp does.
fn wrapped(index: i32, size: u32, wrap: Wrap) -> i32 {
    let size = size as i32;
    match wrap {
        Wrap::Repeat if index < 0 => index + size,
        Wrap::Repeat if index >= size => index - size,
        Wrap::Repeat => index,
        Wrap::Mirror | Wrap::Clamp => index.clamp(0, size - 1),
    }
}
