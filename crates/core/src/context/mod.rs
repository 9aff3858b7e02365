//! Pass bodies and their contexts: the pass that a body records and the resources that it declared.

mod bind;
mod body;
mod entry_keys;
mod recording;

pub(crate) use body::{Bodies, Body};
pub(crate) use recording::{Recording, Uploads};

use crate::desc::ResourceDesc;
use crate::error::Error;
use crate::handle::{BufferToken, PassId, ResourceId, TextureToken, Token, Uniform};
use crate::pass_name::PassName;
use crate::pool::{Caches, ViewUsage};
use crate::shader_pass::ShaderPasses;
use crate::subresource::Subresource;
use std::ops::{Deref, DerefMut, Range};
use std::sync::MutexGuard;

/// The result of a pass body; wrap your own errors with [`Error::body`].
pub type BodyResult = Result<(), Error>;

/// The declared resources of one pass, and their bind groups.
pub struct Resources<'a> {
    pub(crate) recording: &'a Recording<'a>,
    pub(crate) pass: PassId,
}

impl<'a> Resources<'a> {
    /// Returns the device that the frame is recorded for.
    pub fn device(&self) -> &'a wgpu::Device {
        self.recording.device
    }

    /// Returns the physical texture of a token of this pass.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn texture(&self, token: TextureToken) -> Result<&'a wgpu::Texture, Error> {
        self.recording.texture(self.resolve(token.0)?)
    }

    /// Returns a view, for shaders, of the declared part of a texture; for a combined depth-stencil format of its depth,
    /// unless the part selects the stencil.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn view(&self, token: TextureToken) -> Result<wgpu::TextureView, Error> {
        let texture = self.texture(token)?;
        Ok(self.caches().views.get(texture, self.part(token.0), ViewUsage::Binding))
    }

    /// Returns the physical buffer of a token of this pass. It may be larger than declared.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn buffer(&self, token: BufferToken) -> Result<&'a wgpu::Buffer, Error> {
        self.recording.buffer(self.resolve(token.0)?)
    }

    /// Returns the declared part of a buffer, for example to set it as vertex or index buffer.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn slice(&self, token: BufferToken) -> Result<wgpu::BufferSlice<'a>, Error> {
        Ok(self.buffer(token)?.slice(self.byte_range(token.0)))
    }

    /// Reports draw calls that the body has recorded to a [`Timer`](crate::Timer), for
    /// [`PassTime::draws`](crate::PassTime::draws). Calls add up; without a timer they do nothing.
    pub fn report_draws(&self, draws: u32) {
        if let Some(timer) = self.recording.timer {
            timer.draws(self.pass, draws);
        }
    }

    fn resolve(&self, token: Token) -> Result<ResourceId, Error> {
        self.recording.plan.resolve((self.recording.frame, self.recording.places), self.pass, token)
    }

    pub(crate) fn part(&self, token: Token) -> Subresource {
        let decl = &self.recording.plan.decl;
        decl.accesses.get(token.access as usize).map_or(Subresource::FULL, |access| decl.subresource(access))
    }

    pub(crate) fn byte_range(&self, token: Token) -> Range<u64> {
        let decl = &self.recording.plan.decl;
        let all = decl.accesses.get(token.access as usize).map_or(0, |access| {
            match decl.resource(access.resource).desc {
                ResourceDesc::Buffer(desc) => desc.bytes,
                ResourceDesc::Texture(_) => 0,
            }
        });
        let (start, end) = self.part(token).bytes.unwrap_or((0, all));
        start..end
    }

    pub(crate) fn uniforms(&self, uniform: &Uniform) -> Result<&'a wgpu::Buffer, Error> {
        let same_frame = uniform.frame == self.recording.frame;
        self.recording
            .uniforms
            .filter(|_| same_frame)
            .ok_or_else(|| Error::ForeignHandle { location: format!("pass {}", self.pass_name()) })
    }

    pub(crate) fn pass_name(&self) -> PassName {
        self.recording.pass_name(self.pass)
    }

    pub(crate) fn caches(&self) -> MutexGuard<'a, Caches> {
        self.recording.pool.caches()
    }

    pub(crate) fn shader_passes(&self) -> &'a ShaderPasses {
        self.recording.shader_passes
    }
}

macro_rules! context {
    ($(#[$doc:meta])* $name:ident, $field:ident: $inner:ty, $field_doc:literal) => {
        $(#[$doc])*
        pub struct $name<'a> {
            #[doc = $field_doc]
            pub $field: $inner,
            pub(crate) resources: Resources<'a>,
        }

        impl<'a> Deref for $name<'a> {
            type Target = Resources<'a>;

            fn deref(&self) -> &Self::Target {
                &self.resources
            }
        }

        impl DerefMut for $name<'_> {
            fn deref_mut(&mut self) -> &mut Self::Target {
                &mut self.resources
            }
        }
    };
}

context!(
    /// Recording a render pass. Derefs to [`Resources`].
    ///
    /// Every body starts from clean state, even when several passes were merged into one: no bind groups, viewport and
    /// scissor set to the whole attachment (or to the rectangle that the pass declares), stencil reference and blend
    /// constant 0. Set a pipeline before drawing.
    RenderContext, pass: wgpu::RenderPass<'a>, "The open render pass."
);
context!(
    /// Recording a compute pass. Derefs to [`Resources`].
    ComputeContext, pass: wgpu::ComputePass<'a>, "The open compute pass."
);
context!(
    /// Recording into the raw encoder. Derefs to [`Resources`].
    EncoderContext, encoder: &'a mut wgpu::CommandEncoder, "The encoder."
);
