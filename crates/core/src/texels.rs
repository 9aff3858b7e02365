//! Decoding texels of any format to numbers.

#[cfg(feature = "gpu")]
use crate::capture::{TexelValues, Texels};
use crate::desc::Format;
use crate::subresource::Aspect;
use half::f16;

/// Texels of a side that are kept at most.
#[cfg(feature = "gpu")]
const MAX_SIDE_PX: u32 = 320;

/// The memory format of a texel's channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Channel {
    Unorm8,
    Snorm8,
    Uint8,
    Sint8,
    Unorm16,
    Snorm16,
    Uint16,
    Sint16,
    Float16,
    Uint32,
    Sint32,
    Float32,
}

/// How texels of a format lie in memory, and what a shader reads from them.
///
/// ```
/// use shadowgraph_core::{Aspect, Format, TexelLayout};
/// let layout = TexelLayout::for_format(Format::Bgra8Unorm, Aspect::All).ok_or("a plain format")?;
/// assert_eq!(layout.values(&[0, 51, 255, 255]), Some(vec![1.0, 0.2, 0.0, 1.0]));
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelLayout {
    channel: Channel,
    channels: u32,
    blue_first: bool,
}

impl TexelLayout {
    /// Returns the layout of an aspect of a format; `None` for compressed and packed formats, and for depth of 24 bits.
    pub fn for_format(format: Format, aspect: Aspect) -> Option<Self> {
        let format = match aspect {
            Aspect::Stencil => Format::Stencil8,
            Aspect::All | Aspect::Depth => format,
        };
        let (channel, channels, blue_first) = layout(format)?;
        Some(Self { channel, channels, blue_first })
    }

    /// Returns the bytes of a texel.
    pub fn bytes(self) -> usize {
        self.channel.bytes() * self.channels as usize
    }

    /// Returns the channels of a texel, red first; sRGB formats as they are stored. `None` for too few bytes.
    pub fn values(self, texel: &[u8]) -> Option<Vec<f64>> {
        self.channel_offsets(0).map(|at| self.channel.value(texel.get(at..)?)).collect()
    }

    /// Returns where the channels of the texel at a byte begin, red first.
    fn channel_offsets(self, texel: usize) -> impl Iterator<Item = usize> {
        let order: &[usize] = if self.blue_first { &[2, 1, 0, 3] } else { &[0, 1, 2, 3] };
        order[..self.channels as usize].iter().map(move |index| texel + index * self.channel.bytes())
    }
}

/// Keeps evenly spaced texels of an image and decodes them; the error says why they cannot be shown.
#[cfg(feature = "gpu")]
pub(crate) fn decode(format: Format, full_px: [u32; 2], bytes: &[u8]) -> Result<Texels, String> {
    let aspect = if format == Format::Stencil8 { Aspect::Stencil } else { Aspect::All };
    let Some(layout) = TexelLayout::for_format(format, aspect) else {
        return Err(format!("texels of {format:?} cannot be shown"));
    };
    let texel_bytes = layout.bytes();
    let size_px = kept_size(full_px);
    let row = full_px[0] as usize * texel_bytes;
    let row_offsets = |y: u32| {
        let row_start = nearest(y, size_px[1], full_px[1]) as usize * row;
        (0..size_px[0]).map(move |x| row_start + nearest(x, size_px[0], full_px[0]) as usize * texel_bytes)
    };
    let offsets = (0..size_px[1]).flat_map(row_offsets).flat_map(|texel| layout.channel_offsets(texel));
    let missing = || format!("expected {texel_bytes} bytes per texel");
    let values = if let Channel::Unorm8 = layout.channel {
        let bytes: Option<Vec<u8>> = offsets.map(|at| bytes.get(at).copied()).collect();
        TexelValues::Bytes(bytes.ok_or_else(missing)?)
    } else {
        let value = |at| Some(layout.channel.value(bytes.get(at..)?)? as f32);
        let floats: Option<Vec<f32>> = offsets.map(value).collect();
        TexelValues::Floats(floats.ok_or_else(missing)?)
    };
    let is_depth = format.is_depth_stencil_format();
    Ok(Texels { size_px, channels: layout.channels, is_depth, values })
}

/// Returns the full size, scaled down so that no side is too long.
#[cfg(feature = "gpu")]
fn kept_size([width, height]: [u32; 2]) -> [u32; 2] {
    let longest = width.max(height).max(MAX_SIDE_PX);
    [width, height].map(|side| (u64::from(side) * u64::from(MAX_SIDE_PX) / u64::from(longest)).max(1) as u32)
}

/// Returns the index of the texel in the middle of those that a kept texel represents.
#[cfg(feature = "gpu")]
fn nearest(index: u32, kept: u32, full: u32) -> u32 {
    let middle = (2 * u64::from(index) + 1) * u64::from(full) / (2 * u64::from(kept));
    middle as u32
}

/// Returns the kind and number of a format's channels, and whether blue comes before red.
fn layout(format: Format) -> Option<(Channel, u32, bool)> {
    use Channel::{
        Float16, Float32, Sint8, Sint16, Sint32, Snorm8, Snorm16, Uint8, Uint16, Uint32, Unorm8, Unorm16,
    };
    Some(match format {
        Format::R8Unorm => (Unorm8, 1, false),
        Format::R8Snorm => (Snorm8, 1, false),
        Format::R8Uint | Format::Stencil8 => (Uint8, 1, false),
        Format::R8Sint => (Sint8, 1, false),
        Format::Rg8Unorm => (Unorm8, 2, false),
        Format::Rg8Snorm => (Snorm8, 2, false),
        Format::Rg8Uint => (Uint8, 2, false),
        Format::Rg8Sint => (Sint8, 2, false),
        Format::Rgba8Unorm | Format::Rgba8UnormSrgb => (Unorm8, 4, false),
        Format::Bgra8Unorm | Format::Bgra8UnormSrgb => (Unorm8, 4, true),
        Format::Rgba8Snorm => (Snorm8, 4, false),
        Format::Rgba8Uint => (Uint8, 4, false),
        Format::Rgba8Sint => (Sint8, 4, false),
        Format::R16Unorm | Format::Depth16Unorm => (Unorm16, 1, false),
        Format::R16Snorm => (Snorm16, 1, false),
        Format::R16Uint => (Uint16, 1, false),
        Format::R16Sint => (Sint16, 1, false),
        Format::R16Float => (Float16, 1, false),
        Format::Rg16Unorm => (Unorm16, 2, false),
        Format::Rg16Snorm => (Snorm16, 2, false),
        Format::Rg16Uint => (Uint16, 2, false),
        Format::Rg16Sint => (Sint16, 2, false),
        Format::Rg16Float => (Float16, 2, false),
        Format::Rgba16Unorm => (Unorm16, 4, false),
        Format::Rgba16Snorm => (Snorm16, 4, false),
        Format::Rgba16Uint => (Uint16, 4, false),
        Format::Rgba16Sint => (Sint16, 4, false),
        Format::Rgba16Float => (Float16, 4, false),
        Format::R32Uint => (Uint32, 1, false),
        Format::R32Sint => (Sint32, 1, false),
        Format::R32Float | Format::Depth32Float | Format::Depth32FloatStencil8 => (Float32, 1, false),
        Format::Rg32Uint => (Uint32, 2, false),
        Format::Rg32Sint => (Sint32, 2, false),
        Format::Rg32Float => (Float32, 2, false),
        Format::Rgba32Uint => (Uint32, 4, false),
        Format::Rgba32Sint => (Sint32, 4, false),
        Format::Rgba32Float => (Float32, 4, false),
        _ => return None,
    })
}

impl Channel {
    fn bytes(self) -> usize {
        match self {
            Self::Unorm8 | Self::Snorm8 | Self::Uint8 | Self::Sint8 => 1,
            Self::Unorm16 | Self::Snorm16 | Self::Uint16 | Self::Sint16 | Self::Float16 => 2,
            Self::Uint32 | Self::Sint32 | Self::Float32 => 4,
        }
    }

    fn value(self, bytes: &[u8]) -> Option<f64> {
        let byte = *bytes.first()?;
        let two = || bytes.first_chunk().copied();
        let four = || bytes.first_chunk().copied();
        Some(match self {
            Self::Unorm8 => f64::from(byte) / 255.0,
            Self::Snorm8 => (f64::from(byte as i8) / 127.0).max(-1.0),
            Self::Uint8 => byte.into(),
            Self::Sint8 => (byte as i8).into(),
            Self::Unorm16 => f64::from(u16::from_le_bytes(two()?)) / 65535.0,
            Self::Snorm16 => (f64::from(i16::from_le_bytes(two()?)) / 32767.0).max(-1.0),
            Self::Uint16 => u16::from_le_bytes(two()?).into(),
            Self::Sint16 => i16::from_le_bytes(two()?).into(),
            Self::Float16 => f16::from_le_bytes(two()?).to_f64(),
            Self::Uint32 => u32::from_le_bytes(four()?).into(),
            Self::Sint32 => i32::from_le_bytes(four()?).into(),
            Self::Float32 => f32::from_le_bytes(four()?).into(),
        })
    }
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
    use super::*;

    fn values(format: Format, size: [u32; 2], bytes: &[u8]) -> Vec<f32> {
        match decode(format, size, bytes).unwrap().values {
            TexelValues::Bytes(bytes) => bytes.into_iter().map(f32::from).collect(),
            TexelValues::Floats(floats) => floats,
        }
    }

    #[test]
    fn eight_bit_values_are_kept_and_red_comes_first() {
        assert_eq!(values(Format::Rgba8Unorm, [1, 1], &[1, 2, 3, 4]), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(values(Format::Bgra8UnormSrgb, [1, 1], &[1, 2, 3, 4]), [3.0, 2.0, 1.0, 4.0]);
    }

    #[test]
    fn decoded_values_are_those_that_a_shader_reads() {
        assert_eq!(values(Format::R16Float, [2, 1], &[0x00, 0x3c, 0x00, 0xc0]), [1.0, -2.0]);
        assert_eq!(values(Format::Depth16Unorm, [1, 1], &[0xff, 0xff]), [1.0]);
        assert_eq!(values(Format::R8Sint, [1, 1], &[0xff]), [-1.0]);
        assert_eq!(values(Format::R32Uint, [1, 1], &[1, 1, 0, 0]), [257.0]);
        assert_eq!(values(Format::Depth32Float, [1, 1], &0.25f32.to_le_bytes()), [0.25]);
    }

    #[test]
    fn a_large_image_keeps_the_middle_of_each_block_of_texels() {
        let (width, height) = (MAX_SIDE_PX * 4, 8);
        let bytes: Vec<u8> = (0..height)
            .flat_map(|y| (0..width).flat_map(move |x| ((x * 16 + y) as u16).to_le_bytes()))
            .collect();
        let kept = decode(Format::R16Uint, [width, height], &bytes).unwrap();
        assert_eq!(kept.size_px, [MAX_SIDE_PX, 2]);
        let TexelValues::Floats(values) = kept.values else { panic!("numbers") };
        // Texel 2 of 0 to 3, row 2 of 0 to 3; then texel 6.
        assert_eq!(values[..2], [(2 * 16 + 2) as f32, (6 * 16 + 2) as f32]);
        assert_eq!(values.len(), MAX_SIDE_PX as usize * 2);
    }

    #[test]
    fn a_format_without_plain_texels_is_an_error_that_names_it() {
        let error = decode(Format::Bc1RgbaUnorm, [4, 4], &[0; 8]).unwrap_err();
        assert!(error.contains("Bc1RgbaUnorm"), "{error}");
        assert!(decode(Format::R32Float, [2, 2], &[0; 8]).is_err(), "too few bytes");
    }
}
