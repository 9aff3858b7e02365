//! Checks of read-backs, and the layout of their copies.

use super::Rows;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::subresource::{Aspect, Rect, Subresource};
use std::ops::Range;
use wgpu::TextureDimension;

/// One mip level of some layers of a texture (slices of a 3D texture), or a rectangle of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TexturePart {
    pub(crate) mip: u32,
    pub(crate) layers: Range<u32>,
    /// `All` is valid for every format except combined depth-stencil ones.
    pub(crate) aspect: wgpu::TextureAspect,
    pub(crate) rect: Option<Rect>,
}

impl TexturePart {
    /// Converts a declared part to what one copy can read.
    pub(crate) fn from_part(name: &str, desc: &TextureDesc, part: &Subresource) -> Result<Self, Error> {
        let error = |problem: String| Error::ReadBack { resource: name.to_owned(), problem };
        if let Some(problem) = part.problem(&ResourceDesc::Texture(*desc)) {
            return Err(error(describe_request(part, problem)));
        }
        let (mip, end) = part.mips.unwrap_or((0, desc.mip_levels));
        if end - mip != 1 {
            return Err(error(format!(
                "{} mip levels are requested, but only one can be read at a time: narrow the part with `mip`",
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
pub(crate) struct TextureCopy {
    part: TexturePart,
    /// Size in texels, rounded up to whole blocks.
    size: wgpu::Extent3d,
    row_bytes: u32,
    /// Rows of blocks in a layer.
    rows: u32,
}

impl TextureCopy {
    /// Returns the bytes from row to row, aligned as copies require.
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

/// Checks that the part can be copied, and returns the layout of the copy.
pub(crate) fn texture(name: &str, desc: &TextureDesc, part: &TexturePart) -> Result<TextureCopy, Error> {
    let error = |problem: String| Error::ReadBack { resource: name.to_owned(), problem };
    if desc.samples > 1 {
        return Err(error(format!(
            "it has {} samples per texel: resolve it into a texture with one sample, and read that",
            desc.samples
        )));
    }
    let block_bytes = block_bytes(desc.format, part.aspect).map_err(error)?;
    let size = part_size(desc, part).map_err(error)?.physical_size(desc.format);
    let (block_width, block_height) = desc.format.block_dimensions();
    Ok(TextureCopy {
        part: part.clone(),
        size,
        row_bytes: size.width / block_width * block_bytes,
        rows: size.height / block_height,
    })
}

/// Checks that the range can be copied, and widens it to multiples of 4 bytes, as copies require.
pub(crate) fn buffer(name: &str, buffer: &wgpu::Buffer, range: &Range<u64>) -> Result<Range<u64>, Error> {
    let error = |problem: String| Error::ReadBack { resource: name.to_owned(), problem };
    if !buffer.usage().contains(wgpu::BufferUsages::COPY_SRC) {
        return Err(error(missing_copy_src()));
    }
    let size = buffer.size();
    if range.is_empty() || range.end > size {
        return Err(error(format!(
            "it has {size} bytes, but {range:?} are requested: request at least one byte within its size"
        )));
    }
    let align = wgpu::COPY_BUFFER_ALIGNMENT;
    let copied = range.start / align * align..range.end.next_multiple_of(align);
    if copied.end > size {
        return Err(error(format!(
            "its size of {size} bytes is not a multiple of {align}, so copies cannot reach its end: create it larger"
        )));
    }
    Ok(copied)
}

/// Describes the problem with a requested part.
pub(crate) fn describe_request(part: &Subresource, problem: &str) -> String {
    format!("{problem} (requested: {part})")
}

pub(crate) fn missing_copy_src() -> String {
    "it was created without COPY_SRC: add that usage where you create it".into()
}

/// Returns the number of layers of a mip level, or of its slices.
fn layers(desc: &TextureDesc, mip: u32) -> u32 {
    match desc.dimension {
        TextureDimension::D3 => desc.size.mip_level_size(mip, desc.dimension).depth_or_array_layers,
        _ => desc.size.depth_or_array_layers,
    }
}

/// Returns the size of the part in texels, if it is within the texture.
fn part_size(desc: &TextureDesc, part: &TexturePart) -> Result<wgpu::Extent3d, String> {
    let (mips, requested) = (desc.mip_levels, &part.layers);
    if part.mip >= mips {
        return Err(format!(
            "it has {mips} mip levels, but level {} is requested: levels count from 0",
            part.mip
        ));
    }
    let available = layers(desc, part.mip);
    if requested.is_empty() || requested.end > available {
        return Err(format!(
            "it has {available} layers, but {requested:?} are requested: request at least one that it has"
        ));
    }
    let size = desc.size.mip_level_size(part.mip, desc.dimension);
    let size = wgpu::Extent3d { depth_or_array_layers: requested.end - requested.start, ..size };
    let Some(rect) = part.rect else { return Ok(size) };
    if desc.format.is_depth_stencil_format() {
        return Err("depth and stencil can only be copied whole: request the mip without a rectangle".into());
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
        return Err(format!("its blocks are {width}x{height} texels: align the rectangle to whole blocks"));
    }
    Ok(wgpu::Extent3d { width: rect.width, height: rect.height, ..size })
}

/// Returns the bytes of a block in a copy, if the format and aspect can be copied.
fn block_bytes(format: wgpu::TextureFormat, aspect: wgpu::TextureAspect) -> Result<u32, String> {
    use wgpu::TextureAspect as Aspect;
    if format.is_multi_planar_format() {
        return Err(format!(
            "{format:?} has several planes: copy a plane into a separate texture, and read that"
        ));
    }
    if aspect == Aspect::All && format.is_combined_depth_stencil_format() {
        return Err(format!("{format:?} has two aspects: request only the depth or only the stencil"));
    }
    if format.aspect_specific_format(aspect).is_none() {
        return Err(format!("{format:?} has no aspect {aspect:?}: request one that it has"));
    }
    format
        .block_copy_size(Some(aspect))
        .ok_or_else(|| format!("the depth of {format:?} cannot be copied: use Depth32Float instead"))
}
