//! Sources of uniform bindings.

use crate::handle::Uniform;

/// The source of a uniform binding: bytes, or a block that several passes share.
#[derive(Clone, Copy, Debug)]
pub enum UniformSource<'a> {
    /// Bytes for this pass only, in the shader's layout.
    Bytes(&'a [u8]),
    /// A block from [`Frame::uniform`](crate::Frame::uniform).
    Shared(Uniform),
}

impl<'a> From<&'a [u8]> for UniformSource<'a> {
    fn from(bytes: &'a [u8]) -> Self {
        Self::Bytes(bytes)
    }
}

impl<'a, const N: usize> From<&'a [u8; N]> for UniformSource<'a> {
    fn from(bytes: &'a [u8; N]) -> Self {
        Self::Bytes(bytes)
    }
}

impl<'a> From<&'a Vec<u8>> for UniformSource<'a> {
    fn from(bytes: &'a Vec<u8>) -> Self {
        Self::Bytes(bytes)
    }
}

impl From<Uniform> for UniformSource<'_> {
    fn from(uniform: Uniform) -> Self {
        Self::Shared(uniform)
    }
}
