//! What can be read back, and how it is laid out in the copy.

use super::Rows;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::subresource::{Aspect, Rect, Subresource};
use std::ops::Range;
use wgpu::TextureDimension;

/// One mip level of some layers of a texture, or a rectangle of them; of a 3D texture, slices of that level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TexturePart {
    pub(crate) mip: u32,
    pub(crate) layers: Range<u32>,
    /// `All` will do for every format but those of depth and stencil together.
    pub(crate) aspect: wgpu::TextureAspect,
    pub(crate) rect: Option<Rect>,
}

impl TexturePart {
    /// Takes a declared part for what one copy can take.
    pub(crate) fn of(name: &str, desc: &TextureDesc, part: &Subresource) -> Result<Self, Error> {
        let refuse = |problem: String| Error::ReadBack { resource: name.to_owned(), problem };
        if let Some(problem) = part.problem(&ResourceDesc::Texture(*desc)) {
            return Err(refuse(asked(part, problem)));
        }
        let (mip, end) = part.mips.unwrap_or((0, desc.mip_levels));
        if end - mip != 1 {
            return Err(refuse(format!(
                "{} of its mip levels are asked for, and one is read at a time: narrow the part with `mip`",
                end - mip
            )));
        }
        let (first, last) = part.layers.unwrap_or((0, layers(desc, mip)));
        let aspect = match part.aspect {
            Aspect::All => wgpu::TextureAspect::All,
            Aspect::Depth => wgpu::TextureAspect::DepthOnly,
            Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
        };
        Ok(Self { mip, layers: first..last, aspect, rect: part.rect })
    }
}

/// A copy of whole layers into a buffer.
pub(super) struct TextureCopy {
    part: TexturePart,
    /// In texels, rounded up to whole blocks.
    size: wgpu::Extent3d,
    row_bytes: u32,
    /// Rows of blocks in a layer.
    rows: u32,
}

impl TextureCopy {
    /// Bytes from row to row, as copies need it.
    fn stride(&self) -> u32 {
        self.row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
    }

    pub(super) fn bytes(&self) -> u64 {
        u64::from(self.stride()) * u64::from(self.rows) * u64::from(self.size.depth_or_array_layers)
    }

    pub(super) fn rows(&self) -> Rows {
        Rows {
            offset: 0,
            bytes: self.row_bytes as usize,
            stride: self.stride() as usize,
            count: self.rows as usize * self.size.depth_or_array_layers as usize,
        }
    }

    pub(super) fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        buffer: &wgpu::Buffer,
    ) {
        let source = wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: self.part.mip,
            origin: wgpu::Origin3d {
                x: self.part.rect.map_or(0, |rect| rect.x),
                y: self.part.rect.map_or(0, |rect| rect.y),
                z: self.part.layers.start,
            },
            aspect: self.part.aspect,
        };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(self.stride()),
            rows_per_image: Some(self.rows),
        };
        encoder.copy_texture_to_buffer(source, wgpu::TexelCopyBufferInfo { buffer, layout }, self.size);
    }
}

/// Checks that the part can be copied, and lays it out.
pub(super) fn texture(name: &str, desc: &TextureDesc, part: &TexturePart) -> Result<TextureCopy, Error> {
    let refuse = |problem: String| Error::ReadBack { resource: name.to_owned(), problem };
    if desc.samples > 1 {
        return Err(refuse(format!(
            "it has {} samples per texel: resolve it into a texture with one, and read that",
            desc.samples
        )));
    }
    let block_bytes = block_bytes(desc.format, part.aspect).map_err(refuse)?;
    let size = part_size(desc, part).map_err(refuse)?.physical_size(desc.format);
    let (block_width, block_height) = desc.format.block_dimensions();
    Ok(TextureCopy {
        part: part.clone(),
        size,
        row_bytes: size.width / block_width * block_bytes,
        rows: size.height / block_height,
    })
}

/// Checks that the range can be copied, and widens it to the multiples of 4 bytes that copies need.
pub(super) fn buffer(name: &str, buffer: &wgpu::Buffer, range: &Range<u64>) -> Result<Range<u64>, Error> {
    let refuse = |problem: String| Error::ReadBack { resource: name.to_owned(), problem };
    if !buffer.usage().contains(wgpu::BufferUsages::COPY_SRC) {
        return Err(refuse(no_usage()));
    }
    let size = buffer.size();
    if range.is_empty() || range.end > size {
        return Err(refuse(format!(
            "it has {size} bytes, and {range:?} are asked for: ask for at least one of those it has"
        )));
    }
    let align = wgpu::COPY_BUFFER_ALIGNMENT;
    let copied = range.start / align * align..range.end.next_multiple_of(align);
    if copied.end > size {
        return Err(refuse(format!(
            "its {size} bytes are no multiple of {align}, and copies cannot reach the last ones: create it larger"
        )));
    }
    Ok(copied)
}

/// What is wrong with a part, and which it was.
pub(super) fn asked(part: &Subresource, problem: &str) -> String {
    format!("{problem} (asked for: {})", part.to_string())
}

pub(super) fn no_usage() -> String {
    "it was created without COPY_SRC: add that usage where you create it".into()
}

/// The layers of a mip level, or its slices.
fn layers(desc: &TextureDesc, mip: u32) -> u32 {
    match desc.dimension {
        TextureDimension::D3 => desc.size.mip_level_size(mip, desc.dimension).depth_or_array_layers,
        _ => desc.size.depth_or_array_layers,
    }
}

/// The size of the part in texels, if the texture has it.
fn part_size(desc: &TextureDesc, part: &TexturePart) -> Result<wgpu::Extent3d, String> {
    let (mips, asked) = (desc.mip_levels, &part.layers);
    if part.mip >= mips {
        return Err(format!("it has {mips} mip levels, and level {} is asked for: count from 0", part.mip));
    }
    let available = layers(desc, part.mip);
    if asked.is_empty() || asked.end > available {
        return Err(format!(
            "it has {available} layers, and {asked:?} are asked for: ask for at least one of those it has"
        ));
    }
    let size = desc.size.mip_level_size(part.mip, desc.dimension);
    let size = wgpu::Extent3d { depth_or_array_layers: asked.end - asked.start, ..size };
    let Some(rect) = part.rect else { return Ok(size) };
    if desc.format.is_depth_stencil_format() {
        return Err("depth and stencil are copied whole: ask for the mip without a rectangle".into());
    }
    let (width, height) = desc.format.block_dimensions();
    let aligned = rect.x.is_multiple_of(width) && rect.y.is_multiple_of(height);
    let ends = |start: u32, length: u32, side: u32, block: u32| {
        length.is_multiple_of(block) || start + length == side
    };
    if !aligned
        || !ends(rect.x, rect.width, size.width, width)
        || !ends(rect.y, rect.height, size.height, height)
    {
        return Err(format!(
            "its blocks are {width}x{height} texels: begin and end the rectangle at whole blocks"
        ));
    }
    Ok(wgpu::Extent3d { width: rect.width, height: rect.height, ..size })
}

/// The bytes of a block in a copy, if the format and aspect can be copied.
fn block_bytes(format: wgpu::TextureFormat, aspect: wgpu::TextureAspect) -> Result<u32, String> {
    use wgpu::TextureAspect as Aspect;
    if format.is_multi_planar_format() {
        return Err(format!(
            "{format:?} keeps its planes apart: copy a plane into a texture of its own, and read that"
        ));
    }
    if aspect == Aspect::All && format.is_combined_depth_stencil_format() {
        return Err(format!("{format:?} has two aspects: ask for the depth or for the stencil alone"));
    }
    if format.aspect_specific_format(aspect).is_none() {
        return Err(format!("{format:?} has no aspect {aspect:?}: ask for one that it has"));
    }
    format.block_copy_size(Some(aspect)).ok_or_else(|| {
        format!("the depth of {format:?} has no layout that a copy could give: use Depth32Float instead")
    })
}
