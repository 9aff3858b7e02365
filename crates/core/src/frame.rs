//! A frame being declared.

use crate::access::{Access, Contents};
use crate::builder::{Compute, Copying, Encoding, Pass, Rendering};
use crate::compile;
use crate::compiled::Compiled;
use crate::declaration::{
    AccessDecl, CopyOp, Declaration, NodeDecl, Origin, PassDecl, PassKind, ResourceDecl,
};
use crate::desc::ResourceDesc;
use crate::desc::{BufferDesc, TextureDesc};
use crate::error::Error;
#[cfg(feature = "gpu")]
use crate::execute::{Body, Imported};
use crate::handle::{
    Buffer, BufferExport, NodeId, PassId, ResourceId, Texture, TextureExport, Token, Version,
};
use std::borrow::Cow;
use std::sync::atomic::{AtomicU64, Ordering};
use wgpu_types::{BufferUsages, TextureUsages};

/// A frame: the passes and resources declared so far.
///
/// `'f` is the lifetime of what pass bodies and uploads borrow.
pub struct Frame<'f> {
    id: u64,
    pub(crate) decl: Declaration,
    pub(crate) uploads: Vec<Cow<'f, [u8]>>,
    errors: Vec<Error>,
    node: Option<NodeId>,
    #[cfg(feature = "gpu")]
    pub(crate) bodies: Vec<Body<'f>>,
    #[cfg(feature = "gpu")]
    pub(crate) imports: Vec<Option<Imported>>,
}

impl Default for Frame<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'f> Frame<'f> {
    /// Starts an empty frame.
    pub fn new() -> Self {
        // Tells handles of different frames apart; it never reaches a plan.
        static FRAMES: AtomicU64 = AtomicU64::new(0);
        Self {
            id: FRAMES.fetch_add(1, Ordering::Relaxed),
            decl: Declaration::default(),
            uploads: Vec::new(),
            errors: Vec::new(),
            node: None,
            #[cfg(feature = "gpu")]
            bodies: Vec::new(),
            #[cfg(feature = "gpu")]
            imports: Vec::new(),
        }
    }

    /// Creates a texture that lives within this frame. Its contents are undefined until a pass writes them.
    pub fn create_texture(&mut self, name: impl Into<String>, desc: TextureDesc) -> Texture {
        Texture(self.add_resource(name.into(), ResourceDesc::Texture(desc), Origin::Transient))
    }

    /// Creates a buffer that lives within this frame. Its contents are undefined until a pass writes them.
    pub fn create_buffer(&mut self, name: impl Into<String>, desc: BufferDesc) -> Buffer {
        Buffer(self.add_resource(name.into(), ResourceDesc::Buffer(desc), Origin::Transient))
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
    /// assert_eq!(frame.compile()?.plan().order.len(), 2);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn upload_buffer(&mut self, name: impl Into<String>, bytes: impl Into<Cow<'f, [u8]>>) -> Buffer {
        let (name, bytes) = (name.into(), bytes.into());
        let mut buffer = self.create_buffer(name.clone(), BufferDesc::new(bytes.len() as u64));
        let upload = self.uploads.len() as u32;
        self.uploads.push(bytes);
        let pass = self.add_pass(format!("upload {name}"), PassKind::Copy);
        self.declare_write(pass, &mut buffer.0, Access::CopyTarget, Contents::Cover);
        self.decl.passes[pass.index()].copies.push(CopyOp::Upload { target: buffer.id(), upload });
        buffer
    }

    /// Declares a texture that belongs to the caller, created with `usage`; `defined` tells whether it holds
    /// something when the frame begins. Writing an import is an effect outside the frame, so such passes stay.
    ///
    /// This is the declaration alone; with a device use `Frame::import_texture`.
    pub fn declare_import_texture(
        &mut self,
        name: impl Into<String>,
        desc: TextureDesc,
        usage: TextureUsages,
        defined: bool,
    ) -> Texture {
        let version =
            self.add_resource(name.into(), ResourceDesc::Texture(desc), Origin::Imported { defined });
        self.decl.resources[version.resource.index()].texture_usage = usage;
        Texture(version)
    }

    /// Declares a buffer that belongs to the caller, created with `usage`. See
    /// [`declare_import_texture`](Self::declare_import_texture).
    pub fn declare_import_buffer(
        &mut self,
        name: impl Into<String>,
        desc: BufferDesc,
        usage: BufferUsages,
        defined: bool,
    ) -> Buffer {
        let version =
            self.add_resource(name.into(), ResourceDesc::Buffer(desc), Origin::Imported { defined });
        self.decl.resources[version.resource.index()].buffer_usage = usage;
        Buffer(version)
    }

    /// Keeps the texture's present contents to the end of the frame, to be taken out of the executed frame. A later
    /// write to it is an error.
    pub fn export_texture(&mut self, texture: &Texture) -> TextureExport {
        self.export(texture.0, TextureUsages::COPY_SRC, BufferUsages::empty());
        TextureExport(texture.0)
    }

    /// Keeps the buffer's present contents to the end of the frame, to be taken out of the executed frame. A later
    /// write to it is an error.
    pub fn export_buffer(&mut self, buffer: &Buffer) -> BufferExport {
        self.export(buffer.0, TextureUsages::empty(), BufferUsages::COPY_SRC);
        BufferExport(buffer.0)
    }

    /// Declares a pass that draws.
    pub fn render_pass(&mut self, name: impl Into<String>) -> Pass<'_, 'f, Rendering> {
        let id = self.add_pass(name.into(), PassKind::Render);
        Pass::new(self, id)
    }

    /// Declares a pass that dispatches compute work.
    pub fn compute_pass(&mut self, name: impl Into<String>) -> Pass<'_, 'f, Compute> {
        let id = self.add_pass(name.into(), PassKind::Compute);
        Pass::new(self, id)
    }

    /// Declares a pass that copies; the graph records the copies itself.
    pub fn copy_pass(&mut self, name: impl Into<String>) -> Pass<'_, 'f, Copying> {
        let id = self.add_pass(name.into(), PassKind::Copy);
        Pass::new(self, id)
    }

    /// Declares a pass that records into the raw encoder: the escape hatch for what the graph does not know.
    pub fn encoder_pass(&mut self, name: impl Into<String>) -> Pass<'_, 'f, Encoding> {
        let id = self.add_pass(name.into(), PassKind::Encoder);
        Pass::new(self, id)
    }

    /// Runs `build` with every pass it adds grouped under the node `name`. Nodes nest.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, Texture, TextureDesc};
    ///
    /// /// A node is a function that adds passes and returns handles.
    /// fn clear(frame: &mut Frame<'_>) -> Texture {
    ///     frame.node("background", |frame| {
    ///         let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    ///         frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0, 0.0, 0.0, 1.0]));
    ///         color
    ///     })
    /// }
    /// # clear(&mut Frame::new());
    /// ```
    pub fn node<R>(&mut self, name: impl Into<String>, build: impl FnOnce(&mut Self) -> R) -> R {
        let parent = self.node;
        self.node = Some(NodeId(self.decl.nodes.len() as u32));
        self.decl.nodes.push(NodeDecl { name: name.into(), parent });
        let result = build(self);
        self.node = parent;
        result
    }

    /// Returns the newest version of the texture declared last under `name`, if there is one.
    pub fn find_texture(&self, name: &str) -> Option<Texture> {
        let index = self
            .decl
            .resources
            .iter()
            .rposition(|r| r.name == name && matches!(r.desc, ResourceDesc::Texture(_)))?;
        let version = self.decl.resources[index].version();
        Some(Texture(Version { frame: self.id, resource: ResourceId(index as u32), version }))
    }

    /// Returns the names of all textures declared so far.
    pub fn texture_names(&self) -> impl Iterator<Item = &str> {
        let textures = self.decl.resources.iter().filter(|r| matches!(r.desc, ResourceDesc::Texture(_)));
        textures.map(|r| r.name.as_str())
    }

    /// Returns the description of a texture of this frame; `None` for a handle of another frame.
    pub fn texture_desc(&self, texture: &Texture) -> Option<TextureDesc> {
        if texture.0.frame != self.id {
            return None;
        }
        match self.decl.resource(texture.id()).desc {
            ResourceDesc::Texture(desc) => Some(desc),
            ResourceDesc::Buffer(_) => None,
        }
    }

    /// Compiles the declarations into a plan.
    ///
    /// # Errors
    /// The first mistake made while declaring, in order of declaration.
    pub fn compile(mut self) -> Result<Compiled<'f>, Error> {
        if !self.errors.is_empty() {
            return Err(self.errors.swap_remove(0));
        }
        let plan = compile::compile(std::mem::take(&mut self.decl))?;
        Ok(Compiled { plan, frame: self })
    }

    #[cfg(feature = "gpu")]
    pub(crate) fn id(&self) -> u64 {
        self.id
    }

    fn add_resource(&mut self, name: String, desc: ResourceDesc, origin: Origin) -> Version {
        let resource = ResourceId(self.decl.resources.len() as u32);
        self.decl.resources.push(ResourceDecl {
            name,
            desc,
            origin,
            exported: None,
            texture_usage: TextureUsages::empty(),
            buffer_usage: BufferUsages::empty(),
            writers: Vec::new(),
        });
        #[cfg(feature = "gpu")]
        self.imports.push(None);
        Version { frame: self.id, resource, version: 0 }
    }

    fn add_pass(&mut self, name: String, kind: PassKind) -> PassId {
        let id = PassId(self.decl.passes.len() as u32);
        self.decl.passes.push(PassDecl {
            name,
            node: self.node,
            kind,
            accesses: Vec::new(),
            copies: Vec::new(),
            keep: false,
        });
        #[cfg(feature = "gpu")]
        self.bodies.push(Body::None);
        id
    }

    fn export(&mut self, version: Version, texture: TextureUsages, buffer: BufferUsages) {
        if version.frame != self.id {
            self.errors.push(Error::ForeignHandle { place: "an export".into() });
            return;
        }
        if self.is_stale(version) {
            let error = self.stale_read("export".into(), version);
            self.errors.push(error);
        }
        let resource = &mut self.decl.resources[version.resource.index()];
        resource.exported = Some(version.version);
        // Of an import the usages are what its owner gave it.
        if resource.origin == Origin::Transient {
            resource.texture_usage |= texture;
            resource.buffer_usage |= buffer;
        }
    }

    pub(crate) fn declare_read(&mut self, pass: PassId, version: Version, access: Access) -> Token {
        if version.frame != self.id {
            self.errors.push(Error::ForeignHandle { place: format!("pass `{}`", self.decl.pass_path(pass)) });
        } else {
            if self.is_stale(version) {
                let error = self.stale_read(self.decl.pass_path(pass), version);
                self.errors.push(error);
            }
            self.add_access(pass, version, access, None);
        }
        Token { frame: version.frame, pass, resource: version.resource }
    }

    pub(crate) fn declare_write(
        &mut self,
        pass: PassId,
        version: &mut Version,
        access: Access,
        contents: Contents,
    ) -> Token {
        let token = Token { frame: version.frame, pass, resource: version.resource };
        if version.frame != self.id {
            self.errors.push(Error::ForeignHandle { place: format!("pass `{}`", self.decl.pass_path(pass)) });
            return token;
        }
        if self.is_stale(*version) {
            let resource = self.decl.resource(version.resource);
            self.errors.push(Error::TwoWriters {
                pass: self.decl.pass_path(pass),
                resource: resource.name.clone(),
                version: version.version,
                writer: self.decl.pass_path(resource.writers[version.version as usize]),
            });
        }
        self.add_access(pass, *version, access, Some(contents));
        let resource = &mut self.decl.resources[version.resource.index()];
        resource.writers.push(pass);
        version.version = resource.version();
        token
    }

    pub(crate) fn pass_mut(&mut self, pass: PassId) -> &mut PassDecl {
        &mut self.decl.passes[pass.index()]
    }

    fn add_access(&mut self, pass: PassId, version: Version, access: Access, contents: Option<Contents>) {
        let access = AccessDecl { resource: version.resource, access, contents, version: version.version };
        self.pass_mut(pass).accesses.push(access);
    }

    fn is_stale(&self, version: Version) -> bool {
        version.version != self.decl.resource(version.resource).version()
    }

    fn stale_read(&self, pass: String, version: Version) -> Error {
        let resource = self.decl.resource(version.resource);
        Error::StaleRead {
            pass,
            resource: resource.name.clone(),
            version: version.version,
            writer: self.decl.pass_path(resource.writers[version.version as usize]),
            latest: resource.version(),
        }
    }
}
