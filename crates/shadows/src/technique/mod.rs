//! The contract between shadow techniques and whoever lights a scene.

mod check;
mod gpu_struct;
mod layout;
mod outputs;

pub use check::add_shadows;
pub use gpu_struct::GpuStruct;
pub(crate) use layout::layout;
pub use layout::{binding, shadow_layout};
pub use outputs::{ShadowBinding, ShadowOutputs, ShadowTokens};

use shadowgraph_core::{Buffer, Frame, Texture};
use shadowgraph_shaders::ModuleSource;

use crate::{Error, Requirements, ShadowInputs};

/// A way of making shadows: nodes for the graph, and a WGSL module that answers "how much of this light arrives
/// here".
///
/// The first module has `#define_import_path shadowgraph::technique` and the functions
/// `shadow_visibility(light: u32, receiver: Receiver) -> vec3f` (1 lit, 0 in shadow) and
/// `shadow_debug_color(light: u32, receiver: Receiver) -> vec3f`. It is called in loops and from compute passes, so
/// it never uses implicit derivatives. All of bind group 1 is its own.
///
/// What it holds is what stays the same for all frames: all that a user can choose comes with the
/// [settings](crate::ShadowSettings) of each frame. Frames call [`add_shadows`], which checks what the technique gives.
pub trait ShadowTechnique: Send + Sync {
    /// Returns the name that users choose it by.
    fn name(&self) -> &str;

    /// Returns what it needs of shared services, with the settings in use.
    ///
    /// # Errors
    /// For settings of its own that are out of range.
    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error>;

    /// Whether it reads the surfaces that the picture shows ([`SurfaceBuffers`]).
    fn reads_surface_buffers(&self) -> bool {
        false
    }

    /// Returns how many variants of its WGSL there are, at least 1. Variant 0 serves every frame; others have less in them,
    /// and [`ShadowOutputs::variant`] says which of them a frame is best lit with.
    fn variant_count(&self) -> u32 {
        1
    }

    /// Returns its WGSL modules in a variant: the one with the functions, and those that take the place of built-in ones.
    fn modules(&self, variant: u32) -> Vec<ModuleSource>;

    /// Returns what each binding of group 1 is, by number. Fragments and compute passes see all of them.
    fn binding_types(&self) -> Vec<wgpu::BindingType>;

    /// Returns the structs that it writes in Rust and reads in WGSL: they are compared when it is registered.
    fn gpu_structs(&self) -> Vec<GpuStruct> {
        Vec::new()
    }

    /// Adds its passes to the frame. What is not needed (no shadowed light, no caster in reach) adds no pass.
    /// `screen` is there if [`reads_surface_buffers`](Self::reads_surface_buffers) says so.
    ///
    /// # Errors
    /// For settings, a camera or an aspect ratio that are out of range; [`Error::MissingSurfaceBuffers`].
    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        screen: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error>;
}

/// What the picture shows, for techniques that ask for it.
#[derive(Clone, Debug)]
pub struct SurfaceBuffers {
    /// Width and height of the picture, pixels.
    pub size_px: [u32; 2],
    /// The camera: the storage buffer `view` of `shadowgraph::view`.
    pub view: Buffer,
    /// The lights: the storage buffer `lights` of `shadowgraph::view`.
    pub lights: Buffer,
    /// Where surfaces are and which way they face, those of all that is not blended: `Rgba32Float`, as
    /// `shadowgraph::surface` says.
    pub surfaces: Texture,
    /// Whether something is blended over the surfaces.
    pub has_blended: bool,
}
