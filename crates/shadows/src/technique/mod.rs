//! The contract between shadow techniques and the passes that light a scene.

mod check;
mod counts;
mod explanation;
mod gpu_struct;
mod layout;
mod mask_layers;
mod outputs;

pub(crate) use check::add_checked;
pub use check::add_shadows;
pub use counts::{CountWarning, ShadowCounts};
pub use explanation::{EXPLANATION_VALUES, ExplanationValues, ShadowExplanation, ShadowFact};
pub use gpu_struct::{GpuData, GpuField, GpuStruct};
pub(crate) use layout::binding::layout;
pub use layout::{binding, shadow_layout};
pub(crate) use mask_layers::MASK_FORMAT;
pub use mask_layers::{MAX_MASK_LIGHTS, MaskLayers};
pub use outputs::{ShadowBinding, ShadowOutputs, ShadowTokens};

use shadowgraph_core::{Buffer, Frame, Texture};
use shadowgraph_shaders::ModuleSource;

use crate::error::Error;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;

/// A way of making shadows: nodes for the graph, and a WGSL module that returns how much of a light arrives at a point.
///
/// The first module has `#define_import_path shadowgraph::technique` and the functions
/// `shadow_visibility(light: u32, receiver: Receiver) -> vec3f` (1 lit, 0 in shadow) and
/// `shadow_debug_color(light: u32, receiver: Receiver) -> vec3f`. It is called in loops and from compute passes, so
/// it never uses implicit derivatives. Bind group 1 belongs to the technique alone.
///
/// The value holds what stays the same for all frames: everything that a user can choose comes with the
/// [settings](crate::ShadowSettings) of each frame. Frames call [`add_shadows`], which validates the technique's output.
pub trait ShadowTechnique: Send + Sync {
    /// Returns the name that users choose it by.
    fn name(&self) -> &str;

    /// Returns what it requires of shared services with the current settings. [`add_shadows`] calls it once for each frame.
    ///
    /// # Errors
    /// For settings of the technique that are out of range.
    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error>;

    /// Returns whether it reads [`SurfaceBuffers`].
    fn reads_surface_buffers(&self) -> bool {
        false
    }

    /// Returns whether it traces [the casters' triangles](crate::ShadowCasters::rays).
    fn traces_rays(&self) -> bool {
        false
    }

    /// Returns the number of variants of its WGSL, at least 1. Variant 0 works for every frame; others contain less code,
    /// and [`ShadowOutputs::variant`] is the best one for a frame.
    fn variant_count(&self) -> u32 {
        1
    }

    /// Returns the WGSL modules of a variant: the one with the functions, and those that replace built-in ones.
    fn modules(&self, variant: u32) -> Vec<ModuleSource>;

    /// Returns the type of each binding of group 1, by number. All of them are visible to fragment and compute shaders.
    fn binding_types(&self) -> Vec<wgpu::BindingType>;

    /// Returns the structs that it writes in Rust and reads in WGSL: their layouts are compared when it is registered.
    fn gpu_structs(&self) -> Vec<GpuStruct> {
        Vec::new()
    }

    /// Returns how it explains the shadow at a point to who debugs a pixel, if it does. A technique with the library's maps returns
    /// [`ShadowMaps::explanation`](crate::ShadowMaps::explanation).
    fn explanation(&self) -> Option<ShadowExplanation> {
        None
    }

    /// Adds its passes to the frame. Without a shadowed light or a caster in range it adds none. `requirements` are those that
    /// [`requirements`](Self::requirements) returned for these inputs. `buffers` is `Some` if
    /// [`reads_surface_buffers`](Self::reads_surface_buffers) returns true.
    ///
    /// # Errors
    /// For settings, a camera or an aspect ratio that are out of range; [`Error::MissingSurfaceBuffers`] and [`Error::MissingRays`].
    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error>;
}

/// The visible surfaces, camera and lights, for techniques that read them.
#[derive(Clone, Debug)]
pub struct SurfaceBuffers {
    /// Width and height of the image, pixels.
    pub size_px: [u32; 2],
    /// The camera: the uniform block `view` of `shadowgraph::view`.
    pub view: Buffer,
    /// The lights: the storage buffer `lights` of `shadowgraph::view`.
    pub lights: Buffer,
    /// Positions and normals of all visible surfaces that are not blended: `Rgba32Float`, in the encoding of
    /// `shadowgraph::surface`.
    pub surfaces: Texture,
    /// Whether blended geometry is drawn after the surfaces.
    pub has_blended: bool,
    /// The height of a plane that is lit where nothing is drawn, metres relative to the frame's origin; `None` without one.
    pub ground_height: Option<f32>,
}
