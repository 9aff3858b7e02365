//! What is wrong with a frame, found before anything else is done with it.

use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{AccessDecl, CopyOp, Declaration, Origin, PassDecl, PassKind};
use crate::desc::ResourceDesc;
use crate::desc::{Extent, TextureDesc};
use crate::error::Error;
use crate::handle::{PassId, ResourceId};

/// Checks everything that does not depend on a device.
pub(super) fn validate(decl: &Declaration) -> Result<(), Error> {
    for resource in &decl.resources {
        if let ResourceDesc::Texture(TextureDesc { size, mip_levels, samples, .. }) = resource.desc {
            let Extent { width, height, depth_or_array_layers } = size;
            if [width, height, depth_or_array_layers, mip_levels, samples].contains(&0) {
                return Err(Error::EmptyResource { resource: resource.name.clone() });
            }
        }
    }
    let imported = |r: &Origin| *r == Origin::Imported { defined: true };
    let mut defined: Vec<bool> = decl.resources.iter().map(|r| imported(&r.origin)).collect();
    for (index, pass) in decl.passes.iter().enumerate() {
        let check = Check { decl, pass, path: &|| decl.pass_path(PassId(index as u32)) };
        check.conflicts()?;
        check.attachments()?;
        for access in &pass.accesses {
            check.access(access)?;
            check.contents(access, defined[access.resource.index()])?;
        }
        check.copies()?;
        for access in pass.accesses.iter().filter(|a| a.access.writes()) {
            defined[access.resource.index()] = true;
        }
    }
    exports(decl, &defined)
}

/// What is exported must have been written, and not again after the export.
fn exports(decl: &Declaration, defined: &[bool]) -> Result<(), Error> {
    for (resource, defined) in decl.resources.iter().zip(defined) {
        let Some(version) = resource.exported else { continue };
        if !defined {
            return Err(Error::UndefinedRead { pass: "export".into(), resource: resource.name.clone() });
        }
        if let Some(&writer) = resource.writers.get(version as usize) {
            return Err(Error::StaleRead {
                pass: "export".into(),
                resource: resource.name.clone(),
                version,
                writer: decl.pass_path(writer),
                latest: resource.version(),
            });
        }
    }
    Ok(())
}

/// One pass under examination.
struct Check<'a> {
    decl: &'a Declaration,
    pass: &'a PassDecl,
    path: &'a dyn Fn() -> String,
}

impl Check<'_> {
    fn name(&self, resource: ResourceId) -> String {
        self.decl.resource(resource).name.clone()
    }

    fn texture(&self, access: &AccessDecl) -> Option<TextureDesc> {
        match self.decl.resource(access.resource).desc {
            ResourceDesc::Texture(desc) => Some(desc),
            ResourceDesc::Buffer(_) => None,
        }
    }

    /// A resource that is written may be touched in no other way; one that is read may be read in several.
    fn conflicts(&self) -> Result<(), Error> {
        let accesses = &self.pass.accesses;
        for (index, access) in accesses.iter().enumerate() {
            let clash = |other: &&AccessDecl| {
                other.resource == access.resource && (other.access.writes() || access.access.writes())
            };
            if let Some(other) = accesses[..index].iter().find(clash) {
                return Err(Error::Conflict {
                    pass: (self.path)(),
                    resource: self.name(access.resource),
                    first: other.access.word(),
                    second: access.access.word(),
                });
            }
        }
        Ok(())
    }

    fn attachments(&self) -> Result<(), Error> {
        if self.pass.kind != PassKind::Render {
            return Ok(());
        }
        let mut attachments = self.pass.accesses.iter().filter(|a| a.access.is_attachment());
        let Some(first) = attachments.next() else {
            return Err(Error::NoAttachment { pass: (self.path)() });
        };
        let shape = |access: &AccessDecl| {
            self.texture(access).map(|d| (d.size.width, d.size.height, d.samples)).unwrap_or_default()
        };
        let words = |(width, height, samples): (u32, u32, u32)| match samples {
            1 => format!("{width}x{height}"),
            _ => format!("{width}x{height} with {samples} samples"),
        };
        match attachments.find(|other| shape(other) != shape(first)) {
            Some(other) => Err(Error::AttachmentMismatch {
                pass: (self.path)(),
                first: format!("`{}` is {}", self.name(first.resource), words(shape(first))),
                second: format!("`{}` is {}", self.name(other.resource), words(shape(other))),
            }),
            None => Ok(()),
        }
    }

    /// Format, clear value and the usages of an import.
    fn access(&self, access: &AccessDecl) -> Result<(), Error> {
        if let Some(desc) = self.texture(access) {
            let depth = desc.format.is_depth_stencil_format();
            let problem = match access.access {
                Access::Color(_) if depth => "is a depth format: use `depth`",
                Access::Color(_) if desc.format.is_compressed() => "is compressed and cannot be drawn into",
                Access::Depth | Access::DepthRead if !depth => "is not a depth format: use `color`",
                Access::StorageRead | Access::StorageWrite if depth => "cannot be a storage texture",
                _ => "",
            };
            if !problem.is_empty() {
                return Err(Error::Format {
                    pass: (self.path)(),
                    resource: self.name(access.resource),
                    access: access.access.word(),
                    format: desc.format,
                    problem,
                });
            }
        }
        self.clear(access)?;
        self.import_usage(access)
    }

    fn clear(&self, access: &AccessDecl) -> Result<(), Error> {
        let Some(Contents::Clear(value)) = access.contents else {
            return Ok(());
        };
        let problem = match (access.access, value) {
            (Access::Color(_), ClearValue::Color(_)) => return Ok(()),
            (Access::Depth, ClearValue::Depth(depth)) if (0.0..=1.0).contains(&depth) => return Ok(()),
            (Access::Depth, ClearValue::Depth(_)) => "a depth outside 0 to 1",
            (Access::Depth, ClearValue::Color(_)) => "a colour, but it is a depth attachment",
            (Access::Color(_), ClearValue::Depth(_)) => "a depth, but it is a colour attachment",
            _ => "a clear value, but only attachments can be cleared: use `Contents::Cover`",
        };
        Err(Error::Clear { pass: (self.path)(), resource: self.name(access.resource), problem })
    }

    fn import_usage(&self, access: &AccessDecl) -> Result<(), Error> {
        let resource = self.decl.resource(access.resource);
        if resource.origin == Origin::Transient {
            return Ok(());
        }
        let missing_texture = access.access.texture_usage() - resource.texture_usage;
        let missing_buffer = access.access.buffer_usage() - resource.buffer_usage;
        let needed = match resource.desc {
            ResourceDesc::Texture(_) if !missing_texture.is_empty() => format!("{missing_texture:?}"),
            ResourceDesc::Buffer(_) if !missing_buffer.is_empty() => format!("{missing_buffer:?}"),
            _ => return Ok(()),
        };
        let (pass, access) = ((self.path)(), access.access.word());
        Err(Error::ImportUsage { pass, resource: resource.name.clone(), access, needed })
    }

    fn contents(&self, access: &AccessDecl, defined: bool) -> Result<(), Error> {
        let names = || ((self.path)(), self.name(access.resource));
        match access.contents {
            None if !defined => {
                let (pass, resource) = names();
                Err(Error::UndefinedRead { pass, resource })
            }
            Some(Contents::Preserve) if !defined => {
                let (pass, resource) = names();
                Err(Error::UndefinedPreserve { pass, resource })
            }
            _ => Ok(()),
        }
    }

    fn copies(&self) -> Result<(), Error> {
        for copy in &self.pass.copies {
            let (source, target) = match *copy {
                CopyOp::TextureToTexture { source, target }
                | CopyOp::BufferToBuffer { source, target }
                | CopyOp::TextureToBuffer { source, target } => (source, target),
                CopyOp::Upload { .. } => continue,
            };
            let (from, to) = (self.decl.resource(source).desc, self.decl.resource(target).desc);
            if !copy_fits(from, to) {
                return Err(Error::CopyMismatch {
                    pass: (self.path)(),
                    from: format!("`{}` ({})", self.name(source), shape(from)),
                    to: format!("`{}` ({})", self.name(target), shape(to)),
                });
            }
        }
        Ok(())
    }
}

fn copy_fits(from: ResourceDesc, to: ResourceDesc) -> bool {
    match (from, to) {
        (ResourceDesc::Texture(from), ResourceDesc::Texture(to)) => {
            (from.size, from.format, from.samples) == (to.size, to.format, to.samples)
        }
        (ResourceDesc::Buffer(from), ResourceDesc::Buffer(to)) => from.bytes == to.bytes,
        (ResourceDesc::Texture(from), ResourceDesc::Buffer(to)) => {
            padded_bytes(from).is_some_and(|bytes| bytes <= to.bytes)
        }
        (ResourceDesc::Buffer(_), ResourceDesc::Texture(_)) => false,
    }
}

/// The bytes of mip 0 with rows padded as copies need them; `None` where a copy to a buffer is impossible.
fn padded_bytes(desc: TextureDesc) -> Option<u64> {
    let texel = u64::from(desc.format.block_copy_size(None)?);
    let row = (u64::from(desc.size.width) * texel).next_multiple_of(256);
    (desc.samples == 1 && desc.size.depth_or_array_layers == 1 && !desc.format.is_compressed())
        .then(|| row * u64::from(desc.size.height))
}

fn shape(desc: ResourceDesc) -> String {
    match desc {
        ResourceDesc::Texture(d) => format!("{}x{} {:?}", d.size.width, d.size.height, d.format),
        ResourceDesc::Buffer(d) => format!("{} bytes", d.bytes),
    }
}
