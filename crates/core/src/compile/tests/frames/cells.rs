//! A resource as a short list of cells: single texels of each aspect, or 8 bytes of a buffer.

use super::SubresourceSpec;
use crate::{Aspect, Format, ResourceDesc, TextureDesc};
use wgpu_types::TextureDimension;

/// The position of a cell. In a buffer, `x` counts units of 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Cell {
    pub(in super::super) mip: u32,
    pub(in super::super) layer: u32,
    pub(in super::super) aspect: Aspect,
    pub(in super::super) x: u32,
    pub(in super::super) y: u32,
}

/// Bytes of a cell of a buffer.
pub(super) const UNIT: u64 = 8;

/// A set of cells of a resource, which may have 256.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in super::super) struct Cells([u64; 4]);

impl Cells {
    pub(in super::super) const MOST: usize = 256;

    /// The first `count` cells.
    pub(in super::super) fn first(count: usize) -> Self {
        let mut cells = Self::default();
        (0..count).for_each(|cell| cells.insert(cell));
        cells
    }

    pub(in super::super) fn insert(&mut self, cell: usize) {
        self.0[cell / 64] |= 1 << (cell % 64);
    }

    pub(in super::super) fn contains(&self, cell: usize) -> bool {
        self.0[cell / 64] >> (cell % 64) & 1 == 1
    }

    pub(in super::super) fn overlaps(&self, other: &Self) -> bool {
        self.0.iter().zip(other.0).any(|(a, b)| a & b != 0)
    }

    pub(in super::super) fn covers(&self, other: &Self) -> bool {
        self.0.iter().zip(other.0).all(|(a, b)| b & !a == 0)
    }

    pub(in super::super) fn union(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|word| self.0[word] | other.0[word]))
    }

    pub(in super::super) fn iter(&self) -> impl Iterator<Item = usize> {
        let words = self.0;
        (0..4usize).flat_map(move |word| {
            let mut rest = words[word];
            std::iter::from_fn(move || {
                let bit = rest.trailing_zeros() as usize;
                rest &= rest.checked_sub(1)?;
                Some(word * 64 + bit)
            })
        })
    }
}

/// The cells of a resource.
pub(in super::super) fn cells_of(desc: &ResourceDesc) -> Vec<Cell> {
    match desc {
        ResourceDesc::Buffer(desc) => {
            let cell = |x| Cell { mip: 0, layer: 0, aspect: Aspect::All, x, y: 0 };
            (0..(desc.bytes / UNIT) as u32).map(cell).collect()
        }
        ResourceDesc::Texture(desc) => texels_of(desc),
    }
}

fn texels_of(desc: &TextureDesc) -> Vec<Cell> {
    let mut cells = Vec::new();
    for mip in 0..desc.mip_levels {
        let (width, height) = mip_size(desc, mip);
        for layer in 0..layers(desc, mip) {
            for &aspect in aspects(desc.format) {
                for y in 0..height {
                    cells.extend((0..width).map(|x| Cell { mip, layer, aspect, x, y }));
                }
            }
        }
    }
    cells
}

fn aspects(format: Format) -> &'static [Aspect] {
    match format {
        Format::Depth24PlusStencil8 | Format::Depth32FloatStencil8 => &[Aspect::Depth, Aspect::Stencil],
        Format::Depth16Unorm | Format::Depth24Plus | Format::Depth32Float => &[Aspect::Depth],
        Format::Stencil8 => &[Aspect::Stencil],
        _ => &[Aspect::All],
    }
}

/// Width and height of a mip in texels.
pub(super) fn mip_size(desc: &TextureDesc, mip: u32) -> (u32, u32) {
    ((desc.size.width >> mip).max(1), (desc.size.height >> mip).max(1))
}

/// Layers of a mip, or slices.
pub(super) fn layers(desc: &TextureDesc, mip: u32) -> u32 {
    match desc.dimension {
        TextureDimension::D3 => (desc.size.depth_or_array_layers >> mip).max(1),
        _ => desc.size.depth_or_array_layers,
    }
}

impl SubresourceSpec {
    fn holds(&self, cell: &Cell) -> bool {
        let within = |range: Option<(u32, u32)>, at| range.is_none_or(|(start, end)| start <= at && at < end);
        let aspect = self.aspect == Aspect::All || self.aspect == cell.aspect;
        let texel = self.rect.is_none_or(|rect| {
            (rect.x..rect.x + rect.width).contains(&cell.x)
                && (rect.y..rect.y + rect.height).contains(&cell.y)
        });
        let byte = u64::from(cell.x) * UNIT;
        let bytes = self.bytes.is_none_or(|(start, end)| start <= byte && byte < end);
        aspect && texel && bytes && within(self.mips, cell.mip) && within(self.layers, cell.layer)
    }

    /// Returns the cells of the subresource.
    pub(in super::super) fn cells(&self, cells: &[Cell]) -> Cells {
        let mut held = Cells::default();
        for (index, _) in cells.iter().enumerate().filter(|(_, cell)| self.holds(cell)) {
            held.insert(index);
        }
        held
    }
}
