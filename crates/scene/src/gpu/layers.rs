//! Casters in many views at once, each in a layer of a buffer of depths: `depth_layers.wgsl`.

use std::borrow::Cow;
use std::num::NonZeroU64;

use super::draw_list::{Draw, DrawPipeline, MaterialUse};
use super::geometry::vertex_layout;
use super::materials::MaterialLayouts;
use super::scene::GpuScene;
use crate::error::Error;
use crate::material::CasterMode;

/// Distance between the draws of batches, bytes: the alignment of dynamic offsets on every device.
pub const LAYER_DRAW_BYTES: u64 = 256;

/// The format of the colour target of [`LayerPipelines`], which nothing is written to.
pub const LAYER_TARGET: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// A pipeline for each [`CasterMode`] that writes depth, or tints, into layers of a buffer, without culling: a single-sided wall casts a shadow
/// to both sides. The viewport must be as large as a layer.
///
/// Group 0 is [`view_layout`](Self::view_layout) or [`tint_layout`](Self::tint_layout), group 1 is unused.
pub struct LayerPipelines {
    view_layout: wgpu::BindGroupLayout,
    solid: wgpu::RenderPipeline,
    clip: wgpu::RenderPipeline,
    dither: wgpu::RenderPipeline,
    tint_layout: wgpu::BindGroupLayout,
    tint: wgpu::RenderPipeline,
}

impl LayerPipelines {
    /// Creates the pipelines.
    ///
    /// # Errors
    ///
    /// [`Error::Shader`] if the shader cannot be composed.
    pub fn new(device: &wgpu::Device, layouts: &MaterialLayouts) -> Result<Self, Error> {
        let name = "depth_layers.wgsl";
        let module = shadowgraph_shaders::compose(name, &[])
            .map_err(|error| Error::Shader { name: name.to_owned(), reason: error.to_string() })?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(name),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let (view_layout, tint_layout) = (layer_layout(device, false), layer_layout(device, true));
        let pipeline = |vertex, fragment, view, material| {
            create(device, &shader, (vertex, fragment), &[Some(view), None, material, Some(&layouts.draw)])
        };
        let material = Some(&layouts.material);
        Ok(Self {
            solid: pipeline("vs_layer", "fs_layer", &view_layout, None),
            clip: pipeline("vs_layer_alpha", "fs_layer_clip", &view_layout, material),
            dither: pipeline("vs_layer_alpha", "fs_layer_dither", &view_layout, material),
            tint: pipeline("vs_layer_tint", "fs_layer_tint", &tint_layout, material),
            view_layout,
            tint_layout,
        })
    }

    /// Returns the pipeline for casters of a mode; `None` for those that cast no shadow or tint.
    #[must_use]
    pub fn get(&self, mode: CasterMode) -> Option<DrawPipeline<'_>> {
        let (pipeline, material) = match mode {
            CasterMode::On => (&self.solid, MaterialUse::None),
            CasterMode::Clip => (&self.clip, MaterialUse::Alpha),
            CasterMode::Dither => (&self.dither, MaterialUse::Alpha),
            CasterMode::Tint | CasterMode::Off => return None,
        };
        Some(DrawPipeline { pipeline, material })
    }

    /// Returns the pipeline for the tints of casters of a mode; `None` for those that do not tint.
    #[must_use]
    pub fn get_tint(&self, mode: CasterMode) -> Option<DrawPipeline<'_>> {
        (mode == CasterMode::Tint)
            .then_some(DrawPipeline { pipeline: &self.tint, material: MaterialUse::All })
    }

    /// Returns the layout of group 0, all storage buffers: the views, the depths, and the draws with a dynamic offset.
    #[must_use]
    pub fn view_layout(&self) -> &wgpu::BindGroupLayout {
        &self.view_layout
    }

    /// Returns the layout of group 0 for tints: as [`view_layout`](Self::view_layout), then the depths and the densities of tints.
    #[must_use]
    pub fn tint_layout(&self) -> &wgpu::BindGroupLayout {
        &self.tint_layout
    }
}

/// The draws of layers.
#[derive(Clone, Copy, Debug)]
pub struct LayerDraws<'v> {
    /// Group 0: see [`LayerPipelines`].
    pub views: &'v wgpu::BindGroup,
    /// Group 3: the transforms, and pairs of an instance and a view.
    pub pairs: &'v wgpu::BindGroup,
    /// The draw of each batch, [`LAYER_DRAW_BYTES`] apart: the arguments of an indexed indirect draw, and the first pair.
    pub draws: &'v wgpu::Buffer,
}

impl GpuScene {
    /// Records the draws of layers, of the batches that have a pipeline. Sets the same state as [`draw`](Self::draw), and group 0. Returns
    /// the number of draw calls.
    pub fn draw_layers<'p>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        layers: LayerDraws<'_>,
        pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
    ) -> u32 {
        self.geometry.set_indices(pass);
        pass.set_bind_group(3, layers.pairs, &[0]);
        let (mut last_pipeline, mut is_posed, mut count) = (None, None, 0);
        for (index, batch) in (0u64..).zip(self.batches.list()) {
            let draw = &batch.draw;
            let Some(pipeline) = pipeline_for(draw) else { continue };
            let Some(group) = self.materials.group(draw.material) else { continue };
            let Some(ranges) = self.geometry.ranges(draw.mesh) else { continue };
            if last_pipeline != Some(pipeline.pipeline) {
                pass.set_pipeline(pipeline.pipeline);
                last_pipeline = Some(pipeline.pipeline);
            }
            if pipeline.material != MaterialUse::None {
                pass.set_bind_group(2, group.get(pipeline.material), &[]);
            }
            if draw.posed.is_some() {
                self.posed.set_vertices(pass, ranges.vertex_count());
            } else if is_posed != Some(false) {
                self.geometry.set_vertices(pass);
            }
            is_posed = Some(draw.posed.is_some());
            let offset = index * LAYER_DRAW_BYTES;
            pass.set_bind_group(0, layers.views, &[offset as u32]);
            pass.draw_indexed_indirect(layers.draws, offset);
            count += 1;
        }
        count
    }
}

fn create(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    (vertex, fragment): (&str, &str),
    layouts: &[Option<&wgpu::BindGroupLayout>],
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("depth layers"),
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let first_instance = device.features().contains(wgpu::Features::INDIRECT_FIRST_INSTANCE);
    let constants = [("FIRST_INSTANCE", f64::from(u8::from(first_instance)))];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("depth layers"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some(vertex),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            buffers: &[Some(vertex_layout())],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some(fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: LAYER_TARGET,
                blend: None,
                write_mask: wgpu::ColorWrites::empty(),
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn layer_layout(device: &wgpu::Device, has_tints: bool) -> wgpu::BindGroupLayout {
    let entry = |binding, visibility, read_only, has_dynamic_offset| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset,
            min_binding_size: if has_dynamic_offset { NonZeroU64::new(24) } else { None },
        },
        count: None,
    };
    let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
    let mut entries = vec![
        entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT, true, false),
        entry(1, fragment, false, false),
        entry(2, vertex, true, true),
    ];
    if has_tints {
        entries.extend([3, 4].map(|binding| entry(binding, fragment, false, false)));
    }
    let label = Some("depth layers");
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
}
