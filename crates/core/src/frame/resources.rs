//! Resources of a frame: creation, upload, import, export, lookup.

use super::Frame;
use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{CopyOp, NoteDecl, NoteSubject, Origin, PassKind, ResourceDecl};
use crate::desc::{BufferDesc, Format, ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::{Buffer, BufferExport, ResourceId, Texture, TextureExport, Uniform, Version};
use crate::name::Name;
use std::borrow::Cow;
use wgpu_types::{BufferUsages, TextureUsages};

/// Alignment of uniform blocks: the strictest `min_uniform_buffer_offset_alignment`.
const UNIFORM_ALIGNMENT: usize = 256;

impl<'f> Frame<'f> {
    /// Creates a texture that lives within this frame. Its contents are undefined until a pass writes them.
    pub fn create_texture(&mut self, name: impl Name, desc: TextureDesc) -> Texture {
        Texture(self.add_resource(name, ResourceDesc::Texture(desc), Origin::Transient))
    }

    /// Creates a buffer that lives within this frame. Its contents are undefined until a pass writes them.
    pub fn create_buffer(&mut self, name: impl Name, desc: BufferDesc) -> Buffer {
        Buffer(self.add_resource(name, ResourceDesc::Buffer(desc), Origin::Transient))
    }

    /// Creates a buffer that holds `bytes` when the first pass reads it; a copy pass uploads them.
    ///
    /// ```
    /// let mut frame = shadowgraph_core::Frame::new();
    /// let numbers = [1u8, 2, 3, 4];
    /// let buffer = frame.upload_buffer("numbers", &numbers[..]);
    /// let mut pass = frame.compute_pass("sum");
    /// pass.storage_buffer(&buffer);
    /// pass.keep();
    /// assert_eq!(frame.compile()?.plan().order().len(), 2);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    #[track_caller]
    pub fn upload_buffer(&mut self, name: impl Name, bytes: impl Into<Cow<'f, [u8]>>) -> Buffer {
        let bytes = bytes.into();
        let mut buffer = self.create_buffer(&name, BufferDesc::new(bytes.len() as u64));
        let upload = self.work.uploads.len() as u32;
        self.work.uploads.push(bytes);
        let pass = self.add_pass(UploadName(&name), PassKind::Copy);
        self.declare_write(pass, &mut buffer.0, Access::CopyTarget, Contents::Overwrite, &mut None);
        self.add_copy(pass, CopyOp::Upload { target: buffer.id(), upload });
        buffer
    }

    /// Adds a uniform block (or a small read-only storage block) to the frame's uniform buffer, for
    /// `Bind::Uniform`. All blocks of a frame are uploaded by one copy.
    ///
    /// ```
    /// let mut frame = shadowgraph_core::Frame::new();
    /// let time = frame.uniform(&1.5f32.to_le_bytes());
    /// assert_eq!(time.size_bytes(), 4);
    /// ```
    pub fn uniform(&mut self, bytes: &[u8]) -> Uniform {
        let uniforms = &mut self.work.uniforms;
        let start = uniforms.len().next_multiple_of(UNIFORM_ALIGNMENT);
        uniforms.resize(start, 0);
        uniforms.extend_from_slice(bytes);
        Uniform { frame: self.id, start: start as u32, size: bytes.len() as u32 }
    }

    /// Declares a texture that belongs to the caller, created with `usage`; `defined` says whether it has
    /// contents when the frame begins. Passes that write an import are not culled.
    ///
    /// This is only the declaration; with a device use `Frame::import_texture`.
    pub fn declare_import_texture(
        &mut self,
        name: impl Name,
        desc: TextureDesc,
        usage: TextureUsages,
        defined: bool,
    ) -> Texture {
        let version = self.add_resource(name, ResourceDesc::Texture(desc), Origin::Imported { defined });
        self.decl.resources[version.resource.index()].texture_usage = usage;
        Texture(version)
    }

    /// Declares a buffer that belongs to the caller, created with `usage`. See
    /// [`declare_import_texture`](Self::declare_import_texture).
    pub fn declare_import_buffer(
        &mut self,
        name: impl Name,
        desc: BufferDesc,
        usage: BufferUsages,
        defined: bool,
    ) -> Buffer {
        let version = self.add_resource(name, ResourceDesc::Buffer(desc), Origin::Imported { defined });
        self.decl.resources[version.resource.index()].buffer_usage = usage;
        Buffer(version)
    }

    /// Adds a sentence to what plans say about a texture, such as why its contents were kept.
    ///
    /// ```
    /// use shadowgraph_core::{Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let map = frame.create_texture("map", TextureDesc::d2(64, 64, Format::Depth32Float));
    /// frame.note(&map, "kept: nothing moved");
    /// let compiled = frame.compile()?;
    /// assert!(compiled.plan().resource_notes(map.id()).eq(["kept: nothing moved"]));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn note(&mut self, texture: &Texture, text: impl Name) {
        self.add_note(NoteSubject::Resource(texture.0.resource), text);
    }

    pub(crate) fn add_note(&mut self, subject: NoteSubject, text: impl Name) {
        let text = self.decl.names.push(text);
        self.decl.notes.push(NoteDecl { subject, text });
    }

    /// Keeps the texture's current contents until the end of the frame, where the executed frame returns them. A later
    /// write to it is an error.
    pub fn export_texture(&mut self, texture: &Texture) -> TextureExport {
        self.export(texture.0, TextureUsages::COPY_SRC, BufferUsages::empty());
        TextureExport(texture.0)
    }

    /// Keeps the buffer's current contents until the end of the frame, where the executed frame returns them. A later
    /// write to it is an error.
    pub fn export_buffer(&mut self, buffer: &Buffer) -> BufferExport {
        self.export(buffer.0, TextureUsages::empty(), BufferUsages::COPY_SRC);
        BufferExport(buffer.0)
    }

    /// Returns `texture`, or if it is `None` a placeholder: a texture of one texel cleared to `value`, so that a node with
    /// an optional input can always bind one. The clear is culled if nothing reads it.
    ///
    /// ```
    /// use shadowgraph_core::{ClearValue, Format, Frame};
    /// let mut frame = Frame::new();
    /// let white = ClearValue::Color([1.0; 4]);
    /// let occlusion = frame.or_placeholder(None, Format::R8Unorm, white);
    /// assert_eq!(frame.texture_desc(&occlusion).map(|desc| desc.size.width), Some(1));
    /// ```
    #[track_caller]
    pub fn or_placeholder(
        &mut self,
        texture: Option<&Texture>,
        format: Format,
        value: ClearValue,
    ) -> Texture {
        if let Some(texture) = texture {
            return texture.clone();
        }
        let mut placeholder =
            self.create_texture(format_args!("placeholder {format:?}"), TextureDesc::d2(1, 1, format));
        let mut pass = self.render_pass(format_args!("placeholder {format:?}"));
        match value {
            ClearValue::Color(_) => pass.color(&mut placeholder, Contents::Clear(value)),
            ClearValue::Depth(_) | ClearValue::DepthStencil(..) => {
                pass.depth(&mut placeholder, Contents::Clear(value))
            }
        };
        placeholder
    }

    /// Returns the newest version of the last texture declared as `name`, if there is one.
    pub fn find_texture(&self, name: &str) -> Option<Texture> {
        let index = self.decl.resources.iter().rposition(|r| {
            matches!(r.desc, ResourceDesc::Texture(_)) && self.decl.names.get(r.name) == name
        })?;
        let version = self.decl.resources[index].version;
        Some(Texture(Version { frame: self.id, resource: ResourceId(index as u32), version }))
    }

    /// Returns the names of all textures declared so far.
    pub fn texture_names(&self) -> impl Iterator<Item = &str> {
        let textures = self.decl.resources.iter().filter(|r| matches!(r.desc, ResourceDesc::Texture(_)));
        textures.map(|r| self.decl.names.get(r.name))
    }

    /// Returns the description of a texture of this frame; `None` for a handle of another frame.
    pub fn texture_desc(&self, texture: &Texture) -> Option<TextureDesc> {
        match self.desc(texture.0)? {
            ResourceDesc::Texture(desc) => Some(desc),
            ResourceDesc::Buffer(_) => None,
        }
    }

    /// Returns the description of a buffer of this frame; `None` for a handle of another frame.
    pub fn buffer_desc(&self, buffer: &Buffer) -> Option<BufferDesc> {
        match self.desc(buffer.0)? {
            ResourceDesc::Buffer(desc) => Some(desc),
            ResourceDesc::Texture(_) => None,
        }
    }

    fn desc(&self, version: Version) -> Option<ResourceDesc> {
        (version.frame == self.id).then(|| self.decl.resource(version.resource).desc)
    }

    pub(super) fn add_resource(&mut self, name: impl Name, desc: ResourceDesc, origin: Origin) -> Version {
        let resource = ResourceId(self.decl.resources.len() as u32);
        let name = self.decl.names.push(name);
        self.decl.resources.push(ResourceDecl {
            name,
            node: self.node,
            desc,
            origin,
            version: 0,
            exported: None,
            has_partial_accesses: false,
            texture_usage: TextureUsages::empty(),
            buffer_usage: BufferUsages::empty(),
        });
        #[cfg(feature = "gpu")]
        self.work.imports.push(None);
        Version { frame: self.id, resource, version: 0 }
    }

    pub(crate) fn add_copy(&mut self, pass: crate::PassId, op: CopyOp) {
        self.decl.copies.push(op);
        self.decl.passes[pass.index()].copies.1 = self.decl.copies.len() as u32;
    }

    pub(crate) fn export(&mut self, version: Version, texture: TextureUsages, buffer: BufferUsages) {
        if version.frame != self.id {
            self.errors.push(Error::ForeignHandle { location: "an export".into() });
            return;
        }
        if self.is_stale(version) {
            let error = self.stale_read("the export".into(), version);
            self.errors.push(error);
            return;
        }
        let resource = &mut self.decl.resources[version.resource.index()];
        resource.exported = Some(version.version);
        // The owner of an import decides its usages.
        if resource.origin == Origin::Transient {
            resource.texture_usage |= texture;
            resource.buffer_usage |= buffer;
        }
    }
}

/// The name of the pass that uploads a buffer.
struct UploadName<N>(N);

impl<N: Name> Name for UploadName<N> {
    fn write_to(&self, text: &mut String) {
        text.push_str("upload ");
        self.0.write_to(text);
    }
}
