//! What a pass body gets to see: the pass it records, and the resources it declared.

use crate::builder::{Compute, Encoding, Pass, Rendering};
use crate::compiled::resolve;
use crate::error::Error;
use crate::handle::{BufferToken, PassId, ResourceId, TextureToken, Token};
use crate::plan::Plan;
use crate::pool::{Entry, Physical, Pool};
use std::num::NonZeroU64;
use std::ops::{Deref, DerefMut, Range};

/// What a pass body returns; wrap failures of your own with [`Error::body`].
pub type BodyResult = Result<(), Error>;

pub(crate) enum Body<'f> {
    None,
    Render(Box<dyn for<'a> FnOnce(&mut RenderContext<'a>) -> BodyResult + Send + 'f>),
    Compute(Box<dyn for<'a> FnOnce(&mut ComputeContext<'a>) -> BodyResult + Send + 'f>),
    Encoder(Box<dyn for<'a> FnOnce(&mut EncoderContext<'a>) -> BodyResult + Send + 'f>),
}

/// The declared resources of one pass, and bind groups of them.
pub struct Resources<'a> {
    pub(super) frozen: Frozen<'a>,
    pub(super) pool: &'a mut Pool,
    pub(super) pass: PassId,
}

/// What stays the same for all passes of a frame.
#[derive(Clone, Copy)]
pub(crate) struct Frozen<'a> {
    pub(super) plan: &'a Plan,
    pub(super) frame: u64,
    pub(super) physical: &'a [Option<Physical>],
    pub(super) device: &'a wgpu::Device,
}

impl<'a> Frozen<'a> {
    pub(super) fn texture(self, id: ResourceId) -> Result<&'a wgpu::Texture, Error> {
        match &self.physical[id.index()] {
            Some(Physical::Texture(texture)) => Ok(texture),
            _ => Err(self.absent(id)),
        }
    }

    pub(super) fn buffer(self, id: ResourceId) -> Result<&'a wgpu::Buffer, Error> {
        match &self.physical[id.index()] {
            Some(Physical::Buffer(buffer)) => Ok(buffer),
            _ => Err(self.absent(id)),
        }
    }

    /// Only an import that was declared without an object has nothing behind it.
    fn absent(self, id: ResourceId) -> Error {
        Error::NoImport { resource: self.plan.resource(id).name.clone() }
    }
}

/// One entry of a bind group; its place in the list is its binding number.
pub enum Bind<'a> {
    /// The whole texture.
    Texture(TextureToken),
    /// The whole buffer.
    Buffer(BufferToken),
    /// This range of the buffer, in bytes; with a dynamic offset, the range at offset 0.
    BufferRange(BufferToken, Range<u64>),
    /// A sampler of yours.
    Sampler(&'a wgpu::Sampler),
    /// A view of yours that is not part of the graph.
    View(&'a wgpu::TextureView),
    /// A buffer of yours that is not part of the graph.
    OwnBuffer(&'a wgpu::Buffer),
}

impl Resources<'_> {
    /// Returns the device that the frame is recorded for.
    pub fn device(&self) -> &wgpu::Device {
        self.frozen.device
    }

    /// Returns the physical texture behind a token of this pass.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn texture(&self, token: TextureToken) -> Result<&wgpu::Texture, Error> {
        self.frozen.texture(self.resolve(token.0)?)
    }

    /// Returns a view of the whole texture behind a token of this pass; of a combined depth-stencil format, its
    /// depth.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn view(&mut self, token: TextureToken) -> Result<wgpu::TextureView, Error> {
        let texture = self.texture(token)?.clone();
        let combined = texture.format().is_combined_depth_stencil_format();
        let aspect = if combined { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All };
        Ok(self.pool.view(&texture, aspect))
    }

    /// Returns the physical buffer behind a token of this pass.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if the token belongs to another pass.
    pub fn buffer(&self, token: BufferToken) -> Result<&wgpu::Buffer, Error> {
        self.frozen.buffer(self.resolve(token.0)?)
    }

    /// Returns a bind group of `layout` with `entries` at bindings 0, 1, 2 and so on. Groups are cached by what they
    /// bind, so asking every frame costs a look-up.
    ///
    /// # Errors
    /// [`Error::Undeclared`] if a token belongs to another pass.
    pub fn bind_group(
        &mut self,
        layout: &wgpu::BindGroupLayout,
        entries: &[Bind<'_>],
    ) -> Result<wgpu::BindGroup, Error> {
        let entries = entries.iter().map(|entry| self.entry(entry)).collect::<Result<Vec<_>, _>>()?;
        Ok(self.pool.bind_groups.get(self.frozen.device, layout, entries))
    }

    fn entry(&mut self, entry: &Bind<'_>) -> Result<Entry, Error> {
        let whole = |buffer: &wgpu::Buffer| Entry::Buffer { buffer: buffer.clone(), offset: 0, size: None };
        Ok(match entry {
            Bind::Texture(token) => Entry::View(self.view(*token)?),
            Bind::Buffer(token) => whole(self.buffer(*token)?),
            Bind::BufferRange(token, range) => Entry::Buffer {
                buffer: self.buffer(*token)?.clone(),
                offset: range.start,
                size: NonZeroU64::new(range.end.saturating_sub(range.start)),
            },
            Bind::Sampler(sampler) => Entry::Sampler((*sampler).clone()),
            Bind::View(view) => Entry::View((*view).clone()),
            Bind::OwnBuffer(buffer) => whole(buffer),
        })
    }

    fn resolve(&self, token: Token) -> Result<ResourceId, Error> {
        resolve(self.frozen.plan, self.frozen.frame, self.pass, token)
    }
}

macro_rules! context {
    ($(#[$doc:meta])* $name:ident, $field:ident: $inner:ty, $field_doc:literal, $kind:ident, $body:ident) => {
        $(#[$doc])*
        pub struct $name<'a> {
            #[doc = $field_doc]
            pub $field: $inner,
            pub(super) resources: Resources<'a>,
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

        impl<'f> Pass<'_, 'f, $kind> {
            /// Sets what the pass records. It runs when the frame is executed, if the pass is not culled.
            pub fn body(self, body: impl for<'a> FnOnce(&mut $name<'a>) -> BodyResult + Send + 'f) {
                self.frame.bodies[self.id.index()] = Body::$body(Box::new(body));
            }
        }
    };
}

context!(
    /// Recording a render pass. Derefs to [`Resources`].
    RenderContext, pass: wgpu::RenderPass<'a>, "The open render pass.", Rendering, Render
);
context!(
    /// Recording a compute pass. Derefs to [`Resources`].
    ComputeContext, pass: wgpu::ComputePass<'a>, "The open compute pass.", Compute, Compute
);
context!(
    /// Recording into the raw encoder. Derefs to [`Resources`].
    EncoderContext, encoder: &'a mut wgpu::CommandEncoder, "The encoder.", Encoding, Encoder
);
