//! Checks of a pass: conflicting accesses, attachments that do not match, copies between incompatible resources.

use crate::access::Access;
use crate::declaration::{AccessDecl, CopyOp, Declaration, PassKind};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::PassId;
use crate::pass_name::PassName;
use crate::subresource::{Aspect, Region, Subresource};
use wgpu_types::{Extent3d, TextureDimension};

/// Checks a pass; `seen` holds for each resource the last pass that accessed it.
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
    fn pass(&self) -> PassName {
        self.decl.pass_name(self.id)
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

    /// A pass may not use in another way what it writes. Within one pass wgpu tracks mips and layers, but not tiles or
    /// bytes, and slices of a volume only as attachments; between copies and commands of a raw encoder it orders
    /// everything itself.
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
                pass: self.pass(),
                resource: self.name(access),
                first: self.describe(other),
                second: self.describe(access),
            }),
        }
    }

    /// Describes the access and its subresource: `color (mip 1)`.
    fn describe(&self, access: &AccessDecl) -> String {
        let (name, subresource) = (access.access.as_str(), self.decl.subresource(access));
        if subresource == Subresource::FULL { name.into() } else { format!("{name} ({subresource})") }
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
                return Err(Error::SecondDepth { pass: self.pass(), first, second });
            }
            match first {
                None => first = Some((access, size, desc.samples)),
                Some((other, own, samples)) if (own, samples) != (size, desc.samples) => {
                    return Err(Error::AttachmentMismatch {
                        pass: self.pass(),
                        first: format!("`{}` is {}", self.name(other), format_size(own, samples)),
                        second: format!("`{}` is {}", self.name(access), format_size(size, desc.samples)),
                    });
                }
                Some(_) => {}
            }
        }
        if first.is_none() { Err(Error::NoAttachment { pass: self.pass() }) } else { Ok(()) }
    }

    /// Returns the size of the attached mip.
    fn attachment_size(&self, access: &AccessDecl, desc: &TextureDesc) -> Result<Extent3d, Error> {
        let subresource = self.decl.subresource(access);
        let (mip, mip_end) = subresource.mips.unwrap_or((0, desc.mip_levels));
        let (layer, layer_end) = subresource.layers.unwrap_or((0, desc.size.depth_or_array_layers));
        if mip_end - mip != 1 || layer_end - layer != 1 {
            let (pass, resource, subresource) = (self.pass(), self.name(access), subresource.to_string());
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
            None => "no colour attachment is declared before it; declare `color` first".into(),
            Some((source, from)) if from.samples == 1 => {
                format!(
                    "`{}` has one sample, so there is nothing to resolve; give it 4 samples, or remove the resolve",
                    self.name(source)
                )
            }
            Some(_) if desc.samples != 1 => "it is multisampled; give it one sample".into(),
            Some(_) if self.decl.subresource(access).rect.is_some() => {
                "a resolve writes a whole mip; remove the rectangle".into()
            }
            Some((source, from)) => {
                let from_size = self.attachment_size(source, &from)?;
                if (from.format, from_size) == (desc.format, size) {
                    return Ok(());
                }
                format!(
                    "it is {} {:?} and `{}` is {} {:?}; give them the same size and format",
                    format_size(size, 1),
                    desc.format,
                    self.name(source),
                    format_size(from_size, 1),
                    from.format
                )
            }
        };
        Err(Error::Resolve { pass: self.pass(), resource: self.name(access), problem })
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
        let same_subresource = source.resource == target.resource
            && self.region(source).subresources().overlaps(&self.region(target).subresources());
        let problem = match (same_subresource, fits(&from, &to)) {
            (false, true) => return Ok(()),
            (true, _) => "source and target overlap; copy to another mip, layer or texture".into(),
            (false, false) => copy_problem(&from, &to),
        };
        let describe = |access: &AccessDecl, end: &End| {
            let subresource = if end.subresource == Subresource::FULL {
                String::new()
            } else {
                format!("{} of ", end.subresource)
            };
            format!("{subresource}`{}` ({})", self.name(access), end.describe())
        };
        Err(Error::CopyMismatch {
            pass: self.pass(),
            from: describe(source, &from),
            to: describe(target, &to),
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

    fn describe(&self) -> String {
        match self.desc {
            ResourceDesc::Texture(desc) => match copy_extent(&self.subresource, &desc) {
                Some(size) => format!("{} {:?}", format_size(size, desc.samples), desc.format),
                None => "several mips".into(),
            },
            ResourceDesc::Buffer(desc) => {
                let (start, end) = self.subresource.bytes.unwrap_or((0, desc.bytes));
                format!("{} bytes from {start}", end - start)
            }
        }
    }
}

/// Returns the size of what a subresource selects of one mip; `None` if it selects several.
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

/// Returns whether this part of a texture can be copied: depth, stencil and multisampled textures are copied only as whole
/// mips and layers.
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
            // Bytes are copied, so sRGB encoding may differ.
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

/// Describes why two ends of a copy do not match, and a fix.
fn copy_problem(from: &End, to: &End) -> String {
    match (from.desc, to.desc) {
        (ResourceDesc::Texture(a), ResourceDesc::Texture(b))
            if !(copies_in_part(&from.subresource, &a) && copies_in_part(&to.subresource, &b)) =>
        {
            "depth, stencil and multisampled textures are copied only as whole mips with all aspects; draw the region instead"
                .into()
        }
        (ResourceDesc::Texture(_), ResourceDesc::Texture(_)) => {
            "size, samples and format (except sRGB) must match; narrow both to the same size with `texture_region`"
                .into()
        }
        (ResourceDesc::Texture(desc), _) => match padded_bytes(&from.subresource, desc) {
            Some(bytes) => {
                format!("with rows padded to 256 bytes it needs {bytes} bytes; make the buffer that large")
            }
            None => {
                "only one layer of an uncompressed format with one sample can be copied to a buffer; draw or resolve it into \
                 such a texture first"
                    .into()
            }
        },
        (ResourceDesc::Buffer(_), _) => {
            "both ranges must have the same size and begin and end at multiples of 4; narrow them with \
             `buffer_range`"
                .into()
        }
    }
}

/// Returns the bytes of one mip with rows padded for a copy; `None` if a copy to a buffer is impossible.
fn padded_bytes(subresource: &Subresource, desc: TextureDesc) -> Option<u64> {
    let texel = u64::from(desc.format.block_copy_size(None)?);
    let size = copy_extent(subresource, &desc)?;
    let row = (u64::from(size.width) * texel).next_multiple_of(256);
    (desc.samples == 1 && size.depth_or_array_layers == 1 && !desc.format.is_compressed())
        .then(|| row * u64::from(size.height))
}

fn format_size(size: Extent3d, samples: u32) -> String {
    let Extent3d { width, height, depth_or_array_layers } = size;
    let mut out = format!("{width}x{height}");
    if depth_or_array_layers > 1 {
        out += &format!("x{depth_or_array_layers}");
    }
    if samples > 1 {
        out += &format!(" with {samples} samples");
    }
    out
}
