//! The shadow maps of a frame: planned, drawn, and cached where the settings say so.

pub(crate) mod cache;
mod contents;
mod draw;
mod explanation;
mod kept;
mod queries;
mod reasons;
mod restore;
mod scroll;
mod store_draws;
mod tile;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, PoisonError};

use cache::{CachedMap, Revision};
use draw::{ATLAS, CASCADES, Source};
use restore::Restore;
use shadowgraph_core::{Buffer, Frame, Texture};
use shadowgraph_shaders::MAPPED_EXPLANATION;

use crate::atlas::TileRect;
use crate::caster_view::{TINT_FORMAT, caster_view_layout};
use crate::error::Error;
use crate::lookup_variant::{FEW_VIEWS, LookupVariant};
use crate::plan::{PlanState, ShadowInputs, ShadowPlan};
use crate::planner::plan_shadows_after;
use crate::requirements::Requirements;
use crate::select::Unshadowed;
use crate::technique::binding::{DEPTH_MAP, FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{ShadowBinding, ShadowExplanation, ShadowOutputs};
use crate::views::ShadowView;

/// The common part of techniques with shadow maps: it plans the maps of each frame, and draws casters into their tiles.
///
/// A technique adds passes that process the maps, and its own way to read them: the modules [`MAPPED`](shadowgraph_shaders::MAPPED)
/// and, as `shadowgraph::shadows::filter`, its own with the functions `filtered` and `filter_radius`.
pub struct ShadowMaps {
    /// Group 0 of the passes that draw casters.
    view_layout: wgpu::BindGroupLayout,
    /// A lit placeholder of one texel for a missing map.
    lit: wgpu::Texture,
    /// A placeholder of one texel, never read, for missing tints.
    untinted: wgpu::Texture,
    /// A placeholder, never read, for uniform blocks of views and lights.
    no_block: wgpu::Buffer,
    device: wgpu::Device,
    /// What plans follow, by view.
    states: Mutex<BTreeMap<u32, PlanState>>,
    /// The cached maps, by view and name.
    cached: Mutex<BTreeMap<(u32, &'static str), Arc<CachedMap>>>,
    /// The number of revisions so far.
    revisions: AtomicU64,
    /// Pipelines that copy kept depth, by format.
    restore: Mutex<Vec<(wgpu::TextureFormat, Arc<Restore>)>>,
}

/// The maps of one view in a frame.
pub struct DrawnMaps {
    /// The plan's [`ShadowView`]s.
    pub views: Buffer,
    /// The plan's [`ShadowLight`](crate::ShadowLight)s.
    pub lights: Buffer,
    /// The buffers of views and lights, or placeholders if the variant reads no uniform blocks.
    blocks: [Buffer; 2],
    /// The map of cascades, or a lit placeholder.
    pub cascades: DrawnMap,
    /// The map of other lights, or a lit placeholder.
    pub atlas: DrawnMap,
    /// The variant of the shader that looks shadows up in them.
    pub variant: LookupVariant,
    /// See [`ShadowPlan::main_light`]; 0 if there is none.
    pub main_light: u32,
    /// See [`ShadowPlan::colored_lights`].
    pub colored_lights: Vec<u32>,
    /// The lights with `casts_shadow` that have no shadows, and why.
    pub unshadowed: Vec<Unshadowed>,
}

/// A map in a frame.
pub struct DrawnMap {
    /// Depth: 1 nearest to the light, 0 farthest, and 0 where nothing is drawn.
    pub texture: Texture,
    /// Transmittance of translucent casters, linear; without such casters a placeholder that is not read.
    pub tints: Texture,
    /// Depth of the translucent casters nearest to the light, or a placeholder.
    pub tint_depths: Texture,
    /// The tiles and the indices of their views; empty without a map.
    pub tiles: Vec<(TileRect, u32)>,
    /// The revisions of the contents of the tiles; empty if the map is not kept.
    pub(crate) revisions: Vec<Revision>,
}

impl ShadowMaps {
    /// The types of the first ten bindings of group 1 of every technique that reads these maps: those of
    /// [`DrawnMaps::bindings`].
    pub const BINDING_TYPES: [wgpu::BindingType; 10] = [
        STORAGE, STORAGE, DEPTH_MAP, DEPTH_MAP, FLOAT_MAP, FLOAT_MAP, DEPTH_MAP, DEPTH_MAP, UNIFORM, UNIFORM,
    ];

    /// Returns the [explanation](crate::ShadowTechnique::explanation) of a technique with these maps and
    /// [`MAPPED`](shadowgraph_shaders::MAPPED): the tile that a point is read from, depths and biases.
    pub fn explanation() -> ShadowExplanation {
        ShadowExplanation { modules: vec![MAPPED_EXPLANATION], describe: explanation::describe }
    }

    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            view_layout: caster_view_layout(device),
            // Zero is the far end of reversed depth: everything is lit.
            lit: texel(device, "no shadows", wgpu::TextureFormat::Depth32Float),
            untinted: texel(device, "no tints", TINT_FORMAT),
            no_block: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("no uniform block"),
                size: (FEW_VIEWS * size_of::<ShadowView>()) as u64,
                usage: wgpu::BufferUsages::UNIFORM,
                mapped_at_creation: false,
            }),
            device: device.clone(),
            states: Mutex::default(),
            cached: Mutex::default(),
            revisions: AtomicU64::default(),
            restore: Mutex::default(),
        }
    }

    /// Plans the maps of a view, and adds the passes that draw them. Tiles without casters have no pass. `requirements` are the
    /// technique's.
    ///
    /// # Errors
    /// As [`plan_shadows`](crate::plan_shadows).
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
    ) -> Result<DrawnMaps, Error> {
        self.add_fitted(frame, inputs, requirements, |_, _, views, _| views.clone())
    }

    /// Adds the passes as [`add_to`](Self::add_to) does, with views that GPU passes write: `fit` receives the plan and the
    /// buffers of its views and lights, and returns the buffer of views to use. This needs [`Requirements::fits_on_gpu`].
    ///
    /// # Errors
    /// As `add_to`.
    pub fn add_fitted<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        fit: impl FnOnce(&mut Frame<'f>, &ShadowPlan, &Buffer, &Buffer) -> Buffer,
    ) -> Result<DrawnMaps, Error> {
        let plan = self.plan(inputs, requirements)?;
        let (variant, main_light) = (plan.variant(), plan.main_light().unwrap_or(0));
        let (views, lights) = frame.node("set up views", |frame| {
            let views = frame.upload_buffer("shadow views", plan.view_bytes(variant));
            (views, frame.upload_buffer("shadow lights", plan.light_bytes(variant)))
        });
        let views = fit(frame, &plan, &views, &lights);
        let source = Source {
            view: inputs.view,
            origin_world: inputs.origin_world,
            views: (&views, &plan.views[..]),
            casters: inputs.casters,
        };
        let cascades = self.map(frame, CASCADES, plan.cascades.as_ref(), source)?;
        let atlas = self.map(frame, ATLAS, plan.atlas.as_ref(), source)?;
        let blocks = if variant.reads_uniforms() {
            [views.clone(), lights.clone()]
        } else {
            let no_block = frame.import_buffer("no uniform block", &self.no_block, true);
            [no_block.clone(), no_block]
        };
        let (colored_lights, unshadowed) = (plan.colored_lights(), plan.unshadowed);
        Ok(DrawnMaps {
            views,
            lights,
            blocks,
            cascades,
            atlas,
            variant,
            main_light,
            colored_lights,
            unshadowed,
        })
    }

    /// Plans a frame that follows the previous one of the same view.
    fn plan(&self, inputs: &ShadowInputs<'_>, requirements: &Requirements) -> Result<ShadowPlan, Error> {
        let mut states = self.states.lock().unwrap_or_else(PoisonError::into_inner);
        let plan = plan_shadows_after(inputs, states.get(&inputs.view), requirements)?;
        states.insert(inputs.view, plan.state.clone());
        Ok(plan)
    }
}

impl DrawnMaps {
    /// Returns the first ten bindings of group 1, as `views.wgsl`, `maps.wgsl` and `few_views.wgsl` declare them: views, lights, the
    /// two depth maps, their tints, the depths of the tints, and views and lights as uniform blocks.
    #[must_use]
    pub fn bindings<'f>(&self) -> Vec<ShadowBinding<'f>> {
        vec![
            ShadowBinding::Buffer(self.views.clone()),
            ShadowBinding::Buffer(self.lights.clone()),
            ShadowBinding::Texture(self.cascades.texture.clone()),
            ShadowBinding::Texture(self.atlas.texture.clone()),
            ShadowBinding::Texture(self.cascades.tints.clone()),
            ShadowBinding::Texture(self.atlas.tints.clone()),
            ShadowBinding::Texture(self.cascades.tint_depths.clone()),
            ShadowBinding::Texture(self.atlas.tint_depths.clone()),
            ShadowBinding::UniformBuffer(self.blocks[0].clone()),
            ShadowBinding::UniformBuffer(self.blocks[1].clone()),
        ]
    }

    /// Returns the output of a technique with these maps and bindings: variant 0, no mask, and the maps for debugging.
    #[must_use]
    pub fn outputs<'f>(self, bindings: Vec<ShadowBinding<'f>>) -> ShadowOutputs<'f> {
        ShadowOutputs {
            bindings,
            debug_light: self.main_light,
            debug: vec![("cascades", self.cascades.texture), ("atlas", self.atlas.texture)],
            map_buffers: Some([self.views, self.lights]),
            colored_lights: self.colored_lights,
            unshadowed: self.unshadowed,
            ..ShadowOutputs::default()
        }
    }
}

/// Creates one texel of zeros, with which wgpu initializes new textures.
pub(crate) fn texel(device: &wgpu::Device, label: &str, format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        // Copied where frames are captured.
        usage: wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// The buffer of a frame's views, and the planned views.
type Views<'v> = (&'v Buffer, &'v [ShadowView]);

/// Creates a sampler that filters four comparisons: lit where the point is at least as near to the light as the map's depth.
pub(crate) fn comparison_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow comparison"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::GreaterEqual),
        ..Default::default()
    })
}
