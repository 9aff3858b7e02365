//! Shaders as they are handed over.

use super::validation::words;
use crate::device::now;
use crate::error::Error;
use rustc_hash::FxHasher;
use std::borrow::Cow;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A string that need not be copied where it stands in the program.
type Text = Cow<'static, str>;

/// What pipelines are made of, but for what they draw into.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    /// For labels and errors; two programs that differ in nothing else are the same.
    pub(crate) name: Text,
    pub(super) source: Source,
    pub(super) entry: Option<Text>,
    pub(super) constants: Vec<(Text, f64)>,
    /// Of all but the name.
    pub(super) hash: u64,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Source {
    Wgsl(Text),
    Module(wgpu::ShaderModule),
}

impl Program {
    fn new(name: Text, source: Source) -> Self {
        Self { name, source, entry: None, constants: Vec::new(), hash: 0 }.hashed()
    }

    fn hashed(mut self) -> Self {
        let mut hasher = FxHasher::default();
        self.parts().hash(&mut hasher);
        self.constants().for_each(|constant| constant.hash(&mut hasher));
        self.hash = hasher.finish();
        self
    }

    fn parts(&self) -> (&Source, &Option<Text>, usize) {
        (&self.source, &self.entry, self.constants.len())
    }

    fn constants(&self) -> impl Iterator<Item = (&str, u64)> {
        self.constants.iter().map(|(name, value)| (&**name, value.to_bits()))
    }

    /// Whether pipelines of one serve the other.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.hash == other.hash && self.parts() == other.parts() && self.constants().eq(other.constants())
    }

    /// The error of what wgpu says against this program.
    pub(crate) fn refused(&self, message: impl Into<String>) -> Error {
        Error::Shader { shader: self.name.to_string(), message: message.into() }
    }

    /// Creates something of this program's, and makes wgpu's objection an error; `place` begins it.
    pub(crate) fn checked<T>(
        &self,
        device: &wgpu::Device,
        place: &str,
        create: impl FnOnce() -> T,
    ) -> Result<T, Error> {
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        // What the driver refuses, although wgpu did not.
        let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
        let created = create();
        let objections = [now(internal.pop()), now(validation.pop())];
        match objections.into_iter().flatten().next() {
            None => Ok(created),
            Some(objection) => Err(self.refused(format!("{place}{}", words(&objection)))),
        }
    }
}

macro_rules! shader {
    ($(#[$doc:meta])* $name:ident, $stage:literal) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name(pub(super) Arc<Program>);

        impl $name {
            /// Takes a shader as WGSL text. `name` is for errors and for labels in graphics debuggers.
            ///
            /// Nothing is compiled before the first frame that uses it, or [`Graph::warm`](crate::Graph::warm).
            pub fn wgsl(name: impl Into<Cow<'static, str>>, text: impl Into<Cow<'static, str>>) -> Self {
                Self(Arc::new(Program::new(name.into(), Source::Wgsl(text.into()))))
            }

            /// Takes a shader as a module of yours, such as one that a composer of shaders made.
            pub fn module(name: impl Into<Cow<'static, str>>, module: &wgpu::ShaderModule) -> Self {
                Self(Arc::new(Program::new(name.into(), Source::Module(module.clone()))))
            }

            #[doc = concat!("Chooses the entry point; needed where there is more than one of the ", $stage, " stage.")]
            pub fn entry_point(self, entry: impl Into<Cow<'static, str>>) -> Self {
                self.with(|program| program.entry = Some(entry.into()))
            }

            /// Sets an `override` constant of the shader, by its name, or by its number where it has an `@id`.
            pub fn constant(self, name: impl Into<Cow<'static, str>>, value: f64) -> Self {
                self.with(|program| program.constants.push((name.into(), value)))
            }

            fn with(mut self, change: impl FnOnce(&mut Program)) -> Self {
                let mut program = Arc::unwrap_or_clone(self.0);
                change(&mut program);
                self.0 = Arc::new(program.hashed());
                self
            }
        }
    };
}

shader!(
    /// A fragment shader that is drawn over a whole target, or over a part of one, by [`Frame::fullscreen`].
    ///
    /// The vertex stage is the graph's: it gives `@location(0) uv: vec2f`, (0, 0) at the upper left corner of what is
    /// drawn and (1, 1) at the lower right, beside `@builtin(position)` in texels of the target. Take what you need
    /// of them. Bindings are in group 0, numbered from 0 in the order of the calls that fill them, and exactly those
    /// that the shader uses.
    ///
    /// Make it once and keep it; a clone costs nothing. Pipelines are kept in the graph by what they are made of:
    /// two shaders of the same text, entry point and constants share them.
    ///
    /// [`Frame::fullscreen`]: crate::Frame::fullscreen
    FullscreenShader,
    "fragment"
);
shader!(
    /// A compute shader, dispatched by [`Frame::compute`].
    ///
    /// Bindings are in group 0, numbered from 0 in the order of the calls that fill them, and exactly those that the
    /// shader uses.
    ///
    /// Make it once and keep it; a clone costs nothing. Pipelines are kept in the graph by what they are made of:
    /// two shaders of the same text, entry point and constants share them.
    ///
    /// [`Frame::compute`]: crate::Frame::compute
    ComputeShader,
    "compute"
);
