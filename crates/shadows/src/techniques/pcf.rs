//! `pcf`: cascades for the brightest directional lights, an atlas for the others, percentage-closer filtering.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, Part, Texture, TextureDesc};
use shadowgraph_shaders::{ModuleSource, PCF};

use super::cache::{CachedMap, TileKey};
use super::layout::{STORAGE, layout};
use super::variant::PcfVariant;
use crate::plan;
use crate::technique::{Screen, ShadowBinding, ShadowOutputs, ShadowTechnique};
use crate::{
    Allotment, Error, MapPlan, Needs, ShadowCasters, ShadowInputs, ShadowPlan, ShadowView, TilePart,
    TilePlan, TileRect, caster_view_layout, plan_shadows_after,
};

/// The bytes of a view: also the step of its dynamic offset.
const VIEW_BYTES: u64 = size_of::<ShadowView>() as u64;

/// The default technique; see the module `shadows/pcf.wgsl` for how its maps are read.
pub struct Pcf {
    layout: wgpu::BindGroupLayout,
    /// Group 0 of the passes that draw casters.
    view_layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
    /// One texel that means lit, where there is no map.
    lit: wgpu::Texture,
    device: wgpu::Device,
    /// The tiles that lights had in the last frame, of each view.
    allotments: Mutex<BTreeMap<u32, Allotment>>,
    /// The maps that are kept, by view and name.
    cached: Mutex<BTreeMap<(u32, &'static str), Arc<CachedMap>>>,
}

impl Pcf {
    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            layout: layout(device, "pcf shadows", &binding_types()),
            view_layout: caster_view_layout(device),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("shadow comparison"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::GreaterEqual),
                ..Default::default()
            }),
            // wgpu fills a new texture with zeros: the far end of reversed depth, in front of which all is lit.
            lit: device.create_texture(&wgpu::TextureDescriptor {
                label: Some("no shadows"),
                size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Depth32Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            }),
            device: device.clone(),
            allotments: Mutex::default(),
            cached: Mutex::default(),
        }
    }

    /// Plans a frame after the last one of the same view.
    fn plan(&self, inputs: &ShadowInputs<'_>) -> Result<ShadowPlan, Error> {
        let mut allotments = self.allotments.lock().unwrap_or_else(PoisonError::into_inner);
        let plan = plan_shadows_after(inputs, allotments.get(&inputs.view))?;
        allotments.insert(inputs.view, plan.allotment.clone());
        Ok(plan)
    }

    /// Adds the passes that draw a map, or imports the texel that means lit.
    fn map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: Option<MapPlan>,
        (view, views): (u32, Views<'_>),
        casters: &'f dyn ShadowCasters,
    ) -> Texture {
        let cached = plan.as_ref().filter(|plan| plan.cache).map(|plan| self.cached_map(view, name, plan));
        if cached.is_none() {
            self.cached.lock().unwrap_or_else(PoisonError::into_inner).remove(&(view, name));
        }
        match (plan, cached) {
            (None, _) => frame.import_texture(format_args!("no {name}"), &self.lit, true),
            (Some(plan), None) => self.draw_map(frame, name, plan, views, casters),
            (Some(plan), Some(cached)) => self.update_map(frame, name, plan, (cached, views), casters),
        }
    }

    /// Draws a map anew.
    fn draw_map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: MapPlan,
        views: Views<'_>,
        casters: &'f dyn ShadowCasters,
    ) -> Texture {
        let [width, height] = plan.size_px;
        let format = plan.depth.texture_format();
        let mut map = frame.create_texture(name, TextureDesc::d2(width, height, format));
        frame.node(name, |frame| {
            // All of the map, as shaders sample it whole and its tiles need not cover it. Tiles do not overlap, so
            // nothing orders them among each other, and all become one render pass that begins with this clear.
            frame.render_pass("clear").depth(&mut map, Contents::clear_depth(0.0));
            for tile in plan.tiles.into_iter().filter(|tile| !tile.casters.is_empty()) {
                self.tile(frame, (&mut map, format, Contents::Preserve), tile, views, casters, |_| ());
            }
        });
        map
    }

    /// Draws those tiles of a map again that do not hold what they should.
    fn update_map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: MapPlan,
        (cached, views): (Arc<CachedMap>, Views<'_>),
        casters: &'f dyn ShadowCasters,
    ) -> Texture {
        let format = plan.depth.texture_format();
        let cleared = cached.is_cleared();
        let mut map = frame.import_texture(name, &cached.texture, cleared);
        frame.node(name, |frame| {
            if !cleared {
                let cached = cached.clone();
                let mut pass = frame.render_pass("clear");
                pass.depth(&mut map, Contents::clear_depth(0.0));
                pass.body(move |_| {
                    cached.note_clear();
                    Ok(())
                });
            }
            for tile in plan.tiles {
                let key = TileKey::new(&tile, &views.1[tile.view as usize], casters);
                if key.as_ref().is_some_and(|key| cached.holds(tile.rect, key)) {
                    continue;
                }
                // What a pass has drawn is known when it has been recorded, not when it is declared.
                let cached = cached.clone();
                let note = move |rect| cached.note(rect, key);
                self.tile(frame, (&mut map, format, Contents::clear_depth(0.0)), tile, views, casters, note);
            }
        });
        map
    }

    fn cached_map(&self, view: u32, name: &'static str, plan: &MapPlan) -> Arc<CachedMap> {
        let mut all = self.cached.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || Arc::new(CachedMap::new(&self.device, name, plan));
        let cached = all.entry((view, name)).or_insert_with(make);
        if !cached.fits(plan) {
            *cached = make();
        }
        cached.clone()
    }

    /// Adds the pass that draws casters into a tile; `then` is called when it has been recorded.
    fn tile<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (map, format, contents): (&mut Texture, Format, Contents),
        tile: TilePlan,
        (buffer, views): Views<'_>,
        casters: &'f dyn ShadowCasters,
        then: impl FnOnce(TileRect) + Send + 'f,
    ) {
        let light = tile.light;
        let mut pass = match tile.part {
            TilePart::Cascade(cascade) => frame.render_pass(format_args!("cascade {cascade}")),
            TilePart::Face(face) => frame.render_pass(format_args!("light {light} face {face}")),
            TilePart::Whole => frame.render_pass(format_args!("light {light}")),
        };
        let buffer = pass.storage_buffer(buffer);
        // The graph keeps viewport and scissor to the tile.
        pass.on(Part::WHOLE.rect(tile.rect.into())).depth(map, contents);
        let caster_view = tile.caster_view(&views[tile.view as usize], format);
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.view_layout, &[Bind::BufferRange(buffer, 0..VIEW_BYTES)])?;
            ctx.pass.set_bind_group(0, &group, &[tile.view * VIEW_BYTES as u32]);
            casters.draw(&mut ctx.pass, &caster_view, &tile.casters);
            then(tile.rect);
            Ok(())
        });
    }
}

/// The buffer of a frame's views, and the views.
type Views<'v> = (&'v Buffer, &'v [ShadowView]);

impl ShadowTechnique for Pcf {
    fn name(&self) -> &str {
        "pcf"
    }

    fn needs(&self, inputs: &ShadowInputs<'_>) -> Needs {
        plan::needs(inputs.settings)
    }

    fn variant_count(&self) -> u32 {
        PcfVariant::COUNT
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        vec![PCF, PcfVariant::from_index(variant).module()]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        binding_types().into()
    }

    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        _screen: Option<&Screen>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let plan = self.plan(inputs)?;
        let variant = plan.variant().index();
        let debug_light = plan.main_light().unwrap_or(0);
        let outputs = frame.node("shadows", |frame| {
            let (views, lights) = frame.node("set up views", |frame| {
                let views = frame.upload_buffer("shadow views", plan.view_bytes());
                (views, frame.upload_buffer("shadow lights", plan.light_bytes()))
            });
            let of = (inputs.view, (&views, &plan.views[..]));
            let cascades = self.map(frame, "cascades", plan.cascades, of, inputs.casters);
            let atlas = self.map(frame, "atlas", plan.atlas, of, inputs.casters);
            ShadowOutputs {
                variant,
                debug_light,
                debug: vec![("cascades", cascades.clone()), ("atlas", atlas.clone())],
                bindings: vec![
                    ShadowBinding::Buffer(views),
                    ShadowBinding::Buffer(lights),
                    ShadowBinding::Texture(cascades),
                    ShadowBinding::Texture(atlas),
                    ShadowBinding::Sampler(&self.sampler),
                ],
                unshadowed: plan.unshadowed,
            }
        });
        Ok(outputs)
    }
}

/// What each binding of group 1 is: `pcf.wgsl`.
fn binding_types() -> [wgpu::BindingType; 5] {
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    [STORAGE, STORAGE, map, map, sampler]
}
