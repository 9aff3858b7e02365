//! Random copies and uploads.

use super::SubresourceSpec;
use super::cells::{layers, mip_size};
use super::generate::Generator;
use super::resources::is_depth;
use crate::{Access, Aspect, BufferDesc, Contents, Origin, PassKind, ResourceDesc, TextureDesc};
use wgpu_types::TextureDimension;

impl Generator<'_> {
    pub(super) fn copy_pass(&mut self) {
        self.begin(PassKind::Copy);
        for _ in 0..1 + self.source.below(3) {
            self.copy();
        }
        self.end();
    }

    pub(super) fn upload(&mut self) {
        self.begin(PassKind::Copy);
        let desc = ResourceDesc::Buffer(BufferDesc::new(8 + 8 * self.source.below(8) as u64));
        let resource = self.add_resource(desc, Origin::Transient);
        self.spec.resources[resource].uploaded = true;
        self.touch(resource, Access::CopyTarget, Some(Contents::Overwrite), SubresourceSpec::default());
        self.end();
    }

    /// Copies a part of an existing resource.
    fn copy(&mut self) {
        let count = self.spec.resources.len();
        if count == 0 {
            return;
        }
        let source = count - 1 - self.source.below(count);
        let mut subresource = self.any_part(source);
        if let Some(desc) = self.texture_desc(source)
            && subresource.mips.map_or(desc.mip_levels, |(start, end)| end - start) != 1
        {
            subresource = SubresourceSpec { mips: Some((0, 1)), layers: None, rect: None, ..subresource };
        }
        // Depth, stencil and samples are copied as whole mips.
        if self.texture_desc(source).is_some_and(|desc| is_depth(desc.format) || desc.samples > 1) {
            subresource = SubresourceSpec { rect: None, aspect: Aspect::All, ..subresource };
        }
        if !self.is_free(source, subresource, false, false) || !self.is_defined(source, subresource) {
            return;
        }
        match *self.spec.desc(source) {
            ResourceDesc::Buffer(desc) => self.copy_bytes(source, desc, subresource),
            ResourceDesc::Texture(desc) if self.source.chance(64) => self.read_back(source, &desc),
            ResourceDesc::Texture(desc) => self.copy_texels(source, &desc, subresource),
        }
    }

    /// Copies bytes to a buffer of the same size, new or not, at the same offset.
    fn copy_bytes(&mut self, source: usize, desc: BufferDesc, subresource: SubresourceSpec) {
        let same = |r: &usize| *self.spec.desc(*r) == ResourceDesc::Buffer(desc) && *r != source;
        let known = (0..self.spec.resources.len()).find(same);
        let target = match known {
            Some(target) if self.source.chance(128) => target,
            _ => self.add_resource(ResourceDesc::Buffer(desc), Origin::Transient),
        };
        self.transfer((source, subresource), (target, subresource));
    }

    /// Copies texels to a new texture of their size, or to the same position of a texture with the same description.
    fn copy_texels(&mut self, source: usize, desc: &TextureDesc, subresource: SubresourceSpec) {
        let shape = ResourceDesc::Texture(*desc);
        let writable = |r: &usize| !matches!(self.spec.resources[*r].origin, Origin::Previous { .. });
        let same = |r: &usize| *self.spec.desc(*r) == shape && *r != source && writable(r);
        let known = (0..self.spec.resources.len()).find(same);
        if let (Some(target), true) = (known, self.source.chance(128)) {
            return self.transfer((source, subresource), (target, subresource));
        }
        let mip = subresource.mips.map_or(0, |(start, _)| start);
        let (width, height) = subresource.rect.map_or(mip_size(desc, mip), |rect| (rect.width, rect.height));
        let count = subresource.layers.map_or(layers(desc, mip), |(start, end)| end - start);
        if desc.samples > 1 && (subresource.rect.is_some() || count > 1) {
            return;
        }
        let mut copy = TextureDesc { samples: desc.samples, ..TextureDesc::d2(width, height, desc.format) };
        copy.dimension = desc.dimension;
        copy.size.depth_or_array_layers = count;
        let flat = copy.dimension != TextureDimension::D3 || subresource.layers.is_none();
        if flat {
            let target = self.add_resource(ResourceDesc::Texture(copy), Origin::Transient);
            let to = SubresourceSpec { aspect: subresource.aspect, ..SubresourceSpec::default() };
            self.transfer((source, subresource), (target, to));
        }
    }

    /// Copies mip 0 of a colour texture to a new buffer.
    fn read_back(&mut self, source: usize, desc: &TextureDesc) {
        let single = desc.size.depth_or_array_layers == 1 && desc.samples == 1;
        let mips = (desc.mip_levels > 1).then_some((0, 1));
        let subresource = SubresourceSpec { mips, ..SubresourceSpec::default() };
        if is_depth(desc.format)
            || !single
            || !self.is_free(source, subresource, false, false)
            || !self.is_defined(source, subresource)
        {
            return;
        }
        let buffer = ResourceDesc::Buffer(BufferDesc::new(256 * u64::from(desc.size.height)));
        let target = self.add_resource(buffer, Origin::Transient);
        self.transfer((source, subresource), (target, SubresourceSpec::default()));
    }

    fn transfer(&mut self, (source, from): (usize, SubresourceSpec), (target, to): (usize, SubresourceSpec)) {
        if self.is_free(target, to, true, false) && source != target {
            self.touch(source, Access::CopySource, None, from);
            self.touch(target, Access::CopyTarget, Some(Contents::Overwrite), to);
        }
    }
}
