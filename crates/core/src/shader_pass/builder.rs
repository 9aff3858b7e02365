//! Declaring a pass in one line.

use super::declaration::{Attachments, Depth, Entry, Work};
use super::shader::{ComputeShader, FullscreenShader, Program};
use super::uniform_source::UniformSource;
use crate::access::Contents;
use crate::builder::{Compute, Pass, Rendering, ShaderPass};
use crate::desc::TextureDesc;
use crate::error::Error;
use crate::execute::Body;
use crate::frame::Frame;
use crate::handle::{Buffer, BufferToken, PassId, Texture, TextureToken};
use crate::name::Name;
use crate::subresource::{Aspect, Subresource};
use std::sync::Arc;

/// Bytes of the arguments of an indirect dispatch: three numbers of workgroups.
const ARGUMENTS: u64 = 12;

/// A pass of one shader being declared: first what is bound, at bindings 0, 1, 2 and so on in the order of the calls,
/// then where it draws ([`draw`](Self::draw) and its like) or how much it dispatches ([`dispatch`](Self::dispatch)).
///
/// [`Frame::fullscreen`] and [`Frame::compute`] begin one. The pass is one like any other: it is culled, ordered,
/// merged and dumped as if it had been declared with `render_pass` or `compute_pass` and a body.
#[must_use = "nothing is recorded until it is told where to draw or how much to dispatch"]
pub struct ShaderPassBuilder<'p, 'f, K> {
    pass: Pass<'p, 'f, K>,
    part: Subresource,
}

impl<'f> Frame<'f> {
    /// Declares a pass that draws a fragment shader over its targets: one line for what would else be a pipeline, a
    /// layout, a bind group and a body.
    ///
    #[doc = include_str!("fullscreen.md")]
    ///
    /// # Errors
    /// `compile` returns what it returns for any pass, `execute` returns [`Error::Shader`] with wgpu's words for a
    /// shader that does not compile, or does not fit what is bound and drawn into.
    pub fn fullscreen(
        &mut self,
        name: impl Name,
        shader: &FullscreenShader,
    ) -> ShaderPassBuilder<'_, 'f, Rendering> {
        let attachments = Attachments { samples: 1, ..Default::default() };
        ShaderPassBuilder::new(self.render_pass(name), shader.0.clone(), Work::Draw(attachments))
    }

    /// Declares a pass that dispatches a compute shader.
    ///
    #[doc = include_str!("compute.md")]
    ///
    /// # Errors
    /// `compile` returns what it returns for any pass, `execute` returns [`Error::Shader`] with wgpu's words for a
    /// shader that does not compile, or does not fit what is bound, and [`Error::Limit`] for more workgroups than
    /// the device allows.
    pub fn compute(&mut self, name: impl Name, shader: &ComputeShader) -> ShaderPassBuilder<'_, 'f, Compute> {
        ShaderPassBuilder::new(self.compute_pass(name), shader.0.clone(), Work::Dispatch([0; 3]))
    }
}

impl<'p, 'f, K> ShaderPassBuilder<'p, 'f, K> {
    fn new(pass: Pass<'p, 'f, K>, program: Arc<Program>, work: Work) -> Self {
        let call = pass.frame.work.calls.begin(program, work);
        pass.frame.work.bodies[pass.id.index()] = Body::ShaderPass(call);
        Self { pass, part: Subresource::FULL }
    }

    /// Keeps the pass even if nothing needs what it writes, for effects that the graph cannot see.
    pub fn keep(mut self) -> Self {
        self.pass.keep();
        self
    }

    /// Runs this pass after `other`, for effects outside the graph that the two share.
    pub fn after(mut self, other: PassId) -> Self {
        self.pass.after(other);
        self
    }

    /// Narrows the next access to a part of its resource: a mip level to read, a tile to draw into.
    pub fn subresource(mut self, part: Subresource) -> Self {
        self.part = part;
        self
    }

    /// The pass, with the part for its next access.
    fn next(&mut self) -> &mut Pass<'p, 'f, K> {
        self.pass.subresource(std::mem::take(&mut self.part))
    }

    fn bind(self, entry: Entry) -> Self {
        self.pass.frame.work.calls.bind(entry);
        self
    }

    fn bind_texture(self, texture: TextureToken) -> Self {
        self.bind(Entry::Texture(texture))
    }

    fn bind_buffer(self, buffer: BufferToken) -> Self {
        self.bind(Entry::Buffer(buffer))
    }

    /// Binds bytes as a uniform block (or as a small read-only storage block): `&params`, or a
    /// [`Uniform`](crate::Uniform) that other passes bind too. All blocks of a frame reach the GPU by one copy, and
    /// frames in flight each keep their own.
    pub fn uniform<'a>(self, block: impl Into<UniformSource<'a>>) -> Self {
        let uniform = match block.into() {
            UniformSource::Shared(uniform) => uniform,
            UniformSource::Bytes(bytes) => self.pass.frame.uniform(bytes),
        };
        if uniform.size_bytes() == 0 {
            let resource =
                format!("a uniform block of pass `{}`", self.pass.frame.decl.pass_path(self.pass.id));
            self.pass.frame.report_error(Error::InvalidResource {
                resource,
                problem: "it has no bytes; give it some".into(),
            });
        }
        self.bind(Entry::Uniform(uniform))
    }

    /// Binds a sampler of yours.
    pub fn sampler(self, sampler: &wgpu::Sampler) -> Self {
        self.bind(Entry::Sampler(sampler.clone()))
    }

    /// Binds a view of yours, of a texture that is not part of the graph.
    pub fn external_view(self, view: &wgpu::TextureView) -> Self {
        self.bind(Entry::View(view.clone()))
    }

    /// Binds a buffer of yours that is not part of the graph, all of it.
    pub fn external_buffer(self, buffer: &wgpu::Buffer) -> Self {
        self.bind(Entry::ExternalBuffer(buffer.clone()))
    }
}

impl<K: ShaderPass> ShaderPassBuilder<'_, '_, K> {
    /// Binds a texture to sample or load from; of a combined depth-stencil format its depth, unless the part is the
    /// stencil.
    pub fn sample(mut self, texture: &Texture) -> Self {
        let token = self.next().sample(texture);
        self.bind_texture(token)
    }

    /// Binds a buffer as read-only storage.
    pub fn storage(mut self, buffer: &Buffer) -> Self {
        let token = self.next().storage_buffer(buffer);
        self.bind_buffer(token)
    }

    /// Binds a buffer as storage that the shader writes. `contents` says what becomes of what it held: with
    /// `Contents::Preserve` the shader may read it too.
    pub fn storage_mut(mut self, buffer: &mut Buffer, contents: Contents) -> Self {
        let token = self.next().storage_buffer_mut(buffer, contents);
        self.bind_buffer(token)
    }

    /// Binds a read-only storage texture.
    pub fn storage_texture(mut self, texture: &Texture) -> Self {
        let token = self.next().storage_texture(texture);
        self.bind_texture(token)
    }

    /// Binds a storage texture that the shader writes.
    pub fn storage_texture_mut(mut self, texture: &mut Texture, contents: Contents) -> Self {
        let token = self.next().storage_texture_mut(texture, contents);
        self.bind_texture(token)
    }

    /// Binds a buffer of the frame as a uniform block, for what the GPU itself has written. For values of the CPU's
    /// see [`uniform`](Self::uniform).
    pub fn uniform_buffer(mut self, buffer: &Buffer) -> Self {
        let token = self.next().uniform_buffer(buffer);
        self.bind_buffer(token)
    }
}

impl ShaderPassBuilder<'_, '_, Rendering> {
    /// Draws over a target, or over the part of it that [`on`](Self::on) chose, and ends the declaration.
    ///
    /// The shader covers it: every texel gets what the shader returns, unblended, and nothing that was there before
    /// is loaded. A shader that discards needs [`draw_over`](Self::draw_over).
    pub fn draw(self, target: &mut Texture) -> PassId {
        self.target(target).pass.id()
    }

    /// Draws onto what is there already, and ends the declaration: blended by `blend`, or with `None` in its place
    /// where the shader does not discard.
    pub fn draw_over(self, target: &mut Texture, blend: impl Into<Option<wgpu::BlendState>>) -> PassId {
        self.target_over(target, blend).pass.id()
    }

    /// Draws over depth alone, which the shader returns as `@builtin(frag_depth)`, and ends the declaration. Stencil,
    /// where there is one, is left alone.
    pub fn draw_depth(mut self, target: &mut Texture) -> PassId {
        let desc = self.attached(target);
        if self.part.aspect == Aspect::All
            && desc.is_some_and(|desc| desc.format.is_combined_depth_stencil_format())
        {
            self.part = self.part.aspect(Aspect::Depth);
        }
        self.next().depth(target, Contents::Overwrite);
        self.depth(desc, true, wgpu::CompareFunction::Always);
        self.pass.id()
    }

    /// Draws over one more target, at the shader's next `@location`; the last one is given to [`draw`](Self::draw) or
    /// [`draw_over`](Self::draw_over).
    pub fn target(self, target: &mut Texture) -> Self {
        self.attach(target, Contents::Overwrite, None)
    }

    /// Draws onto what is in one more target; see [`draw_over`](Self::draw_over).
    pub fn target_over(self, target: &mut Texture, blend: impl Into<Option<wgpu::BlendState>>) -> Self {
        self.attach(target, Contents::Preserve, blend.into())
    }

    /// Draws only where `compare` holds between the depth of what is drawn and that of `depth`, which is not written.
    ///
    /// What is drawn has depth 0, unless the shader returns another. With reversed depth that is the far plane, so
    /// `CompareFunction::Equal` draws where nothing has been drawn: a sky.
    pub fn depth_test(mut self, depth: &Texture, compare: wgpu::CompareFunction) -> Self {
        let desc = self.attached(depth);
        self.next().depth_read(depth);
        self.depth(desc, false, compare);
        self
    }

    fn attach(mut self, target: &mut Texture, contents: Contents, blend: Option<wgpu::BlendState>) -> Self {
        let desc = self.attached(target);
        self.next().color(target, contents);
        if let (Some(desc), Some(attachments)) = (desc, self.attachments()) {
            attachments.samples = desc.samples;
            // One too many is refused where the render pass begins.
            let _ = attachments.colors.try_push((desc.format, blend));
        }
        self
    }

    fn depth(&mut self, desc: Option<TextureDesc>, write: bool, compare: wgpu::CompareFunction) {
        if let (Some(desc), Some(attachments)) = (desc, self.attachments()) {
            attachments.samples = desc.samples;
            attachments.depth = Some(Depth { format: desc.format, write, compare });
        }
    }

    /// The shape of what is to be attached; a handle of another frame has none, and is an error by then.
    fn attached(&self, texture: &Texture) -> Option<TextureDesc> {
        self.pass.frame.texture_desc(texture)
    }

    fn attachments(&mut self) -> Option<&mut Attachments> {
        match self.pass.frame.work.calls.work()? {
            Work::Draw(attachments) => Some(attachments),
            Work::Dispatch(_) | Work::DispatchIndirect(..) => None,
        }
    }
}

impl ShaderPassBuilder<'_, '_, Compute> {
    /// Dispatches this many workgroups in x, y and z, and ends the declaration. For one invocation per item divide by
    /// the shader's workgroup size and round up: `items.div_ceil(64)`.
    pub fn dispatch(self, workgroups: [u32; 3]) -> PassId {
        self.work(Work::Dispatch(workgroups))
    }

    /// Dispatches as many workgroups as `arguments` holds, three `u32` at `offset` bytes (a multiple of 4), and ends
    /// the declaration.
    pub fn dispatch_indirect(mut self, arguments: &Buffer, offset: u64) -> PassId {
        let end = offset.saturating_add(ARGUMENTS);
        let part = Subresource::FULL.bytes(offset..end);
        let own = self.pass.frame.buffer_desc(arguments).is_some();
        if own && !offset.is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
            let error = Error::InvalidSubresource {
                pass: self.pass.frame.decl.pass_path(self.pass.id),
                resource: self.pass.frame.decl.resource_path(arguments.id()),
                subresource: part.to_string(),
                problem: "arguments of a dispatch begin at a multiple of 4",
            };
            self.pass.frame.report_error(error);
        }
        let token = self.pass.subresource(part).indirect_buffer(arguments);
        self.work(Work::DispatchIndirect(token, offset))
    }

    fn work(self, work: Work) -> PassId {
        if let Some(own) = self.pass.frame.work.calls.work() {
            *own = work;
        }
        self.pass.id()
    }
}
