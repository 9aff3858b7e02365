//! Pass bodies: the functions that record passes.

use super::{BodyResult, ComputeContext, EncoderContext, RenderContext};
use crate::handle::PassId;
use smallbox::space::S8;
use smallbox::{SmallBox, smallbox};

/// The body of a pass.
pub(crate) enum Body<'f> {
    None,
    Render(Recorder<dyn for<'a> FnMut(&mut RenderContext<'a>) -> BodyResult + Send + 'f>),
    Compute(Recorder<dyn for<'a> FnMut(&mut ComputeContext<'a>) -> BodyResult + Send + 'f>),
    Encoder(Recorder<dyn for<'a> FnMut(&mut EncoderContext<'a>) -> BodyResult + Send + 'f>),
    /// The index of one of the frame's shader passes.
    ShaderPass(u32),
}

/// A function, which is allocated only if it captures more than 64 bytes.
type Recorder<F> = SmallBox<F, S8>;

macro_rules! constructor {
    ($name:ident, $context:ident, $variant:ident) => {
        pub(crate) fn $name(body: impl for<'a> FnOnce(&mut $context<'a>) -> BodyResult + Send + 'f) -> Self {
            // A function that is called once cannot be called through a small box.
            let mut body = Some(body);
            Self::$variant(smallbox!(move |context: &mut $context<'_>| {
                body.take().map_or(Ok(()), |body| body(context))
            }))
        }
    };
}

impl<'f> Body<'f> {
    constructor!(render, RenderContext, Render);
    constructor!(compute, ComputeContext, Compute);
    constructor!(encoder, EncoderContext, Encoder);
}

/// Bodies of passes that are recorded.
pub(crate) enum Bodies<'b, 'f> {
    /// All of the frame's, by pass.
    OfFrame(&'b mut [Body<'f>]),
    /// Some of them, in the order of recording.
    InOrder(std::slice::IterMut<'b, Body<'f>>),
}

impl<'f> Bodies<'_, 'f> {
    /// Returns the body of the pass that is recorded next.
    pub(crate) fn next(&mut self, pass: PassId) -> Option<&mut Body<'f>> {
        match self {
            Self::OfFrame(bodies) => bodies.get_mut(pass.index()),
            Self::InOrder(bodies) => bodies.next(),
        }
    }
}
