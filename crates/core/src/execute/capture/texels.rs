//! Texels of any format as numbers to look at.

use crate::Format;
use crate::dump::{TexelValues, Texels};
use half::f16;

/// So many texels of a side are kept at most.
const SIDE: u32 = 320;

/// How the channels of a texel lie in memory.
#[derive(Clone, Copy)]
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

/// Keeps some texels of a picture, as they are shown or as numbers; an error says why there is no picture.
pub(super) fn texels(format: Format, full_px: [u32; 2], bytes: &[u8]) -> Result<Texels, String> {
    let Some((channel, channels, blue_first)) = layout(format) else {
        return Err(format!("texels of {format:?} are not shown"));
    };
    let texel_bytes = channel.bytes() * channels as usize;
    let size_px = shown(full_px);
    let row = full_px[0] as usize * texel_bytes;
    let kept = |y: u32| {
        let top = nearest(y, size_px[1], full_px[1]) as usize * row;
        (0..size_px[0]).map(move |x| top + nearest(x, size_px[0], full_px[0]) as usize * texel_bytes)
    };
    let places = (0..size_px[1]).flat_map(kept);
    let order: &[usize] = if blue_first { &[2, 1, 0, 3] } else { &[0, 1, 2, 3] };
    let of_texel =
        |place: usize| order[..channels as usize].iter().map(move |index| place + index * channel.bytes());
    let missing = || format!("its texels are not {texel_bytes} bytes each");
    let values = if let Channel::Unorm8 = channel {
        let bytes: Option<Vec<u8>> = places.flat_map(of_texel).map(|at| bytes.get(at).copied()).collect();
        TexelValues::Bytes(bytes.ok_or_else(missing)?)
    } else {
        let floats: Option<Vec<f32>> =
            places.flat_map(of_texel).map(|at| channel.value(bytes.get(at..)?)).collect();
        TexelValues::Floats(floats.ok_or_else(missing)?)
    };
    Ok(Texels { size_px, channels, is_depth: format.is_depth_stencil_format(), values })
}

/// The size of the picture: the whole, or so much smaller that no side is too long.
fn shown([width, height]: [u32; 2]) -> [u32; 2] {
    let longest = width.max(height).max(SIDE);
    [width, height].map(|side| (u64::from(side) * u64::from(SIDE) / u64::from(longest)).max(1) as u32)
}

/// The texel in the middle of those that one of the picture stands for.
fn nearest(at: u32, shown: u32, full: u32) -> u32 {
    let middle = (2 * u64::from(at) + 1) * u64::from(full) / (2 * u64::from(shown));
    middle as u32
}

/// Kind and number of a format's channels, and whether blue comes before red.
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

    fn value(self, bytes: &[u8]) -> Option<f32> {
        let byte = *bytes.first()?;
        let two = || bytes.first_chunk().copied();
        let four = || bytes.first_chunk().copied();
        Some(match self {
            Self::Unorm8 => f32::from(byte) / 255.0,
            Self::Snorm8 => (f32::from(byte as i8) / 127.0).max(-1.0),
            Self::Uint8 => byte.into(),
            Self::Sint8 => (byte as i8).into(),
            Self::Unorm16 => f32::from(u16::from_le_bytes(two()?)) / 65535.0,
            Self::Snorm16 => (f32::from(i16::from_le_bytes(two()?)) / 32767.0).max(-1.0),
            Self::Uint16 => u16::from_le_bytes(two()?).into(),
            Self::Sint16 => i16::from_le_bytes(two()?).into(),
            Self::Float16 => f16::from_le_bytes(two()?).to_f32(),
            Self::Uint32 => u32::from_le_bytes(four()?) as f32,
            Self::Sint32 => i32::from_le_bytes(four()?) as f32,
            Self::Float32 => f32::from_le_bytes(four()?),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
    use super::*;

    fn values(format: Format, size: [u32; 2], bytes: &[u8]) -> Vec<f32> {
        match texels(format, size, bytes).unwrap().values {
            TexelValues::Bytes(bytes) => bytes.into_iter().map(f32::from).collect(),
            TexelValues::Floats(floats) => floats,
        }
    }

    #[test]
    fn eight_bits_stay_as_they_are_and_red_comes_first() {
        assert_eq!(values(Format::Rgba8Unorm, [1, 1], &[1, 2, 3, 4]), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(values(Format::Bgra8UnormSrgb, [1, 1], &[1, 2, 3, 4]), [3.0, 2.0, 1.0, 4.0]);
    }

    #[test]
    fn numbers_are_what_a_shader_would_read() {
        assert_eq!(values(Format::R16Float, [2, 1], &[0x00, 0x3c, 0x00, 0xc0]), [1.0, -2.0]);
        assert_eq!(values(Format::Depth16Unorm, [1, 1], &[0xff, 0xff]), [1.0]);
        assert_eq!(values(Format::R8Sint, [1, 1], &[0xff]), [-1.0]);
        assert_eq!(values(Format::R32Uint, [1, 1], &[1, 1, 0, 0]), [257.0]);
        assert_eq!(values(Format::Depth32Float, [1, 1], &0.25f32.to_le_bytes()), [0.25]);
    }

    #[test]
    fn a_large_picture_keeps_the_middle_of_each_run_of_texels() {
        let (width, height) = (SIDE * 4, 8);
        let bytes: Vec<u8> = (0..height)
            .flat_map(|y| (0..width).flat_map(move |x| ((x * 16 + y) as u16).to_le_bytes()))
            .collect();
        let shown = texels(Format::R16Uint, [width, height], &bytes).unwrap();
        assert_eq!(shown.size_px, [SIDE, 2]);
        let TexelValues::Floats(values) = shown.values else { panic!("numbers") };
        // Texel 2 of 0 to 3, row 2 of 0 to 3; then texel 6.
        assert_eq!(values[..2], [(2 * 16 + 2) as f32, (6 * 16 + 2) as f32]);
        assert_eq!(values.len(), SIDE as usize * 2);
    }

    #[test]
    fn what_has_no_plain_texels_is_refused_with_its_format() {
        let error = texels(Format::Bc1RgbaUnorm, [4, 4], &[0; 8]).unwrap_err();
        assert!(error.contains("Bc1RgbaUnorm"), "{error}");
        assert!(texels(Format::R32Float, [2, 2], &[0; 8]).is_err(), "too few bytes");
    }
}
