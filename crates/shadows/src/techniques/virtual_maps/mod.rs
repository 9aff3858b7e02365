//! `virtual`: shadow maps with texels where pixels need them.
//!
//! A directional light has a map of 16 levels around the camera, each of 16,384 x 16,384 texels that are twice as wide as those of the level
//! before; a spot light and each face of a point light have a pyramid of levels. Levels are divided into pages of 128 x 128 texels. A pass
//! marks the pages that the visible surfaces are read from, at the level whose texels are at most as wide as a pixel; these have a place in a
//! pool of physical pages, and are drawn when they come in or when a caster in them changes. Everything about pages is decided on the GPU.
//!
//! After Olsson et al., "Efficient Virtual Shadow Maps for Many Lights" (2014), and Sakmary, "Virtual Shadow Maps" (CESCG 2025).

mod explanation;
mod passes;
mod plan;
mod pool_view;
mod projections;
mod settings;
mod slots;
mod store;
mod tints;
mod variant;

pub use settings::VirtualSettings;

use shadowgraph_core::{Frame, Texture};
use shadowgraph_shaders::{ModuleSource, PAGE_EXPLANATION, PAGE_PENUMBRA, PAGE_POOL, PCF_FILTER, VIRTUAL};

use crate::error::Error;
use crate::maps::{comparison_sampler, texel};
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::settings::NamedSettings;
use crate::technique::binding::{COMPARISON_SAMPLER, DEPTH_MAP, STORAGE};
use crate::technique::{ShadowBinding, ShadowExplanation, ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use passes::{FrameBuffers, Passes};
use plan::VirtualPlan;
use store::{POOL_FORMAT, PageNeeds, PoolSize, Stores};
use tints::Tints;
use variant::Variant;

/// Virtual shadow maps. The filter is that of [`Pcf`](crate::Pcf).
pub struct VirtualMaps {
    device: wgpu::Device,
    passes: Passes,
    sampler: wgpu::Sampler,
    stores: Stores,
    /// Zeros in place of all buffers of a frame without shadows, and of the pool.
    nothing: wgpu::Buffer,
    no_pool: wgpu::Texture,
}

impl VirtualMaps {
    /// Creates what stays the same for all frames.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            device: device.clone(),
            passes: Passes::new(device)?,
            sampler: comparison_sampler(device),
            stores: Stores::default(),
            nothing: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("no pages"),
                size: NOTHING_BYTES,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            }),
            no_pool: texel(device, "no page pool", POOL_FORMAT),
        })
    }

    /// Returns the output of a frame in which no light has shadows.
    fn all_lit<'f>(&'f self, frame: &mut Frame<'f>, plan: &VirtualPlan) -> ShadowOutputs<'f> {
        let pool = frame.import_texture("pool", &self.no_pool, true);
        let nothing = || ShadowBinding::ExternalBuffer(&self.nothing);
        let variant = Variant::for_frame(&plan.lights, &plan.projections, false);
        let buffers = [nothing(), nothing(), nothing(), nothing()];
        let pages = [nothing(), nothing(), nothing()];
        self.outputs(variant, (buffers, pages), [pool.clone(), pool], plan)
    }

    fn outputs<'f>(
        &'f self,
        variant: Variant,
        (buffers, pages): ([ShadowBinding<'f>; 4], [ShadowBinding<'f>; 3]),
        [pool, pool_view]: [Texture; 2],
        plan: &VirtualPlan,
    ) -> ShadowOutputs<'f> {
        let mut bindings = Vec::from(buffers);
        bindings.push(ShadowBinding::Texture(pool));
        bindings.push(ShadowBinding::Sampler(&self.sampler));
        bindings.extend(pages);
        ShadowOutputs {
            variant: variant.index(),
            bindings,
            debug_light: plan.main_light,
            debug: vec![("pool", pool_view)],
            unshadowed: plan.unshadowed.clone(),
            ..ShadowOutputs::default()
        }
    }
}

/// As long as the longest element of the buffers.
const NOTHING_BYTES: u64 = 256;

impl ShadowTechnique for VirtualMaps {
    fn name(&self) -> &str {
        VirtualSettings::NAME
    }

    fn requirements(&self, _inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(Requirements::NONE)
    }

    fn reads_surface_buffers(&self) -> bool {
        true
    }

    fn variant_count(&self) -> u32 {
        Variant::COUNT
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        let filter = PCF_FILTER.source.replace("@binding(10)", "@binding(5)");
        let mut modules = vec![
            VIRTUAL,
            PAGE_POOL,
            ModuleSource::new(format!("{} of virtual", PCF_FILTER.file), filter),
            Variant::module(variant),
        ];
        if Variant::has_penumbrae(variant) {
            modules.push(PAGE_PENUMBRA);
        }
        modules
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        vec![STORAGE, STORAGE, STORAGE, STORAGE, DEPTH_MAP, COMPARISON_SAMPLER, STORAGE, STORAGE, STORAGE]
    }

    fn explanation(&self) -> Option<ShadowExplanation> {
        Some(ShadowExplanation { modules: vec![PAGE_EXPLANATION], describe: explanation::describe })
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        _requirements: &Requirements,
        buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let buffers =
            buffers.ok_or_else(|| Error::MissingSurfaceBuffers { technique: self.name().into() })?;
        let settings: VirtualSettings = inputs.settings.techniques.get()?;
        let size =
            PoolSize::new(settings.pool_mib, &self.device.limits()).map_err(|largest| Error::Setting {
                field: "techniques.virtual.pool_mib".into(),
                value: settings.pool_mib.to_string(),
                allowed: format!("a power of two from 4 to {largest} MiB on this device"),
            })?;
        let previous = self.stores.previous(inputs.view);
        let known = previous.map_or_else(Default::default, |store| store.known().clone());
        let plan = VirtualPlan::new(inputs, &settings, &known.slots, size.pages, buffers.size_px[1])?;
        if plan.is_empty() {
            return Ok(self.all_lit(frame, &plan));
        }
        let casters = inputs.casters.layered();
        let casters = casters.ok_or_else(|| Error::MissingLayers { technique: self.name().into() })?;
        let tinted = casters.any_tints();
        let needs = PageNeeds { size, entry_count: plan.slots.entry_count(), tinted };
        let store = self.stores.fitting(&self.device, inputs.view, needs);
        let known = store.known().clone();
        let (next, boxes) = known.next((inputs.casters, casters), inputs.origin_world, plan.slots.clone());
        frame.node("shadows", |frame| {
            let inputs = (inputs, buffers, &settings);
            let store = (&store, next, &boxes);
            let FrameBuffers { projections, levels, lights, table, pages, pool, tints, pool_view } =
                self.passes.add_to(frame, inputs, (&plan, casters), store);
            let variant = Variant::for_frame(&plan.lights, &plan.projections, tinted);
            let buffers = [projections, levels, lights, table].map(ShadowBinding::Buffer);
            let [depths, densities] = match tints {
                Some(Tints { depths, densities }) => [depths, densities].map(ShadowBinding::Buffer),
                None => [&self.nothing; 2].map(ShadowBinding::ExternalBuffer),
            };
            let pages = [depths, densities, ShadowBinding::Buffer(pages)];
            Ok(self.outputs(variant, (buffers, pages), [pool, pool_view], &plan))
        })
    }
}
