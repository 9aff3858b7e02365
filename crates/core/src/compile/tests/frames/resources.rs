//! Random shapes, resources and parts of them.

use super::SubresourceSpec;
use super::cells::{Cells, UNIT, layers, mip_size};
use super::generate::Generator;
use crate::{Aspect, BufferDesc, Format, Origin, Rect, ResourceDesc, TextureDesc};
use wgpu_types::TextureDimension;

pub(super) const COLORS: [Format; 4] =
    [Format::Rgba8Unorm, Format::Rgba8Unorm, Format::Rgba16Float, Format::R8Unorm];
pub(super) const DEPTHS: [Format; 4] =
    [Format::Depth32Float, Format::Depth24PlusStencil8, Format::Depth16Unorm, Format::Stencil8];

pub(super) fn is_depth(format: Format) -> bool {
    DEPTHS.contains(&format)
}

impl Generator<'_> {
    pub(super) fn texture_desc(&self, resource: usize) -> Option<TextureDesc> {
        match self.spec.desc(resource) {
            ResourceDesc::Texture(desc) => Some(*desc),
            ResourceDesc::Buffer(_) => None,
        }
    }

    fn format(&mut self, depth: bool) -> Format {
        let second = self.source.chance(64);
        self.formats[usize::from(depth)][usize::from(second)]
    }

    /// Creates a texture of this size, with mips, layers or slices now and then.
    pub(super) fn new_texture(&mut self, (width, height): (u32, u32), depth: bool, samples: u32) -> usize {
        let format = self.format(depth);
        let mut desc = TextureDesc { samples, ..TextureDesc::d2(width, height, format) };
        if samples == 1 {
            match self.source.below(16) {
                12 => desc.mip_levels = 2,
                13 => desc.mip_levels = 3,
                14 => desc = desc.layers(2 + self.source.below(2) as u32),
                15 if !depth => {
                    desc = desc.layers(2 + self.source.below(2) as u32);
                    desc.dimension = TextureDimension::D3;
                    desc.mip_levels = 1 + self.source.below(2) as u32;
                }
                15 => (desc.mip_levels, desc.size.depth_or_array_layers) = (2, 2),
                _ => {}
            }
            desc.mip_levels = desc.mip_levels.min(desc.size.max_mips(desc.dimension));
        }
        let desc = ResourceDesc::Texture(desc);
        let origin = self.origin();
        if let (Origin::Current { history }, 1) = (origin, samples) {
            self.add_resource(desc, Origin::Previous { history });
            return self.add_resource(desc, origin);
        }
        let origin = if matches!(origin, Origin::Current { .. }) { Origin::Transient } else { origin };
        self.add_resource(desc, origin)
    }

    pub(super) fn new_buffer(&mut self) -> usize {
        let units = match self.source.below(8) {
            0..5 => 1 + self.source.below(8),
            5 | 6 => 24 + self.source.below(40),
            _ => Cells::MOST - self.source.below(128),
        };
        let desc = ResourceDesc::Buffer(BufferDesc::new(units as u64 * UNIT));
        let origin = self.origin();
        let origin = if matches!(origin, Origin::Current { .. }) { Origin::Transient } else { origin };
        self.add_resource(desc, origin)
    }

    fn origin(&mut self) -> Origin {
        let current = |r: &&super::ResourceSpec| matches!(r.origin, Origin::Current { .. });
        match self.source.below(32) {
            29 => Origin::Current { history: self.spec.resources.iter().filter(current).count() as u32 },
            30 => Origin::Imported { defined: true },
            31 => Origin::Imported { defined: false },
            _ => Origin::Transient,
        }
    }

    /// Returns one of the two sizes of the frame, most often the first.
    pub(super) fn size(&mut self) -> (u32, u32) {
        let second = self.source.chance(48);
        self.sizes[usize::from(second)]
    }

    /// Returns a part of a resource to read, or to write other than by drawing.
    pub(super) fn any_part(&mut self, resource: usize) -> SubresourceSpec {
        match *self.spec.desc(resource) {
            ResourceDesc::Buffer(desc) => {
                SubresourceSpec { bytes: self.bytes(desc.bytes), ..SubresourceSpec::default() }
            }
            ResourceDesc::Texture(desc) => self.texture_part(&desc),
        }
    }

    fn bytes(&mut self, bytes: u64) -> Option<(u64, u64)> {
        if !self.source.chance(128) {
            return None;
        }
        let units = (bytes / UNIT) as usize;
        let start = self.source.below(units);
        let end = start + 1 + self.source.below(units - start);
        Some((start as u64 * UNIT, end as u64 * UNIT))
    }

    fn texture_part(&mut self, desc: &TextureDesc) -> SubresourceSpec {
        let mips = self.range(desc.mip_levels);
        let single = mips.map_or(desc.mip_levels == 1, |(start, end)| end - start == 1);
        let mip = mips.map_or(0, |(start, _)| start);
        // The number of slices of a 3D texture halves from mip to mip.
        let layered = single || desc.dimension != TextureDimension::D3;
        let layers = if layered { self.range(layers(desc, mip)) } else { None };
        let aspect = self.aspect(desc.format);
        let rect = if single { self.rect(mip_size(desc, mip)) } else { None };
        SubresourceSpec { mips, layers, aspect, rect, bytes: None }
    }

    /// Returns all of `count`, explicitly or not, or one, or some.
    fn range(&mut self, count: u32) -> Option<(u32, u32)> {
        let some = if count == 1 { 14 } else { 8 };
        match self.source.below(16) {
            choice if choice < some => None,
            15 => Some((0, count)),
            _ => {
                let start = self.source.below(count as usize) as u32;
                let more =
                    if self.source.chance(64) { self.source.below((count - start) as usize) } else { 0 };
                Some((start, start + 1 + more as u32))
            }
        }
    }

    pub(super) fn aspect(&mut self, format: Format) -> Aspect {
        if format != Format::Depth24PlusStencil8 {
            return Aspect::All;
        }
        match self.source.below(8) {
            6 => Aspect::Depth,
            7 => Aspect::Stencil,
            _ => Aspect::All,
        }
    }

    /// Returns a quarter, a half, or any rectangle of a mip; most often none.
    pub(super) fn rect(&mut self, (width, height): (u32, u32)) -> Option<Rect> {
        let half = |side: u32| side.div_ceil(2);
        let kind = self.source.below(16);
        let mut side = |length: u32, divided: bool| match divided {
            true if self.source.chance(128) => {
                (half(length).min(length - 1), length - half(length).min(length - 1))
            }
            true => (0, half(length)),
            false => (0, length),
        };
        let ((x, width), (y, height)) = match kind {
            0..10 => return None,
            10..13 => (side(width, true), side(height, true)),
            13 => (side(width, true), side(height, false)),
            14 => (side(width, false), side(height, false)),
            _ => {
                let mut side = |length: u32| {
                    let start = self.source.below(length as usize) as u32;
                    (start, 1 + self.source.below((length - start) as usize) as u32)
                };
                (side(width), side(height))
            }
        };
        Some(Rect::new(x, y, width, height))
    }
}
