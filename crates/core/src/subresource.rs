//! Subresources of textures and buffers, and arithmetic of regions.

#[cfg(test)]
mod tests;

use crate::desc::{Extent, ResourceDesc, TextureDesc};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;
use wgpu_types::TextureDimension;

/// A rectangle of texels, for tiles of an atlas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Rect {
    /// Left edge in texels.
    pub x: u32,
    /// Upper edge in texels.
    pub y: u32,
    /// Width in texels, at least 1.
    pub width: u32,
    /// Height in texels, at least 1.
    pub height: u32,
}

impl Rect {
    /// Creates a rectangle from its corner and its size, in texels.
    pub const fn new(x: u32, y: u32, width: u32, height: u32) -> Self {
        Self { x, y, width, height }
    }
}

/// An aspect of a depth-stencil texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Aspect {
    /// All aspects of the format.
    #[default]
    All,
    /// Depth only.
    Depth,
    /// Stencil only.
    Stencil,
}

/// A subresource of a texture or buffer: mips, layers, an aspect, a rectangle of one mip, or a range of bytes.
///
/// [`Pass::subresource`](crate::Pass::subresource) narrows an access to one. Accesses to subresources that do not overlap
/// neither order each other nor define each other's contents.
///
/// ```
/// use shadowgraph_core::{Subresource, Rect};
/// let face = Subresource::FULL.layer(3);
/// let second_mip_of_face = face.mip(1);
/// let tile = Subresource::FULL.rect(Rect::new(512, 0, 512, 512));
/// let header = Subresource::FULL.bytes(0..64);
/// # let _ = (second_mip_of_face, tile, header);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Subresource {
    pub(crate) mips: Option<(u32, u32)>,
    pub(crate) layers: Option<(u32, u32)>,
    pub(crate) aspect: Aspect,
    pub(crate) rect: Option<Rect>,
    pub(crate) bytes: Option<(u64, u64)>,
}

impl Subresource {
    /// The full resource.
    pub const FULL: Self = Self { mips: None, layers: None, aspect: Aspect::All, rect: None, bytes: None };

    /// Narrows to one mip level.
    pub fn mip(self, mip: u32) -> Self {
        self.mips(mip..mip.saturating_add(1))
    }

    /// Narrows to these mip levels.
    pub fn mips(self, mips: Range<u32>) -> Self {
        Self { mips: Some((mips.start, mips.end)), ..self }
    }

    /// Narrows to one array layer, or one slice of a 3D texture.
    pub fn layer(self, layer: u32) -> Self {
        self.layers(layer..layer.saturating_add(1))
    }

    /// Narrows to these array layers, or slices of a 3D texture.
    pub fn layers(self, layers: Range<u32>) -> Self {
        Self { layers: Some((layers.start, layers.end)), ..self }
    }

    /// Narrows to one aspect of a depth-stencil texture.
    pub fn aspect(self, aspect: Aspect) -> Self {
        Self { aspect, ..self }
    }

    /// Narrows to a rectangle of one mip level, such as a tile of an atlas.
    pub fn rect(self, rect: Rect) -> Self {
        Self { rect: Some(rect), ..self }
    }

    /// Returns the rectangle that it is narrowed to; `None` for the whole width and height.
    pub fn bounds(&self) -> Option<Rect> {
        self.rect
    }

    /// Narrows to a range of a buffer, in bytes.
    pub fn bytes(self, bytes: Range<u64>) -> Self {
        Self { bytes: Some((bytes.start, bytes.end)), ..self }
    }

    /// Returns what is wrong with the subresource for a resource; `None` if nothing is.
    pub(crate) fn problem(&self, desc: &ResourceDesc) -> Option<&'static str> {
        match desc {
            ResourceDesc::Buffer(desc) => {
                if self.mips.is_some()
                    || self.layers.is_some()
                    || self.rect.is_some()
                    || self.aspect != Aspect::All
                {
                    return Some("a buffer has no mips, layers, aspects or rectangles; use `bytes`");
                }
                let (start, end) = self.bytes.unwrap_or((0, desc.bytes));
                (start >= end || end > desc.bytes)
                    .then_some("the byte range is empty or ends past the buffer")
            }
            ResourceDesc::Texture(desc) => self.texture_problem(desc),
        }
    }

    fn texture_problem(&self, desc: &TextureDesc) -> Option<&'static str> {
        let outside =
            |range: Option<(u32, u32)>, count| range.is_some_and(|(start, end)| start >= end || end > count);
        if self.bytes.is_some() {
            return Some("a texture has no byte ranges; use mips, layers or a rectangle");
        }
        if outside(self.mips, desc.mip_levels) {
            return Some("the mip range is empty or ends past the last mip");
        }
        if outside(self.layers, self.layer_count(desc)) {
            return Some("the layer range is empty or ends past the last layer");
        }
        let missing = match self.aspect {
            Aspect::All => false,
            Aspect::Depth => !desc.format.has_depth_aspect(),
            Aspect::Stencil => !desc.format.has_stencil_aspect(),
        };
        if missing {
            return Some("its format does not have that aspect");
        }
        let rect = self.rect?;
        let (first, end) = self.mips.unwrap_or((0, desc.mip_levels));
        if end - first != 1 {
            return Some("a rectangle needs one mip; narrow to that mip too");
        }
        let size = mip_size(desc, first);
        let inside = |start: u32, length: u32, side: u32| {
            length > 0 && start.checked_add(length).is_some_and(|end| end <= side)
        };
        let fits = inside(rect.x, rect.width, size.width) && inside(rect.y, rect.height, size.height);
        (!fits).then_some("the rectangle is empty or extends past the mip")
    }

    /// Returns the first mip level.
    pub fn first_mip(&self) -> u32 {
        self.mips.map_or(0, |(first, _)| first)
    }

    /// Returns the first layer, or slice of a 3D texture.
    pub fn first_layer(&self) -> u32 {
        self.layers.map_or(0, |(first, _)| first)
    }

    /// Returns the layers of a mip level of a texture, or the slices of a 3D texture.
    #[cfg(feature = "gpu")]
    pub(crate) fn layer_range(&self, desc: &TextureDesc, mip: u32) -> Range<u32> {
        let all = match desc.dimension {
            TextureDimension::D3 => (desc.size.depth_or_array_layers >> mip).max(1),
            _ => desc.size.depth_or_array_layers,
        };
        let (first, end) = self.layers.unwrap_or((0, all));
        first..end.min(all)
    }

    /// Returns the first byte of a buffer.
    pub fn first_byte(&self) -> u64 {
        self.bytes.map_or(0, |(first, _)| first)
    }

    /// Returns the aspect.
    pub fn selected_aspect(&self) -> Aspect {
        self.aspect
    }

    /// Returns whether the subresource is within a resource, and of its kind.
    pub fn is_within(&self, desc: &ResourceDesc) -> bool {
        self.problem(desc).is_none()
    }

    /// Returns whether two subresources of a resource, which they are [within](Self::is_within), share texels or bytes.
    pub fn overlaps(&self, other: &Self, desc: &ResourceDesc) -> bool {
        let [own, other] = [self, other].map(|part| part.region(desc).unwrap_or(Region::ALL));
        own.overlaps(&other)
    }

    /// Returns whether all of another subresource of a resource, which they are [within](Self::is_within), is in this one.
    pub fn contains(&self, other: &Self, desc: &ResourceDesc) -> bool {
        let [own, other] = [self, other].map(|part| part.region(desc).unwrap_or(Region::ALL));
        own.contains(&other)
    }

    /// Returns the subresource as a region, or `None` for the full resource. It must be valid for the resource.
    pub(crate) fn region(&self, desc: &ResourceDesc) -> Option<Region> {
        let mut region = Region::ALL;
        match desc {
            ResourceDesc::Buffer(desc) => {
                if let Some(bytes) = self.bytes {
                    region.narrow(Axis::X, bytes, desc.bytes);
                }
            }
            ResourceDesc::Texture(desc) => {
                self.narrow_subresources(&mut region, desc);
                if let Some(rect) = self.rect {
                    let mip = self.mips.map_or(0, |(first, _)| first);
                    let size = mip_size(desc, mip);
                    let span = |start: u32, length: u32| (start.into(), u64::from(start) + u64::from(length));
                    region.narrow(Axis::X, span(rect.x, rect.width), size.width.into());
                    region.narrow(Axis::Y, span(rect.y, rect.height), size.height.into());
                }
            }
        }
        (region != Region::ALL).then_some(region)
    }

    /// Returns the number of layers, or the slices of the largest of the mips of a 3D texture.
    fn layer_count(&self, desc: &TextureDesc) -> u32 {
        let (mip, _) = self.mips.unwrap_or((0, desc.mip_levels));
        match desc.dimension {
            TextureDimension::D3 => mip_size(desc, mip).depth_or_array_layers,
            TextureDimension::D1 | TextureDimension::D2 => desc.size.depth_or_array_layers,
        }
    }

    fn narrow_subresources(&self, region: &mut Region, desc: &TextureDesc) {
        let wide = |(start, end): (u32, u32)| (start.into(), end.into());
        if let Some(mips) = self.mips {
            region.narrow(Axis::Mip, wide(mips), desc.mip_levels.into());
        }
        if let Some(layers) = self.layers {
            region.narrow(Axis::Layer, wide(layers), self.layer_count(desc).into());
        }
        if desc.format.is_combined_depth_stencil_format() {
            match self.aspect {
                Aspect::All => {}
                Aspect::Depth => region.narrow(Axis::Aspect, (0, 1), 2),
                Aspect::Stencil => region.narrow(Axis::Aspect, (1, 2), 2),
            }
        }
    }
}

/// Formats the subresource as `mip 1, layer 3`, or `all`.
impl fmt::Display for Subresource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let range = |name: &str, (start, end): (u64, u64)| match end.saturating_sub(start) {
            1 => format!("{name} {start}"),
            _ => format!("{name}s {start}..{end}"),
        };
        let wide = |(start, end): (u32, u32)| (u64::from(start), u64::from(end));
        let mut limits: Vec<String> = Vec::new();
        limits.extend(self.mips.map(|mips| range("mip", wide(mips))));
        limits.extend(self.layers.map(|layers| range("layer", wide(layers))));
        limits.extend(match self.aspect {
            Aspect::All => None,
            Aspect::Depth => Some("depth".into()),
            Aspect::Stencil => Some("stencil".into()),
        });
        limits.extend(self.rect.map(|r| format!("{}x{} at {},{}", r.width, r.height, r.x, r.y)));
        limits.extend(self.bytes.map(|bytes| range("byte", bytes)));
        if limits.is_empty() { f.write_str("all") } else { f.write_str(&limits.join(", ")) }
    }
}

/// Returns the size of a mip. Subresources are checked before descriptions, so the texture may have too many mips.
fn mip_size(desc: &TextureDesc, mip: u32) -> Extent {
    desc.size.mip_level_size(mip.min(31), desc.dimension)
}

#[derive(Clone, Copy)]
enum Axis {
    Aspect,
    Mip,
    Layer,
    X,
    Y,
}

const AXES: usize = 5;
/// The open end of an axis: as far as the resource reaches.
const END: u64 = u64::MAX;

/// A box over aspect, mip, layer, x and y (texels of its mip, or bytes). What reaches the edge of the resource ends
/// at infinity, so that boxes of resources of different sizes can be the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Region {
    start: [u64; AXES],
    end: [u64; AXES],
}

impl Region {
    pub(crate) const ALL: Self = Self { start: [0; AXES], end: [END; AXES] };

    fn narrow(&mut self, axis: Axis, (start, end): (u64, u64), length: u64) {
        self.start[axis as usize] = start;
        self.end[axis as usize] = if end >= length { END } else { end };
    }

    /// Widens the region to whole mips, layers and aspects, which an attachment loads and stores.
    pub(crate) fn without_rect(mut self) -> Self {
        for axis in [Axis::X, Axis::Y] {
            self.start[axis as usize] = 0;
            self.end[axis as usize] = END;
        }
        self
    }

    /// Widens the region to all layers, since wgpu does not track the slices of a volume.
    pub(crate) fn all_layers(mut self) -> Self {
        self.start[Axis::Layer as usize] = 0;
        self.end[Axis::Layer as usize] = END;
        self
    }

    /// Widens the region to both aspects, which wgpu tracks together within one pass.
    pub(crate) fn subresources(self) -> Self {
        let mut region = self.without_rect();
        region.start[Axis::Aspect as usize] = 0;
        region.end[Axis::Aspect as usize] = END;
        region
    }

    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..AXES).all(|axis| self.start[axis] < other.end[axis] && other.start[axis] < self.end[axis])
    }

    pub(crate) fn contains(&self, other: &Self) -> bool {
        (0..AXES).all(|axis| self.start[axis] <= other.start[axis] && other.end[axis] <= self.end[axis])
    }
}

/// A set of texels or bytes, as boxes that do not overlap.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct RegionSet {
    boxes: Vec<Region>,
}

impl RegionSet {
    pub(crate) fn from_region(region: Region) -> Self {
        Self { boxes: vec![region] }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    pub(crate) fn overlaps(&self, region: &Region) -> bool {
        self.boxes.iter().any(|own| own.overlaps(region))
    }

    pub(crate) fn add(&mut self, region: Region) {
        self.subtract(&region);
        self.boxes.push(region);
    }

    /// Takes `region` out: each box that it overlaps falls into the slabs around it, at most two for each axis.
    pub(crate) fn subtract(&mut self, region: &Region) {
        if !self.overlaps(region) {
            return;
        }
        let mut kept = Vec::with_capacity(self.boxes.len() + 2);
        for mut rest in self.boxes.drain(..) {
            if !rest.overlaps(region) {
                kept.push(rest);
                continue;
            }
            for axis in 0..AXES {
                if rest.start[axis] < region.start[axis] {
                    let mut slab = rest;
                    slab.end[axis] = region.start[axis];
                    rest.start[axis] = region.start[axis];
                    kept.push(slab);
                }
                if rest.end[axis] > region.end[axis] {
                    let mut slab = rest;
                    slab.start[axis] = region.end[axis];
                    rest.end[axis] = region.end[axis];
                    kept.push(slab);
                }
            }
        }
        self.boxes = kept;
    }

    /// Keeps only what is inside `region`.
    pub(crate) fn clip(&mut self, region: &Region) {
        self.boxes.retain_mut(|own| {
            for axis in 0..AXES {
                own.start[axis] = own.start[axis].max(region.start[axis]);
                own.end[axis] = own.end[axis].min(region.end[axis]);
            }
            (0..AXES).all(|axis| own.start[axis] < own.end[axis])
        });
    }

    /// Returns whether the set contains all of `region`.
    pub(crate) fn contains(&self, region: &Region) -> bool {
        if self.boxes.iter().any(|own| own.contains(region)) {
            return true;
        }
        let mut rest = Self::from_region(*region);
        for own in &self.boxes {
            rest.subtract(own);
        }
        rest.is_empty()
    }
}
