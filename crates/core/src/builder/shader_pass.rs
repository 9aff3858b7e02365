//! Declaring a pass in one line.

use super::{Compute, Pass, Rendering, ShaderPass};
use crate::access::Contents;
use crate::context::Body;
use crate::desc::TextureDesc;
use crate::error::Error;
use crate::frame::Frame;
use crate::handle::{Buffer, BufferToken, PassId, Texture, TextureToken};
use crate::name::Name;
use crate::pipeline::{ComputeShader, DepthTarget, FullscreenShader, PipelineTargets, ProgrammableStage};
use crate::shader_pass::{Binding, Command, UniformSource};
use crate::subresource::{Aspect, Subresource};
use std::sync::Arc;

/// Size of the arguments of an indirect dispatch, in bytes: three workgroup counts.
const INDIRECT_ARGUMENTS_BYTES: u64 = 12;

/// Declares a pass of one shader: first its bindings, numbered 0, 1, 2 and so on in the order of the calls, then where it
/// draws ([`draw`](Self::draw) and similar methods) or how much it dispatches ([`dispatch`](Self::dispatch)).
///
/// [`Frame::fullscreen`] and [`Frame::compute`] create one. The pass is like any other: it is culled, ordered, merged and
/// dumped as if it had been declared with `render_pass` or `compute_pass` and a body.
#[must_use = "nothing is recorded until a method says where to draw or how much to dispatch"]
pub struct ShaderPassBuilder<'p, 'f, K> {
    pass: Pass<'p, 'f, K>,
    part: Subresource,
}

impl<'f> Frame<'f> {
    /// Declares a pass that draws a fragment shader over its targets: one line in place of a pipeline, a layout, a bind
    /// group and a body.
    ///
    #[doc = include_str!("fullscreen.md")]
    ///
    /// # Errors
    /// `compile` returns the errors of any pass. `execute` returns [`Error::Shader`] with wgpu's message for a shader that
    /// does not compile, or does not match its bindings or targets.
    #[track_caller]
    pub fn fullscreen(
        &mut self,
        name: impl Name,
        shader: &FullscreenShader,
    ) -> ShaderPassBuilder<'_, 'f, Rendering> {
        let targets = PipelineTargets { samples: 1, ..Default::default() };
        ShaderPassBuilder::new(self.render_pass(name), shader.0.clone(), Command::Draw(targets))
    }

    /// Declares a pass that dispatches a compute shader.
    ///
    #[doc = include_str!("compute.md")]
    ///
    /// # Errors
    /// `compile` returns the errors of any pass. `execute` returns [`Error::Shader`] with wgpu's message for a shader that
    /// does not compile or does not match its bindings, and [`Error::Limit`] for more workgroups than the device allows.
    #[track_caller]
    pub fn compute(&mut self, name: impl Name, shader: &ComputeShader) -> ShaderPassBuilder<'_, 'f, Compute> {
        ShaderPassBuilder::new(self.compute_pass(name), shader.0.clone(), Command::Dispatch([0; 3]))
    }
}

impl<'p, 'f, K> ShaderPassBuilder<'p, 'f, K> {
    fn new(pass: Pass<'p, 'f, K>, stage: Arc<ProgrammableStage>, command: Command) -> Self {
        let index = pass.frame.work.shader_passes.begin(stage, command);
        pass.frame.work.bodies[pass.id.index()] = Body::ShaderPass(index);
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

    /// Returns the pass, with the part for its next access.
    fn next(&mut self) -> &mut Pass<'p, 'f, K> {
        self.pass.subresource(std::mem::take(&mut self.part))
    }

    fn bind(self, binding: Binding) -> Self {
        self.pass.frame.work.shader_passes.bind(binding);
        self
    }

    fn bind_texture(self, texture: TextureToken) -> Self {
        self.bind(Binding::Texture(texture))
    }

    fn bind_buffer(self, buffer: BufferToken) -> Self {
        self.bind(Binding::Buffer(buffer))
    }

    /// Binds bytes as a uniform block (or as a small read-only storage block): `&params`, or a
    /// [`Uniform`](crate::Uniform) that other passes bind too. All blocks of a frame are uploaded by one copy, and
    /// frames in flight each have their own.
    pub fn uniform<'a>(self, source: impl Into<UniformSource<'a>>) -> Self {
        let uniform = match source.into() {
            UniformSource::Shared(uniform) => uniform,
            UniformSource::Bytes(bytes) => self.pass.frame.uniform(bytes),
        };
        if uniform.size_bytes() == 0 {
            let resource =
                format!("a uniform block of pass {}", self.pass.frame.decl.pass_name(self.pass.id));
            self.pass.frame.report_error(Error::InvalidResource {
                resource,
                problem: "a uniform block must not be empty".into(),
            });
        }
        self.bind(Binding::Uniform(uniform))
    }

    /// Binds a sampler.
    pub fn sampler(self, sampler: &wgpu::Sampler) -> Self {
        self.bind(Binding::Sampler(sampler.clone()))
    }

    /// Binds a view of a texture that is not part of the graph.
    pub fn external_view(self, view: &wgpu::TextureView) -> Self {
        self.bind(Binding::ExternalView(view.clone()))
    }

    /// Binds the whole of a buffer that is not part of the graph.
    pub fn external_buffer(self, buffer: &wgpu::Buffer) -> Self {
        self.bind(Binding::ExternalBuffer(buffer.clone()))
    }
}

impl<K: ShaderPass> ShaderPassBuilder<'_, '_, K> {
    /// Binds a texture to sample or load from. A combined depth-stencil format binds its depth, unless the part selects the
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

    /// Binds a buffer as storage that the shader writes. `contents` says what happens to its old contents: with
    /// `Contents::Preserve` the shader may read them too.
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

    /// Binds a buffer of the frame as a uniform block, for values that the GPU has written. For values from the CPU see
    /// [`uniform`](Self::uniform).
    pub fn uniform_buffer(mut self, buffer: &Buffer) -> Self {
        let token = self.next().uniform_buffer(buffer);
        self.bind_buffer(token)
    }
}

impl ShaderPassBuilder<'_, '_, Rendering> {
    /// Overwrites a target, or the part of it that [`subresource`](Self::subresource) selected, and ends the declaration.
    ///
    /// Every texel gets the value that the shader returns, without blending, and the old contents are not loaded. A shader
    /// that discards needs [`draw_over`](Self::draw_over).
    pub fn draw(self, target: &mut Texture) -> PassId {
        self.target(target).pass.id()
    }

    /// Draws over the target's contents and ends the declaration: blended by `blend`, or with `None` replacing them where
    /// the shader does not discard.
    pub fn draw_over(self, target: &mut Texture, blend: impl Into<Option<wgpu::BlendState>>) -> PassId {
        self.target_over(target, blend).pass.id()
    }

    /// Overwrites depth, which the shader returns as `@builtin(frag_depth)`, and ends the declaration. Stencil, if there is
    /// one, is unchanged.
    pub fn draw_depth(mut self, target: &mut Texture) -> PassId {
        let desc = self.attachment_desc(target);
        if self.part.aspect == Aspect::All
            && desc.is_some_and(|desc| desc.format.is_combined_depth_stencil_format())
        {
            self.part = self.part.aspect(Aspect::Depth);
        }
        self.next().depth(target, Contents::Overwrite);
        self.depth(desc, true, wgpu::CompareFunction::Always);
        self.pass.id()
    }

    /// Overwrites one more target, at the shader's next `@location`; pass the last one to [`draw`](Self::draw) or
    /// [`draw_over`](Self::draw_over).
    pub fn target(self, target: &mut Texture) -> Self {
        self.attach(target, Contents::Overwrite, None)
    }

    /// Draws over the contents of one more target; see [`draw_over`](Self::draw_over).
    pub fn target_over(self, target: &mut Texture, blend: impl Into<Option<wgpu::BlendState>>) -> Self {
        self.attach(target, Contents::Preserve, blend.into())
    }

    /// Draws only where `compare` holds between a fragment's depth and that of `depth`, which is not written.
    ///
    /// Fragments have depth 0, unless the shader returns another. With reversed depth that is the far plane, so
    /// `CompareFunction::Equal` draws where nothing else was drawn: a sky.
    pub fn depth_test(mut self, depth: &Texture, compare: wgpu::CompareFunction) -> Self {
        let desc = self.attachment_desc(depth);
        self.next().depth_read(depth);
        self.depth(desc, false, compare);
        self
    }

    fn attach(mut self, target: &mut Texture, contents: Contents, blend: Option<wgpu::BlendState>) -> Self {
        let desc = self.attachment_desc(target);
        self.next().color(target, contents);
        if let (Some(desc), Some(targets)) = (desc, self.pipeline_targets()) {
            targets.samples = desc.samples;
            // Too many are an error where the render pass begins.
            let _ = targets.colors.try_push((desc.format, blend));
        }
        self
    }

    fn depth(&mut self, desc: Option<TextureDesc>, write: bool, compare: wgpu::CompareFunction) {
        if let (Some(desc), Some(targets)) = (desc, self.pipeline_targets()) {
            targets.samples = desc.samples;
            targets.depth = Some(DepthTarget { format: desc.format, write, compare });
        }
    }

    /// Returns the shape of an attachment. A handle of another frame has none; it has been reported as an error.
    fn attachment_desc(&self, texture: &Texture) -> Option<TextureDesc> {
        self.pass.frame.texture_desc(texture)
    }

    fn pipeline_targets(&mut self) -> Option<&mut PipelineTargets> {
        match self.pass.frame.work.shader_passes.last_command()? {
            Command::Draw(targets) => Some(targets),
            Command::Dispatch(_) | Command::DispatchIndirect(..) => None,
        }
    }
}

impl ShaderPassBuilder<'_, '_, Compute> {
    /// Dispatches this many workgroups in x, y and z, and ends the declaration. For one invocation per item divide by
    /// the shader's workgroup size and round up: `items.div_ceil(64)`.
    pub fn dispatch(self, workgroups: [u32; 3]) -> PassId {
        self.command(Command::Dispatch(workgroups))
    }

    /// Dispatches as many workgroups as `arguments` holds, three `u32` at `offset` bytes (a multiple of 4), and ends
    /// the declaration.
    pub fn dispatch_indirect(mut self, arguments: &Buffer, offset: u64) -> PassId {
        let end = offset.saturating_add(INDIRECT_ARGUMENTS_BYTES);
        let part = Subresource::FULL.bytes(offset..end);
        let is_of_frame = self.pass.frame.buffer_desc(arguments).is_some();
        if is_of_frame && !offset.is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
            let error = Error::InvalidSubresource {
                pass: self.pass.frame.decl.pass_name(self.pass.id),
                resource: self.pass.frame.decl.resource_path(arguments.id()),
                subresource: part.to_string(),
                problem: "the arguments of a dispatch must begin at a multiple of 4",
            };
            self.pass.frame.report_error(error);
        }
        let token = self.pass.subresource(part).indirect_buffer(arguments);
        self.command(Command::DispatchIndirect(token, offset))
    }

    fn command(self, command: Command) -> PassId {
        if let Some(last) = self.pass.frame.work.shader_passes.last_command() {
            *last = command;
        }
        self.pass.id()
    }
}
