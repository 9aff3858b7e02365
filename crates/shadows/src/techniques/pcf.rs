//! `pcf`: cascades for the main light, an atlas for the others, percentage-closer filtering with a 5 x 5 tent.

use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_shaders::{ModuleSource, PCF};

use crate::plan;
use crate::technique::{ShadowBinding, ShadowOutputs, ShadowTechnique};
use crate::{
    CasterTarget, Error, MapPlan, Needs, ShadowCasters, ShadowInputs, ShadowView, TilePlan,
    caster_view_layout, plan_shadows,
};

/// The format of both maps.
const MAP_FORMAT: Format = Format::Depth32Float;

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
}

impl Pcf {
    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            layout: group_layout(device),
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
                format: MAP_FORMAT,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            }),
        }
    }

    /// Adds the pass that draws a map, or imports the texel that means lit.
    fn map<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        plan: Option<MapPlan>,
        views: (&Buffer, &[ShadowView]),
        casters: &'f dyn ShadowCasters,
    ) -> Texture {
        let Some(plan) = plan else {
            return frame.import_texture(format!("no {name}"), &self.lit, true);
        };
        let [width, height] = plan.size_px;
        let mut map = frame.create_texture(name, TextureDesc::d2(width, height, MAP_FORMAT));
        frame.node(name, |frame| {
            let mut pass = frame.render_pass(name);
            let buffer = pass.storage_buffer(views.0);
            pass.depth(&mut map, Contents::clear_depth(0.0));
            let target = |tile: &TilePlan| CasterTarget {
                format: MAP_FORMAT,
                perspective: views.1[tile.view as usize].light.w != 0.0,
            };
            let tiles: Vec<_> = plan.tiles.into_iter().map(|tile| (target(&tile), tile)).collect();
            let layout = &self.view_layout;
            pass.body(move |ctx| {
                let group = ctx.bind_group(layout, &[Bind::BufferRange(buffer, 0..VIEW_BYTES)])?;
                for (target, tile) in tiles.iter().filter(|(_, tile)| !tile.casters.is_empty()) {
                    ctx.pass.set_bind_group(0, &group, &[tile.view * VIEW_BYTES as u32]);
                    draw_tile(&mut ctx.pass, tile, *target, casters);
                }
                Ok(())
            });
        });
        map
    }
}

fn draw_tile(
    pass: &mut wgpu::RenderPass<'_>,
    tile: &TilePlan,
    target: CasterTarget,
    casters: &dyn ShadowCasters,
) {
    let rect = tile.rect;
    let [x, y, width, height] = [rect.x, rect.y, rect.width, rect.height].map(|px| px as f32);
    pass.set_viewport(x, y, width, height, 0.0, 1.0);
    pass.set_scissor_rect(rect.x, rect.y, rect.width, rect.height);
    casters.draw(pass, target, &tile.casters);
}

impl ShadowTechnique for Pcf {
    fn name(&self) -> &str {
        "pcf"
    }

    fn needs(&self, inputs: &ShadowInputs<'_>) -> Needs {
        plan::needs(inputs.settings)
    }

    fn module(&self) -> ModuleSource {
        PCF
    }

    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let plan = plan_shadows(inputs)?;
        let outputs = frame.node("shadows", |frame| {
            let (views, lights) = frame.node("set up views", |frame| {
                let views = frame.upload_buffer("shadow views", plan.view_bytes());
                (views, frame.upload_buffer("shadow lights", plan.light_bytes()))
            });
            let of = (&views, &plan.views[..]);
            let cascades = self.map(frame, "cascades", plan.cascades, of, inputs.casters);
            let atlas = self.map(frame, "atlas", plan.atlas, of, inputs.casters);
            ShadowOutputs {
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

fn group_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let storage = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    let entries: Vec<_> = (0..)
        .zip([storage, storage, map, map, sampler])
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        })
        .collect();
    let label = Some("pcf shadows");
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
}
