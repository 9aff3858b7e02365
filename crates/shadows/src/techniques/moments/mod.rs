//! `evsm` and `msm`: maps of moments of depth, which can be blurred and downsampled like colours.
//!
//! The depth maps are drawn as for [`Pcf`](crate::Pcf). Passes then turn them into moments (`prefilter.wgsl`). Lit passes read
//! four texels and compute an upper bound of how much of the light is blocked (`shadows/moments.wgsl`).

mod evsm;
mod kept;
mod msm;
mod prefilter;

pub use evsm::{EvsmMoments, EvsmPrecision, EvsmSettings};
pub use msm::MsmSettings;

use shadowgraph_core::{Format, Frame};
use shadowgraph_shaders::{MAPPED, MOMENTS, ModuleSource};

use crate::error::Error;
use crate::light_params::settings_requirements;
use crate::lookup_variant::LookupVariant;
use crate::maps::ShadowMaps;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::settings::{NamedSettings, Setting, refused};
use crate::technique::binding::UNIFORM;
use crate::technique::{GpuData, GpuStruct};
use crate::technique::{ShadowBinding, ShadowExplanation, ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use prefilter::{Prefilter, Settings};

/// `evsm`: two or four exponentially warped moments (Lauritzen and McCool, "Layered Variance Shadow Maps", 2008).
pub type Evsm = MomentShadows<EvsmSettings>;

/// `msm`: four moments in 16 bits each (Peters and Klein, "Moment Shadow Mapping", 2015).
pub type Msm = MomentShadows<MsmSettings>;

/// A technique whose maps store moments of depth. Its settings say which moments.
pub struct MomentShadows<S> {
    maps: ShadowMaps,
    prefilter: Prefilter,
    settings: std::marker::PhantomData<fn() -> S>,
}

/// The differences between the techniques that use moments.
pub trait Moments: NamedSettings {
    /// Number of encodings in which moments can be stored.
    const LAYOUTS: u32;

    /// Returns the modules of an encoding: `shadowgraph::shadows::encoding`, and those that replace built-in ones.
    fn modules(layout: u32) -> Vec<ModuleSource>;

    /// Returns the texture format of an encoding: one, two or four 32-bit integers.
    fn format(layout: u32) -> Format;

    /// Returns the encoding that these settings select, below [`LAYOUTS`](Self::LAYOUTS).
    fn layout(&self) -> u32;

    /// Returns the sizes of the map of moments.
    fn moment_map(&self) -> MomentMap;
}

/// The sizes of a map of moments, and its blur.
#[derive(Clone, Copy, Debug)]
pub struct MomentMap {
    /// Number of depth texels per moment texel along each axis.
    pub downscale: u32,
    /// Radius of the blur, texels of moments.
    pub blur_texels: u32,
    /// Number of mip levels.
    pub mips: u32,
}

impl MomentMap {
    /// Returns the radius around a point within which the depth map is read, texels.
    fn kernel_radius_texels(&self) -> f32 {
        self.downscale as f32 * self.blur_texels as f32 + 1.5 * self.coarsest_texels() as f32
    }

    /// Returns the width of a texel of the smallest mip level, texels of the depth map.
    fn coarsest_texels(&self) -> u32 {
        self.downscale << (self.mips - 1)
    }

    /// Returns the requirements of a technique with such a map.
    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Requirements {
        let base = settings_requirements(inputs.settings);
        Requirements {
            kernel_radius_texels: base.kernel_radius_texels.max(self.kernel_radius_texels()),
            step_texels: self.coarsest_texels(),
            ..base
        }
    }

    /// Checks the width of the filter, which follows from several settings.
    fn check(&self, settings: &'static [Setting]) -> Result<(), Error> {
        match self.kernel_radius_texels() > 24.0 {
            true => Err(refused(settings, "blur_texels", self.blur_texels)),
            false => Ok(()),
        }
    }
}

impl<S: Moments> MomentShadows<S> {
    /// Creates what stays the same for all frames.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let prefilter = Prefilter::new::<S>(device)?;
        Ok(Self { maps: ShadowMaps::new(device), prefilter, settings: std::marker::PhantomData })
    }
}

impl<S: Moments> ShadowTechnique for MomentShadows<S> {
    fn name(&self) -> &str {
        S::NAME
    }

    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(inputs.settings.techniques.get::<S>()?.moment_map().requirements(inputs))
    }

    fn variant_count(&self) -> u32 {
        S::LAYOUTS * LookupVariant::count_without_taps()
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        let lookup = LookupVariant::modules(variant / S::LAYOUTS);
        [vec![MAPPED, MOMENTS], lookup, S::modules(variant % S::LAYOUTS)].concat()
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        [&ShadowMaps::BINDING_TYPES[..], &[prefilter::MOMENT_MAP, prefilter::MOMENT_MAP, UNIFORM]].concat()
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        vec![GpuStruct::new::<S>("MomentSettings")]
    }

    fn explanation(&self) -> Option<ShadowExplanation> {
        Some(ShadowMaps::explanation())
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        _buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let own: S = inputs.settings.techniques.get()?;
        let (layout, sizes) = (own.layout(), own.moment_map());
        frame.node("shadows", |frame| {
            let maps = self.maps.add_to(frame, inputs, requirements)?;
            let bytes = own.bytes();
            let block = frame.uniform(&bytes);
            let settings = Settings { encoding: layout, sizes, bytes: &bytes, block };
            let mut moments =
                |name, map| self.prefilter.add_to(frame, (inputs.view, name), map, &maps.views, &settings);
            let cascades = moments("cascade moments", &maps.cascades);
            let atlas = moments("atlas moments", &maps.atlas);
            let mut bindings = maps.bindings();
            bindings.extend([cascades, atlas].map(ShadowBinding::Texture));
            bindings.push(ShadowBinding::Uniform(block));
            let variant = layout + S::LAYOUTS * maps.variant.without_taps().index();
            Ok(ShadowOutputs { variant, ..maps.outputs(bindings) })
        })
    }
}
