//! Shaders of fullscreen and compute passes.

use super::validation::describe;
use crate::device::with_error_scopes;
use crate::error::Error;
use rustc_hash::FxHasher;
use std::borrow::Cow;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A string that is not copied where it is a literal.
type Text = Cow<'static, str>;

/// A shader with its entry point and constants: what a pipeline is made of besides its targets.
#[derive(Clone, Debug)]
pub(crate) struct ProgrammableStage {
    /// Name for labels and errors; stages that differ in nothing else are equivalent.
    pub(crate) name: Text,
    pub(super) source: Source,
    pub(super) entry_point: Option<Text>,
    pub(super) constants: Vec<(Text, f64)>,
    /// Hash of all but the name.
    pub(super) hash: u64,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Source {
    Wgsl(Text),
    Module(wgpu::ShaderModule),
}

impl ProgrammableStage {
    fn new(name: Text, source: Source) -> Self {
        Self { name, source, entry_point: None, constants: Vec::new(), hash: 0 }.hashed()
    }

    fn hashed(mut self) -> Self {
        let mut hasher = FxHasher::default();
        self.parts().hash(&mut hasher);
        self.constants().for_each(|constant| constant.hash(&mut hasher));
        self.hash = hasher.finish();
        self
    }

    fn parts(&self) -> (&Source, &Option<Text>, usize) {
        (&self.source, &self.entry_point, self.constants.len())
    }

    fn constants(&self) -> impl Iterator<Item = (&str, u64)> {
        self.constants.iter().map(|(name, value)| (&**name, value.to_bits()))
    }

    /// Returns whether both make the same pipelines.
    pub(super) fn is_equivalent(&self, other: &Self) -> bool {
        self.hash == other.hash && self.parts() == other.parts() && self.constants().eq(other.constants())
    }

    /// Returns an error of this shader.
    pub(crate) fn error(&self, message: impl Into<String>) -> Error {
        Error::Shader { shader: self.name.to_string(), message: message.into() }
    }

    /// Creates an object of this shader and returns wgpu's validation error, if any; `prefix` begins its message.
    pub(crate) fn checked<T>(
        &self,
        device: &wgpu::Device,
        prefix: &str,
        create: impl FnOnce() -> T,
    ) -> Result<T, Error> {
        // Internal errors are those that only the driver finds.
        let filters = [wgpu::ErrorFilter::Validation, wgpu::ErrorFilter::Internal];
        let (created, error) = with_error_scopes(device, &filters, create);
        match error {
            None => Ok(created),
            Some(error) => Err(self.error(format!("{prefix}{}", describe(&error)))),
        }
    }
}

macro_rules! shader {
    ($(#[$doc:meta])* $name:ident, $stage:literal) => {
        $(#[$doc])*
        #[derive(Clone, Debug)]
        pub struct $name(pub(crate) Arc<ProgrammableStage>);

        impl $name {
            /// Creates a shader from WGSL text. `name` is for errors and for labels in graphics debuggers.
            ///
            /// Nothing is compiled before the first frame that uses it, or [`Graph::warm`](crate::Graph::warm).
            pub fn wgsl(name: impl Into<Cow<'static, str>>, text: impl Into<Cow<'static, str>>) -> Self {
                Self(Arc::new(ProgrammableStage::new(name.into(), Source::Wgsl(text.into()))))
            }

            /// Creates a shader from an existing module, such as one from a shader composer.
            pub fn module(name: impl Into<Cow<'static, str>>, module: &wgpu::ShaderModule) -> Self {
                Self(Arc::new(ProgrammableStage::new(name.into(), Source::Module(module.clone()))))
            }

            #[doc = concat!("Chooses the entry point; needed where there is more than one of the ", $stage, " stage.")]
            pub fn entry_point(self, entry: impl Into<Cow<'static, str>>) -> Self {
                self.change(|stage| stage.entry_point = Some(entry.into()))
            }

            /// Sets an `override` constant of the shader, by its name, or by its number where it has an `@id`.
            pub fn constant(self, name: impl Into<Cow<'static, str>>, value: f64) -> Self {
                self.change(|stage| stage.constants.push((name.into(), value)))
            }

            fn change(mut self, change: impl FnOnce(&mut ProgrammableStage)) -> Self {
                let mut stage = Arc::unwrap_or_clone(self.0);
                change(&mut stage);
                self.0 = Arc::new(stage.hashed());
                self
            }
        }
    };
}

shader!(
    /// A fragment shader that [`Frame::fullscreen`] draws over a whole target or a region of one.
    ///
    /// The vertex stage is built in: it outputs `@location(0) uv: vec2f`, (0, 0) at the upper left corner of the drawn
    /// region and (1, 1) at the lower right, and `@builtin(position)` in texels of the target. Use either or both.
    /// Bindings are in group 0, numbered from 0 in the order of the builder calls that fill them, and exactly those
    /// that the shader uses.
    ///
    /// Create it once and keep it; cloning is cheap. The graph caches pipelines: shaders with the same text, entry point
    /// and constants share them.
    ///
    /// [`Frame::fullscreen`]: crate::Frame::fullscreen
    FullscreenShader,
    "fragment"
);
shader!(
    /// A compute shader, dispatched by [`Frame::compute`].
    ///
    /// Bindings are in group 0, numbered from 0 in the order of the builder calls that fill them, and exactly those that
    /// the shader uses.
    ///
    /// Create it once and keep it; cloning is cheap. The graph caches pipelines: shaders with the same text, entry point
    /// and constants share them.
    ///
    /// [`Frame::compute`]: crate::Frame::compute
    ComputeShader,
    "compute"
);
