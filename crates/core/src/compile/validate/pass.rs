//! One pass: accesses that exclude each other, attachments that do not go together, copies that do not fit.

use crate::access::Access;
use crate::declaration::{AccessDecl, CopyOp, Declaration, PassKind};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::PassId;
use crate::subresource::{Aspect, Region, Subresource};
use wgpu_types::{Extent3d, TextureDimension};

/// Checks a pass; `seen` holds, for each resource, the pass that touched it last.
pub(super) fn check(decl: &Declaration, id: PassId, seen: &mut [u32]) -> Result<(), Error> {
    let check = Check { decl, id };
    for (index, access) in decl.accesses(id).iter().enumerate() {
        let seen = &mut seen[access.resource.index()];
        if *seen == id.0 {
            check.conflicts(index)?;
        }
        *seen = id.0;
    }
    match decl.pass(id).kind {
        PassKind::Render => check.attachments(),
        PassKind::Copy => check.copies(),
        PassKind::Compute | PassKind::Encoder => Ok(()),
    }
}

struct Check<'d> {
    decl: &'d Declaration,
    id: PassId,
}

impl<'d> Check<'d> {
    fn path(&self) -> String {
        self.decl.pass_path(self.id)
    }

    fn name(&self, access: &AccessDecl) -> String {
        self.decl.resource_path(access.resource)
    }

    fn texture(&self, access: &AccessDecl) -> Option<TextureDesc> {
        match self.decl.resource(access.resource).desc {
            ResourceDesc::Texture(desc) => Some(desc),
            ResourceDesc::Buffer(_) => None,
        }
    }

    fn region(&self, access: &AccessDecl) -> Region {
        self.decl.region(access).copied().unwrap_or(Region::ALL)
    }

    /// What is written may be touched in no other way. Within one pass wgpu tells mips and layers apart, but no
    /// tiles and no bytes, and slices of a volume only as attachments; between copies and commands of a raw encoder
    /// it orders everything itself.
    fn conflicts(&self, index: usize) -> Result<(), Error> {
        let accesses = self.decl.accesses(self.id);
        let access = &accesses[index];
        let ordered = matches!(self.decl.pass(self.id).kind, PassKind::Copy | PassKind::Encoder);
        let texture = self.texture(access);
        let extent = |access: &AccessDecl| match (ordered, texture) {
            (true, _) => self.region(access),
            (false, Some(_)) => self.region(access).subresources(),
            (false, None) => Region::ALL,
        };
        let volume = !ordered && texture.is_some_and(|desc| desc.dimension == TextureDimension::D3);
        let overlap = |other: &AccessDecl| {
            let slices = !volume || other.access.is_attachment() && access.access.is_attachment();
            let (other, own) = (extent(other), extent(access));
            if slices { other.overlaps(&own) } else { other.all_layers().overlaps(&own.all_layers()) }
        };
        let clash = |other: &&AccessDecl| {
            other.resource == access.resource
                && (other.contents.writes() || access.contents.writes())
                && overlap(other)
        };
        match accesses[..index].iter().find(clash) {
            None => Ok(()),
            Some(other) => Err(Error::Conflict {
                pass: self.path(),
                resource: self.name(access),
                first: self.touch(other),
                second: self.touch(access),
            }),
        }
    }

    /// The access in words, with its part: `color (mip 1)`.
    fn touch(&self, access: &AccessDecl) -> String {
        let (word, subresource) = (access.access.as_str(), self.decl.subresource(access));
        if subresource == Subresource::FULL {
            word.into()
        } else {
            format!("{word} ({})", subresource.to_string())
        }
    }

    fn attachments(&self) -> Result<(), Error> {
        let mut first: Option<(&AccessDecl, Extent3d, u32)> = None;
        let mut depth: Option<&AccessDecl> = None;
        for access in self.decl.accesses(self.id).iter().filter(|a| a.access.is_attachment()) {
            let Some(desc) = self.texture(access) else { continue };
            let size = self.attachment_size(access, &desc)?;
            if let Access::Resolve(color) = access.access {
                self.resolve(access, color, &desc, size)?;
                continue;
            }
            if matches!(access.access, Access::Depth | Access::DepthRead)
                && let Some(first) = depth.replace(access)
            {
                let (first, second) = (self.name(first), self.name(access));
                return Err(Error::SecondDepth { pass: self.path(), first, second });
            }
            match first {
                None => first = Some((access, size, desc.samples)),
                Some((other, own, samples)) if (own, samples) != (size, desc.samples) => {
                    return Err(Error::AttachmentMismatch {
                        pass: self.path(),
                        first: format!("`{}` is {}", self.name(other), words(own, samples)),
                        second: format!("`{}` is {}", self.name(access), words(size, desc.samples)),
                    });
                }
                Some(_) => {}
            }
        }
        if first.is_none() { Err(Error::NoAttachment { pass: self.path() }) } else { Ok(()) }
    }

    /// The size of the mip that is attached.
    fn attachment_size(&self, access: &AccessDecl, desc: &TextureDesc) -> Result<Extent3d, Error> {
        let subresource = self.decl.subresource(access);
        let (mip, mip_end) = subresource.mips.unwrap_or((0, desc.mip_levels));
        let (layer, layer_end) = subresource.layers.unwrap_or((0, desc.size.depth_or_array_layers));
        if mip_end - mip != 1 || layer_end - layer != 1 {
            let (pass, resource, subresource) = (self.path(), self.name(access), subresource.to_string());
            return Err(Error::AttachmentSubresource { pass, resource, subresource });
        }
        let size = desc.size.mip_level_size(mip, desc.dimension);
        Ok(Extent3d { depth_or_array_layers: 1, ..size })
    }

    fn resolve(
        &self,
        access: &AccessDecl,
        color: u32,
        desc: &TextureDesc,
        size: Extent3d,
    ) -> Result<(), Error> {
        let source = self.decl.accesses(self.id).iter().find(|a| a.access == Access::Color(color));
        let problem = match source.and_then(|source| Some((source, self.texture(source)?))) {
            None => "no colour attachment is declared before it: declare `color` first".into(),
            Some((source, from)) if from.samples == 1 => {
                format!(
                    "`{}` has one sample, so there is nothing to resolve: give it 4, or leave the resolve out",
                    self.name(source)
                )
            }
            Some(_) if desc.samples != 1 => "it is multisampled itself: give it one sample".into(),
            Some(_) if self.decl.subresource(access).rect.is_some() => {
                "a resolve writes all of a mip: take the rectangle away".into()
            }
            Some((source, from)) => {
                let from_size = self.attachment_size(source, &from)?;
                if (from.format, from_size) == (desc.format, size) {
                    return Ok(());
                }
                format!(
                    "it is {} {:?} and `{}` is {} {:?}: give them the same size and format",
                    words(size, 1),
                    desc.format,
                    self.name(source),
                    words(from_size, 1),
                    from.format
                )
            }
        };
        Err(Error::Resolve { pass: self.path(), resource: self.name(access), problem })
    }

    fn copies(&self) -> Result<(), Error> {
        // Uploads declare one access, other copies two.
        let mut accesses = self.decl.accesses(self.id).iter();
        for copy in self.decl.copies(self.id) {
            if let CopyOp::Upload { .. } = copy {
                accesses.next();
                continue;
            }
            if let (Some(source), Some(target)) = (accesses.next(), accesses.next()) {
                self.copy(source, target)?;
            }
        }
        Ok(())
    }

    fn copy(&self, source: &AccessDecl, target: &AccessDecl) -> Result<(), Error> {
        let end = |access: &AccessDecl| End::new(self.decl, access);
        let (from, to) = (end(source), end(target));
        let same_place = source.resource == target.resource
            && self.region(source).subresources().overlaps(&self.region(target).subresources());
        let problem = match (same_place, fits(&from, &to)) {
            (false, true) => return Ok(()),
            (true, _) => "they are in one place: copy to another mip, layer or texture".into(),
            (false, false) => misfit(&from, &to),
        };
        let words = |access: &AccessDecl, end: &End| {
            let subresource = if end.subresource == Subresource::FULL {
                String::new()
            } else {
                format!("{} of ", end.subresource.to_string())
            };
            format!("{subresource}`{}` ({})", self.name(access), end.words())
        };
        Err(Error::CopyMismatch {
            pass: self.path(),
            from: words(source, &from),
            to: words(target, &to),
            problem,
        })
    }
}

/// One end of a copy.
struct End {
    subresource: Subresource,
    desc: ResourceDesc,
}

impl End {
    fn new(decl: &Declaration, access: &AccessDecl) -> Self {
        Self { subresource: decl.subresource(access), desc: decl.resource(access.resource).desc }
    }

    fn words(&self) -> String {
        match self.desc {
            ResourceDesc::Texture(desc) => match copy_extent(&self.subresource, &desc) {
                Some(size) => format!("{} {:?}", words(size, desc.samples), desc.format),
                None => "several mips".into(),
            },
            ResourceDesc::Buffer(desc) => {
                let (start, end) = self.subresource.bytes.unwrap_or((0, desc.bytes));
                format!("{} bytes from {start}", end - start)
            }
        }
    }
}

/// The size of what a part selects of one mip; `None` if it selects several.
pub(crate) fn copy_extent(subresource: &Subresource, desc: &TextureDesc) -> Option<Extent3d> {
    let (mip, end) = subresource.mips.unwrap_or((0, desc.mip_levels));
    let mut size = desc.size.mip_level_size(mip, desc.dimension);
    if desc.dimension != TextureDimension::D3 {
        size.depth_or_array_layers = desc.size.depth_or_array_layers;
    }
    if let Some((start, end)) = subresource.layers {
        size.depth_or_array_layers = end - start;
    }
    if let Some(rect) = subresource.rect {
        (size.width, size.height) = (rect.width, rect.height);
    }
    (end - mip == 1).then_some(size)
}

/// Whether this part of a texture can be copied: of depth, stencil and several samples, mips and layers only go as a
/// whole.
fn copies_in_part(subresource: &Subresource, desc: &TextureDesc) -> bool {
    let whole =
        copy_extent(&Subresource { rect: None, ..*subresource }, desc) == copy_extent(subresource, desc);
    let aspects = subresource.aspect == Aspect::All || !desc.format.is_combined_depth_stencil_format();
    aspects && (whole || !desc.format.is_depth_stencil_format() && desc.samples == 1)
}

fn fits(from: &End, to: &End) -> bool {
    match (from.desc, to.desc) {
        (ResourceDesc::Texture(a), ResourceDesc::Texture(b)) => {
            let (size, other) = (copy_extent(&from.subresource, &a), copy_extent(&to.subresource, &b));
            let whole = copies_in_part(&from.subresource, &a) && copies_in_part(&to.subresource, &b);
            // Bytes are copied, so what they stand for need not be the same.
            let shape = |desc: &TextureDesc| (desc.format.remove_srgb_suffix(), desc.samples);
            size.is_some() && size == other && shape(&a) == shape(&b) && whole
        }
        (ResourceDesc::Buffer(a), ResourceDesc::Buffer(b)) => {
            let range = |subresource: &Subresource, bytes| subresource.bytes.unwrap_or((0, bytes));
            let ((start, end), (to_start, to_end)) =
                (range(&from.subresource, a.bytes), range(&to.subresource, b.bytes));
            end - start == to_end - to_start && [start, end, to_start].iter().all(|at| at % 4 == 0)
        }
        (ResourceDesc::Texture(a), ResourceDesc::Buffer(b)) => {
            padded_bytes(&from.subresource, a).is_some_and(|bytes| bytes <= b.bytes)
        }
        (ResourceDesc::Buffer(_), ResourceDesc::Texture(_)) => false,
    }
}

/// Why two ends of a copy do not fit, and what would.
fn misfit(from: &End, to: &End) -> String {
    match (from.desc, to.desc) {
        (ResourceDesc::Texture(a), ResourceDesc::Texture(b))
            if !(copies_in_part(&from.subresource, &a) && copies_in_part(&to.subresource, &b)) =>
        {
            "depth, stencil and several samples are copied only as whole mips with all aspects: draw the part instead"
                .into()
        }
        (ResourceDesc::Texture(_), ResourceDesc::Texture(_)) => {
            "size, samples and format (but for sRGB) must agree: narrow both to parts of one size with `texture_region`"
                .into()
        }
        (ResourceDesc::Texture(desc), _) => match padded_bytes(&from.subresource, desc) {
            Some(bytes) => {
                format!("with rows padded to 256 bytes it needs {bytes} bytes: give the buffer as many")
            }
            None => {
                "only one layer of a plain format with one sample can be: draw or resolve it into such a \
                     texture first"
                    .into()
            }
        },
        (ResourceDesc::Buffer(_), _) => {
            "both ranges must have as many bytes and begin and end at multiples of 4: narrow them with \
             `buffer_range`"
                .into()
        }
    }
}

/// The bytes of one mip with rows padded as copies need them; `None` where a copy to a buffer is impossible.
fn padded_bytes(subresource: &Subresource, desc: TextureDesc) -> Option<u64> {
    let texel = u64::from(desc.format.block_copy_size(None)?);
    let size = copy_extent(subresource, &desc)?;
    let row = (u64::from(size.width) * texel).next_multiple_of(256);
    (desc.samples == 1 && size.depth_or_array_layers == 1 && !desc.format.is_compressed())
        .then(|| row * u64::from(size.height))
}

fn words(size: Extent3d, samples: u32) -> String {
    let Extent3d { width, height, depth_or_array_layers } = size;
    let mut words = format!("{width}x{height}");
    if depth_or_array_layers > 1 {
        words += &format!("x{depth_or_array_layers}");
    }
    if samples > 1 {
        words += &format!(" with {samples} samples");
    }
    words
}
