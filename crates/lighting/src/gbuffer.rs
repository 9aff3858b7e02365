//! The G-buffer of deferred lighting.

use std::sync::OnceLock;

use shadowgraph_core::{Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_scene::gpu::{
    AlphaKey, Draw, DrawPipeline, MaterialLayouts, MaterialUse, PipelineKey, vertex_layout,
};
use shadowgraph_shadows::VertexBuffers;

use crate::error::Error;
use crate::geometry::Geometry;
use crate::prepass::DEPTH_FORMAT;
use crate::shader::module;
use crate::uniforms::ViewBuffers;
use crate::view_group::{OptionalBindings, ViewLayouts};

/// The textures of the G-buffer, besides depth: 24 bytes per pixel.
#[derive(Clone, Debug)]
pub struct GBuffer {
    /// Linear colour, and in alpha the kind of surface.
    pub base_color: Texture,
    /// Metallic, roughness, ambient occlusion.
    pub material: Texture,
    /// The shading and the geometric normal, each as two 16-bit values.
    pub normals: Texture,
    /// Emitted radiance.
    pub emissive: Texture,
}

impl GBuffer {
    /// The formats, in the order of the fields.
    pub const FORMATS: [Format; 4] =
        [Format::Rgba8UnormSrgb, Format::Rgba8Unorm, Format::Rg32Uint, Format::Rgba16Float];
}

/// The pass that draws the G-buffer.
pub struct GBufferPass {
    view_layouts: ViewLayouts,
    layout: wgpu::PipelineLayout,
    empty: wgpu::BindGroup,
    shader: wgpu::ShaderModule,
    device: wgpu::Device,
    /// The pipelines by [`PipelineKey::index`].
    pipelines: Vec<OnceLock<wgpu::RenderPipeline>>,
}

impl GBufferPass {
    /// Creates the state that its pipelines share; each pipeline is created on first use.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device, layouts: &MaterialLayouts) -> Result<Self, Error> {
        let shader = module(device, "gbuffer.wgsl", &[])?;
        let view_layouts = ViewLayouts::new(device);
        let none = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("no shadows"),
            entries: &[],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("G-buffer"),
            bind_group_layouts: &[
                Some(view_layouts.get(OptionalBindings::default())),
                Some(&none),
                Some(&layouts.material),
                Some(&layouts.draw),
            ],
            immediate_size: 0,
        });
        let empty = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("no shadows"),
            layout: &none,
            entries: &[],
        });
        let pipelines = PipelineKey::all().map(|_| OnceLock::new()).collect();
        Ok(Self { view_layouts, layout, empty, shader, device: device.clone(), pipelines })
    }

    /// Adds the pass that draws all geometry that is not blended. `depth` is the depth of the prepass.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        depth: &Texture,
        geometry: &Geometry<'f>,
    ) -> GBuffer {
        let [width, height] = geometry.size_px;
        let [base_color, material, normals, emissive] = GBuffer::FORMATS;
        let mut texture =
            |name: &str, format| frame.create_texture(name, TextureDesc::d2(width, height, format));
        let mut buffer = GBuffer {
            base_color: texture("base color", base_color),
            material: texture("material", material),
            normals: texture("normals", normals),
            emissive: texture("glow", emissive),
        };
        let vertices = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass("G-buffer");
        vertices.read_in(&mut pass);
        let view = view.read_with(&mut pass, OptionalBindings::default());
        let solid = geometry.solid_in(&mut pass);
        pass.depth_read(depth);
        for texture in
            [&mut buffer.base_color, &mut buffer.material, &mut buffer.normals, &mut buffer.emissive]
        {
            pass.color(texture, Contents::clear_color([0.0; 4]));
        }
        pass.body(move |ctx| {
            let view = view.bind_group(ctx, &self.view_layouts)?;
            ctx.pass.set_bind_group(0, &view, &[]);
            ctx.pass.set_bind_group(1, &self.empty, &[]);
            let pipeline_for = |draw: &Draw| {
                let pipeline = self.pipelines[draw.key.index()].get_or_init(|| self.pipeline(draw.key));
                Some(DrawPipeline { pipeline, material: MaterialUse::All })
            };
            solid.record(ctx, &pipeline_for)
        });
        buffer
    }

    fn pipeline(&self, key: PipelineKey) -> wgpu::RenderPipeline {
        debug_assert_ne!(key.alpha, AlphaKey::Blend, "blended geometry is drawn in the blended pass");
        let targets = GBuffer::FORMATS.map(|format| Some(format.into()));
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("G-buffer"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some("vs_gbuffer"),
                compilation_options: Default::default(),
                buffers: &[Some(vertex_layout())],
            },
            primitive: key.primitive_state(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some("fs_gbuffer"),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
