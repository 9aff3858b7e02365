//! Random render, compute and encoder passes.

use super::cells::{layers, mip_size};
use super::generate::Generator;
use super::resources::is_depth;
use super::{AccessSpec, SubresourceSpec};
use crate::{Access, ClearValue, Contents, Origin, PassKind, ResourceDesc, TextureDesc};

/// One mip of one layer, to draw into.
#[derive(Clone, Copy)]
struct Target {
    resource: usize,
    mip: u32,
    layer: u32,
}

impl Generator<'_> {
    pub(super) fn render_pass(&mut self) {
        self.begin(PassKind::Render);
        if !(self.source.chance(144) && self.draw_again()) {
            self.draw_to_new_targets();
        }
        let reads = self.source.below(4);
        (0..reads).for_each(|_| self.read());
        if self.source.chance(40) {
            self.write_storage();
        }
        self.end();
    }

    pub(super) fn compute_pass(&mut self) {
        self.begin(PassKind::Compute);
        let (reads, writes) = (self.source.below(4), self.source.below(3));
        (0..reads).for_each(|_| self.read());
        (0..writes.max(1)).for_each(|_| self.write_storage());
        self.end();
    }

    pub(super) fn encoder_pass(&mut self) {
        self.begin(PassKind::Encoder);
        for _ in 0..1 + self.source.below(4) {
            match self.source.below(8) {
                0..=2 => self.read(),
                3 | 4 => self.copy_in(),
                5 => self.write_storage(),
                _ => self.attach(),
            }
        }
        self.end();
    }

    /// Draws into the attachments of the last render pass.
    fn draw_again(&mut self) -> bool {
        let Some(last) = self.spec.passes.iter().rposition(|pass| pass.kind == PassKind::Render) else {
            return false;
        };
        for index in 0..self.spec.passes[last].accesses.len() {
            let access = self.spec.passes[last].accesses[index];
            let whole = access.subresource.without_rect();
            let size = self.part_size(access.resource, whole);
            let rect = if access.subresource.rect.is_some() || self.source.chance(64) {
                self.rect(size)
            } else {
                None
            };
            let subresource = SubresourceSpec { rect, ..whole };
            match access.access {
                Access::DepthRead if self.is_defined(access.resource, subresource) => {
                    self.touch(access.resource, Access::DepthRead, None, subresource);
                }
                Access::Color(_) | Access::Depth | Access::DepthRead => {
                    let kind = if access.access == Access::DepthRead { Access::Depth } else { access.access };
                    let contents = self.contents(access.resource, kind, subresource, 200);
                    self.touch(access.resource, kind, Some(contents), subresource);
                }
                Access::Resolve(_) if self.source.chance(128) => {
                    self.touch(access.resource, access.access, Some(Contents::Overwrite), access.subresource);
                }
                _ => {}
            }
        }
        true
    }

    fn draw_to_new_targets(&mut self) {
        let samples = if self.source.chance(40) { 4 } else { 1 };
        let size = self.size();
        let colors = self.source.below(4);
        let depth = colors == 0 || self.source.chance(80);
        for index in 0..colors {
            let target = self.target(size, samples, false);
            self.draw(target, Access::Color(index as u32));
            if samples > 1 && self.source.chance(160) {
                self.resolve(target, size, index as u32);
            }
        }
        if depth {
            let target = self.target(size, samples, true);
            self.draw(target, Access::Depth);
        }
    }

    /// Returns a texture that has a mip of this size, or a new one.
    fn target(&mut self, size: (u32, u32), samples: u32, depth: bool) -> Target {
        let count = self.spec.resources.len();
        if count > 0 && self.source.chance(144) {
            let first = self.source.below(count);
            for resource in (0..count).map(|step| (first + step) % count) {
                if let Some(target) = self.target_in(resource, size, samples, depth) {
                    return target;
                }
            }
        }
        Target { resource: self.new_texture(size, depth, samples), mip: 0, layer: 0 }
    }

    fn target_in(&mut self, resource: usize, size: (u32, u32), samples: u32, depth: bool) -> Option<Target> {
        let desc = self.texture_desc(resource)?;
        let previous = matches!(self.spec.resources[resource].origin, Origin::Previous { .. });
        if previous || desc.samples != samples || is_depth(desc.format) != depth {
            return None;
        }
        let mip = (0..desc.mip_levels).find(|&mip| mip_size(&desc, mip) == size)?;
        let layer = self.source.below(layers(&desc, mip) as usize) as u32;
        let target = Target { resource, mip, layer };
        self.is_free(resource, self.target_part(&target, &desc), true, true).then_some(target)
    }

    fn target_part(&self, target: &Target, desc: &TextureDesc) -> SubresourceSpec {
        let only = |at, count| (count > 1).then_some((at, at + 1));
        SubresourceSpec {
            mips: only(target.mip, desc.mip_levels),
            layers: only(target.layer, desc.size.depth_or_array_layers),
            ..SubresourceSpec::default()
        }
    }

    /// Attaches a target: draws into all of it or a rectangle, or only tests depth.
    fn draw(&mut self, target: Target, access: Access) {
        let Some(desc) = self.texture_desc(target.resource) else { return };
        let mut subresource = self.target_part(&target, &desc);
        subresource.aspect = self.aspect(desc.format);
        subresource.rect = self.rect(mip_size(&desc, target.mip));
        if access == Access::Depth && self.source.chance(80) && self.is_defined(target.resource, subresource)
        {
            self.touch(target.resource, Access::DepthRead, None, subresource);
            // Read-only depth may be sampled too.
            if self.source.chance(64) {
                self.touch(target.resource, Access::Sampled, None, subresource);
            }
            return;
        }
        let contents = self.contents(target.resource, access, subresource, 96);
        self.touch(target.resource, access, Some(contents), subresource);
    }

    fn resolve(&mut self, from: Target, size: (u32, u32), index: u32) {
        let Some(desc) = self.texture_desc(from.resource) else { return };
        let target = self.target(size, 1, false);
        let Some(own) = self.texture_desc(target.resource) else { return };
        if own.format == desc.format {
            let subresource = self.target_part(&target, &own);
            self.touch(target.resource, Access::Resolve(index), Some(Contents::Overwrite), subresource);
        }
    }

    /// Returns the contents of an attachment: preserved in `preserve` of 256 cases, if it can be.
    fn contents(
        &mut self,
        resource: usize,
        access: Access,
        subresource: SubresourceSpec,
        preserve: usize,
    ) -> Contents {
        if self.source.chance(preserve) && self.is_defined(resource, subresource) {
            return Contents::Preserve;
        }
        if self.source.chance(96) {
            return Contents::Overwrite;
        }
        Contents::Clear(match (access, self.source.below(4)) {
            (Access::Color(_), value @ 0..=2) => ClearValue::Color([value as f64; 4]),
            (Access::Color(_), _) => ClearValue::Color([0.0, 0.5, 0.25, 1.0]),
            (_, 0 | 1) => ClearValue::Depth(0.0),
            (_, 2) => ClearValue::Depth(1.0),
            (_, _) => ClearValue::DepthStencil(0.0, self.source.below(3) as u32),
        })
    }

    fn part_size(&self, resource: usize, subresource: SubresourceSpec) -> (u32, u32) {
        let mip = subresource.mips.map_or(0, |(start, _)| start);
        self.texture_desc(resource).map_or((1, 1), |desc| mip_size(&desc, mip))
    }

    /// Reads an existing resource, most often a recent one.
    fn read(&mut self) {
        let count = self.spec.resources.len();
        for _ in 0..4 {
            if count == 0 {
                return;
            }
            let back = self.source.below(count).min(self.source.below(count));
            let resource = count - 1 - back;
            let subresource =
                if self.source.chance(96) { self.any_part(resource) } else { SubresourceSpec::default() };
            if self.is_free(resource, subresource, false, false) && self.is_defined(resource, subresource) {
                let access = self.read_access(resource);
                return self.touch(resource, access, None, subresource);
            }
        }
    }

    fn read_access(&mut self, resource: usize) -> Access {
        let (kind, desc) = (self.pass.kind, *self.spec.desc(resource));
        let choice = self.source.below(8);
        match desc {
            ResourceDesc::Buffer(_) => match (kind, choice) {
                (PassKind::Encoder, 0..=2) => Access::CopySource,
                (PassKind::Render, 0..=1) => Access::Vertex,
                (PassKind::Render, 2..=3) => Access::Index,
                (_, 4) => Access::Indirect,
                (_, 5) => Access::Uniform,
                _ => Access::StorageRead,
            },
            ResourceDesc::Texture(desc) => match (kind, choice) {
                (PassKind::Encoder, 0..=2) => Access::CopySource,
                (_, 7) if self.stores(&desc) => Access::StorageRead,
                _ => Access::Sampled,
            },
        }
    }

    fn stores(&self, desc: &TextureDesc) -> bool {
        !is_depth(desc.format) && desc.samples == 1
    }

    /// Returns a resource to write other than by drawing: a texture, a buffer, or a new one.
    fn written(&mut self, fits: impl Fn(&Self, usize) -> bool) -> usize {
        let count = self.spec.resources.len();
        if count > 0 && self.source.chance(128) {
            let first = self.source.below(count);
            let previous = |r: usize| matches!(self.spec.resources[r].origin, Origin::Previous { .. });
            let found =
                (0..count).map(|step| (first + step) % count).find(|&r| !previous(r) && fits(self, r));
            if let Some(resource) = found {
                return resource;
            }
        }
        if self.source.chance(128) {
            return self.new_buffer();
        }
        let size = self.size();
        self.new_texture(size, false, 1)
    }

    fn write_storage(&mut self) {
        let fits = |own: &Self, r: usize| own.texture_desc(r).is_none_or(|desc| own.stores(&desc));
        let resource = self.written(fits);
        self.write(resource, Access::StorageWrite);
    }

    fn copy_in(&mut self) {
        let resource = self.written(|_, _| true);
        self.write(resource, Access::CopyTarget);
    }

    /// Overwrites or preserves a part of a resource.
    fn write(&mut self, resource: usize, access: Access) {
        let subresource =
            if self.source.chance(112) { self.any_part(resource) } else { SubresourceSpec::default() };
        if !self.is_free(resource, subresource, true, false) {
            return;
        }
        let preserves = self.source.chance(96) && self.is_defined(resource, subresource);
        let contents = if preserves { Contents::Preserve } else { Contents::Overwrite };
        self.touch(resource, access, Some(contents), subresource);
    }

    /// Returns the mip and layer that the pass has used last.
    fn last_target(&self, last: AccessSpec) -> Option<Target> {
        let desc = self.texture_desc(last.resource)?;
        let previous = matches!(self.spec.resources[last.resource].origin, Origin::Previous { .. });
        let first = |range: Option<(u32, u32)>| range.map_or(0, |(start, _)| start);
        let (mip, layer) = (first(last.subresource.mips), first(last.subresource.layers));
        let drawable = !previous && !is_depth(desc.format) && desc.samples == 1;
        drawable.then_some(Target { resource: last.resource, mip, layer })
    }

    /// An attachment of a render pass that the encoder pass begins itself.
    fn attach(&mut self) {
        let size = self.size();
        let target = match self.pass.accesses.last().copied() {
            Some(last) if self.source.chance(96) => self.last_target(last),
            _ => Some(self.target(size, 1, false)),
        };
        let Some(target) = target else { return };
        let Some(desc) = self.texture_desc(target.resource) else { return };
        let mut subresource = self.target_part(&target, &desc);
        subresource.rect = self.rect(mip_size(&desc, target.mip));
        if self.is_free(target.resource, subresource, true, true) {
            let contents = self.contents(target.resource, Access::Color(0), subresource, 96);
            self.touch(target.resource, Access::Color(0), Some(contents), subresource);
        }
    }
}
