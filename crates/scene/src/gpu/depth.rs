//! Pipelines that draw depth alone: the prepass and shadow maps.

use std::borrow::Cow;
use std::num::NonZeroU64;

use super::draw_list::{DrawPipeline, MaterialUse};
use super::geometry::vertex_layout;
use super::key::{AlphaKey, PipelineKey};
use super::materials::MaterialLayouts;
use crate::error::Error;
use crate::material::CasterMode;

/// The target and the state of depth pipelines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthTarget {
    /// The format of the depth texture.
    pub format: wgpu::TextureFormat,
    /// Clamps geometry in front of the near plane to depth 1: by `Features::DEPTH_CLIP_CONTROL` where the device has
    /// it, else in the fragment shader.
    pub clamp_near: bool,
    /// Slope-scaled depth bias: a factor of the maximum depth slope per pixel. Depth is reversed: negative values push
    /// surfaces away.
    pub slope_bias: f32,
    /// Samples per pixel.
    pub samples: u32,
    /// The format of the colour target of [`CasterPipelines::tint`].
    pub tint_format: wgpu::TextureFormat,
    /// Clamps in the fragment shader even where the device could do it, for tests of that path.
    pub emulate_clamp: bool,
}

impl Default for DepthTarget {
    /// Returns `Depth32Float` and `Rgba8Unorm`, one sample, without clamping or bias.
    fn default() -> Self {
        Self {
            format: wgpu::TextureFormat::Depth32Float,
            clamp_near: false,
            slope_bias: 0.0,
            samples: 1,
            tint_format: wgpu::TextureFormat::Rgba8Unorm,
            emulate_clamp: false,
        }
    }
}

/// A pipeline for each key, which culls back faces as the material says. Opaque ones have no fragment stage and do not
/// read the material; mask and blend ones discard fragments where alpha is low (blend: below one half).
///
/// Group 0 is [`view_layout`](Self::view_layout), group 1 is unused.
pub struct DepthPipelines {
    view_layout: wgpu::BindGroupLayout,
    /// The pipelines by [`PipelineKey::index`].
    pipelines: Vec<wgpu::RenderPipeline>,
}

impl DepthPipelines {
    /// Creates the pipelines for a target.
    ///
    /// # Errors
    ///
    /// [`Error::Shader`] if the shader cannot be composed.
    pub fn new(
        device: &wgpu::Device,
        layouts: &MaterialLayouts,
        target: &DepthTarget,
    ) -> Result<Self, Error> {
        let builder = PipelineBuilder::new(device, layouts, target, false)?;
        // Keys with equal variants share a pipeline.
        let mut created: Vec<(Variant, wgpu::RenderPipeline)> = Vec::new();
        let pipeline = |key: PipelineKey| {
            let variant = Variant::new(key);
            if let Some((_, pipeline)) = created.iter().find(|(other, _)| *other == variant) {
                return pipeline.clone();
            }
            let pipeline = builder.pipeline(device, variant);
            created.push((variant, pipeline.clone()));
            pipeline
        };
        let pipelines = PipelineKey::all().map(pipeline).collect();
        Ok(Self { view_layout: builder.view_layout, pipelines })
    }

    /// Returns the pipeline for draws with a key.
    #[must_use]
    pub fn get(&self, key: PipelineKey) -> DrawPipeline<'_> {
        let is_opaque = key.alpha == AlphaKey::Opaque;
        let material = if is_opaque { MaterialUse::None } else { MaterialUse::All };
        DrawPipeline { pipeline: &self.pipelines[key.index()], material }
    }

    /// Returns the layout of group 0: at binding 0 a storage buffer with a dynamic offset, visible to the vertex stage,
    /// which begins with the matrix clip_from_world (64 bytes).
    #[must_use]
    pub fn view_layout(&self) -> &wgpu::BindGroupLayout {
        &self.view_layout
    }
}

/// A pipeline for each [`CasterMode`], without culling: a single-sided wall casts a shadow to both sides.
///
/// Group 0 is that of [`DepthPipelines::view_layout`], group 1 is unused.
pub struct CasterPipelines {
    solid: wgpu::RenderPipeline,
    clip: wgpu::RenderPipeline,
    dither: wgpu::RenderPipeline,
    tint: wgpu::RenderPipeline,
}

impl CasterPipelines {
    /// Creates the pipelines for a target.
    ///
    /// # Errors
    ///
    /// [`Error::Shader`] if the shader cannot be composed.
    pub fn new(
        device: &wgpu::Device,
        layouts: &MaterialLayouts,
        target: &DepthTarget,
    ) -> Result<Self, Error> {
        let builder = PipelineBuilder::new(device, layouts, target, true)?;
        let pipeline = |alpha| builder.pipeline(device, Variant { alpha, culled: None });
        Ok(Self {
            solid: pipeline(Alpha::Ignored),
            clip: pipeline(Alpha::Clip),
            dither: pipeline(Alpha::Dither),
            tint: pipeline(Alpha::Tint),
        })
    }

    /// Returns the pipeline for the depth of casters of a mode; `None` for those that cast no shadow. [`CasterMode::Tint`] is
    /// clipped at an alpha of one half, for maps without tint.
    #[must_use]
    pub fn get(&self, mode: CasterMode) -> Option<DrawPipeline<'_>> {
        let (pipeline, material) = match mode {
            CasterMode::On => (&self.solid, MaterialUse::None),
            CasterMode::Clip | CasterMode::Tint => (&self.clip, MaterialUse::Alpha),
            CasterMode::Dither => (&self.dither, MaterialUse::Alpha),
            CasterMode::Off => return None,
        };
        Some(DrawPipeline { pipeline, material })
    }

    /// Returns the pipeline for depth that ignores alpha.
    #[must_use]
    pub fn solid(&self) -> DrawPipeline<'_> {
        DrawPipeline { pipeline: &self.solid, material: MaterialUse::None }
    }

    /// Returns the pipeline that multiplies a target of [`DepthTarget::tint_format`] by the transmitted light. It tests depth
    /// and does not write it.
    #[must_use]
    pub fn tint(&self) -> DrawPipeline<'_> {
        DrawPipeline { pipeline: &self.tint, material: MaterialUse::All }
    }
}

/// The effect of alpha.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Alpha {
    Ignored,
    Clip,
    Dither,
    /// Colours the transmitted light.
    Tint,
}

/// The parts of a key that matter where only depth is written.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Variant {
    alpha: Alpha,
    /// The front face whose back is culled; `None`: no culling.
    culled: Option<wgpu::FrontFace>,
}

impl Variant {
    fn new(key: PipelineKey) -> Self {
        let state = key.primitive_state();
        let alpha = if key.alpha == AlphaKey::Opaque { Alpha::Ignored } else { Alpha::Clip };
        Self { alpha, culled: state.cull_mode.map(|_| state.front_face) }
    }
}

/// The state that all pipelines of a target share.
struct PipelineBuilder {
    shader: wgpu::ShaderModule,
    target: DepthTarget,
    /// Holes are those of casters.
    casts: bool,
    /// The device clamps depth.
    unclipped: bool,
    /// The fragment shader clamps depth.
    emulated: bool,
    view_layout: wgpu::BindGroupLayout,
    opaque_layout: wgpu::PipelineLayout,
    material_layout: wgpu::PipelineLayout,
}

impl PipelineBuilder {
    fn new(
        device: &wgpu::Device,
        layouts: &MaterialLayouts,
        target: &DepthTarget,
        casts: bool,
    ) -> Result<Self, Error> {
        let name = "depth.wgsl";
        let module = shadowgraph_shaders::compose(name, &[])
            .map_err(|error| Error::Shader { name: name.to_owned(), reason: error.to_string() })?;
        let view_layout = view_layout(device);
        let layout = |material| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("depth"),
                bind_group_layouts: &[Some(&view_layout), None, material, Some(&layouts.draw)],
                immediate_size: 0,
            })
        };
        let can_clamp = device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL);
        let unclipped = target.clamp_near && can_clamp && !target.emulate_clamp;
        Ok(Self {
            shader: device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
            }),
            target: *target,
            casts,
            unclipped,
            emulated: target.clamp_near && !unclipped,
            opaque_layout: layout(None),
            material_layout: layout(Some(&layouts.material)),
            view_layout,
        })
    }

    fn pipeline(&self, device: &wgpu::Device, variant: Variant) -> wgpu::RenderPipeline {
        let fragment_entry = match (variant.alpha, self.emulated) {
            (Alpha::Ignored, false) => None,
            (Alpha::Clip, false) => Some("fs_mask"),
            (Alpha::Dither, false) => Some("fs_dither"),
            (Alpha::Tint, false) => Some("fs_tint"),
            (Alpha::Ignored, true) => Some("fs_clamp"),
            (Alpha::Clip, true) => Some("fs_mask_clamp"),
            (Alpha::Dither, true) => Some("fs_dither_clamp"),
            (Alpha::Tint, true) => Some("fs_tint_clamp"),
        };
        let reads_alpha = self.casts && matches!(variant.alpha, Alpha::Clip | Alpha::Dither);
        let vertex_entry = match (reads_alpha, self.emulated) {
            (false, false) => "vs_depth",
            (false, true) => "vs_depth_clamp",
            (true, false) => "vs_alpha",
            (true, true) => "vs_alpha_clamp",
        };
        let multiply = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::Dst,
            dst_factor: wgpu::BlendFactor::Zero,
            operation: wgpu::BlendOperation::Add,
        };
        let constants =
            [("SLOPE_BIAS", f64::from(self.target.slope_bias)), ("CASTS", f64::from(u8::from(self.casts)))];
        let options = wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..wgpu::PipelineCompilationOptions::default()
        };
        let tints = [Some(wgpu::ColorTargetState {
            format: self.target.tint_format,
            blend: Some(wgpu::BlendState { color: multiply, alpha: multiply }),
            write_mask: wgpu::ColorWrites::COLOR,
        })];
        let vertex = wgpu::VertexState {
            module: &self.shader,
            entry_point: Some(vertex_entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(vertex_layout())],
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("depth"),
            layout: Some(if variant.alpha == Alpha::Ignored {
                &self.opaque_layout
            } else {
                &self.material_layout
            }),
            vertex,
            primitive: wgpu::PrimitiveState {
                front_face: variant.culled.unwrap_or_default(),
                cull_mode: variant.culled.map(|_| wgpu::Face::Back),
                unclipped_depth: self.unclipped,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: Some(self.depth_state(variant.alpha != Alpha::Tint)),
            multisample: wgpu::MultisampleState {
                count: self.target.samples,
                ..wgpu::MultisampleState::default()
            },
            fragment: fragment_entry.map(|entry| wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(entry),
                compilation_options: options,
                targets: if variant.alpha == Alpha::Tint { &tints } else { &[] },
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn depth_state(&self, is_written: bool) -> wgpu::DepthStencilState {
        // Depth from the fragment shader includes the bias.
        let slope_scale = if self.emulated { 0.0 } else { self.target.slope_bias };
        wgpu::DepthStencilState {
            format: self.target.format,
            depth_write_enabled: Some(is_written),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState { slope_scale, ..wgpu::DepthBiasState::default() },
        }
    }
}

fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("depth view"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: true,
                // The uniforms of a camera or of a shadow view, which have the same size.
                min_binding_size: NonZeroU64::new(256),
            },
            count: None,
        }],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_keys_have_six_variants() {
        let mut variants: Vec<Variant> = Vec::new();
        for variant in PipelineKey::all().map(Variant::new) {
            if !variants.contains(&variant) {
                variants.push(variant);
            }
        }
        assert_eq!(variants.len(), 6);
    }

    #[test]
    fn mirrored_instances_flip_the_front_face_and_double_sided_ones_are_not_culled() {
        let key = |double_sided, mirrored| PipelineKey { alpha: AlphaKey::Mask, double_sided, mirrored };
        let culled = |key| Variant::new(key).culled;
        assert_eq!(culled(key(false, false)), Some(wgpu::FrontFace::Ccw));
        assert_eq!(culled(key(false, true)), Some(wgpu::FrontFace::Cw));
        assert_eq!(culled(key(true, true)), None);
    }
}
