//! Passes that display textures of the graph.

use std::borrow::Cow;

use shadowgraph_core::{Bind, Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_lighting::ViewBuffers;

use crate::error::Error;

/// The format of displayed data: the file holds the values that are written.
const LINEAR: Format = Format::Rgba8Unorm;
/// The format of displayed colours.
const SRGB: Format = Format::Rgba8UnormSrgb;

/// Pipelines that draw a texture into a viewport.
pub struct DebugBlit {
    view_layout: wgpu::BindGroupLayout,
    depth_layout: wgpu::BindGroupLayout,
    float_layout: wgpu::BindGroupLayout,
    camera_depth: wgpu::RenderPipeline,
    raw_depth: wgpu::RenderPipeline,
    float: wgpu::RenderPipeline,
    grey: wgpu::RenderPipeline,
}

impl DebugBlit {
    /// Creates the pipelines.
    ///
    /// # Errors
    /// None with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let module = shadowgraph_shaders::compose("show.wgsl", &[])?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("show.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let view_layout = layout(
            device,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
        );
        let depth_layout = layout(device, texture(wgpu::TextureSampleType::Depth));
        let float_layout = layout(device, texture(wgpu::TextureSampleType::Float { filterable: false }));
        let create = |groups: [&wgpu::BindGroupLayout; 2], vertex, fragment, format| {
            pipeline(device, &shader, groups, vertex, fragment, format)
        };
        Ok(Self {
            camera_depth: create([&view_layout, &depth_layout], "vs_show_depth", "fs_show_depth", LINEAR),
            raw_depth: create([&view_layout, &depth_layout], "vs_show_depth", "fs_show_atlas", LINEAR),
            float: create([&view_layout, &float_layout], "vs_show_texture", "fs_show_texture", SRGB),
            grey: create([&view_layout, &float_layout], "vs_show_texture", "fs_show_grey", SRGB),
            view_layout,
            depth_layout,
            float_layout,
        })
    }

    /// Adds the pass that displays the camera's depth: white near, dark far, black where nothing is drawn.
    pub fn depth<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        depth: &Texture,
        size_px: [u32; 2],
    ) -> Texture {
        self.blit(frame, view, &[depth], &self.camera_depth, LINEAR, size_px)
    }

    /// Adds the pass that displays textures side by side, each as large as fits: depth stretched to the range of its values, a
    /// single channel as grey, colours unchanged.
    pub fn textures<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        textures: &[&Texture],
        size_px: [u32; 2],
    ) -> Texture {
        let depth = textures.iter().any(|texture| is_depth(frame, texture));
        let (pipeline, format) = match depth {
            true => (&self.raw_depth, LINEAR),
            false if textures.iter().all(|texture| has_one_channel(frame, texture)) => (&self.grey, SRGB),
            false => (&self.float, SRGB),
        };
        self.blit(frame, view, textures, pipeline, format, size_px)
    }

    fn blit<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        textures: &[&Texture],
        pipeline: &'f wgpu::RenderPipeline,
        format: Format,
        size_px: [u32; 2],
    ) -> Texture {
        let viewports = side_by_side(textures.iter().map(|texture| size_of_texture(frame, texture)), size_px);
        let mut image = frame.create_texture("shown", TextureDesc::d2(size_px[0], size_px[1], format));
        let layout = if format == LINEAR { &self.depth_layout } else { &self.float_layout };
        let mut pass = frame.render_pass("show");
        let tokens: Vec<_> = textures.iter().map(|texture| pass.sample(texture)).collect();
        let view = pass.uniform_buffer(&view.view);
        pass.color(&mut image, Contents::clear_color([0.0, 0.0, 0.0, 1.0]));
        pass.body(move |ctx| {
            let view = ctx.bind_group(&self.view_layout, &[Bind::Buffer(view)])?;
            ctx.pass.set_pipeline(pipeline);
            ctx.pass.set_bind_group(0, &view, &[]);
            for (token, [x, y, width, height]) in tokens.into_iter().zip(viewports) {
                let texture = ctx.bind_group(layout, &[Bind::Texture(token)])?;
                ctx.pass.set_bind_group(1, &texture, &[]);
                ctx.pass.set_viewport(x, y, width, height, 0.0, 1.0);
                ctx.pass.draw(0..3, 0..1);
                ctx.report_draws(1);
            }
            Ok(())
        });
        image
    }
}

fn is_depth(frame: &Frame<'_>, texture: &Texture) -> bool {
    frame.texture_desc(texture).is_some_and(|desc| desc.format.is_depth_stencil_format())
}

fn has_one_channel(frame: &Frame<'_>, texture: &Texture) -> bool {
    frame.texture_desc(texture).is_some_and(|desc| desc.format.components() == 1)
}

fn size_of_texture(frame: &Frame<'_>, texture: &Texture) -> [f32; 2] {
    let size = frame.texture_desc(texture).map(|desc| desc.size).unwrap_or_default();
    [size.width.max(1) as f32, size.height.max(1) as f32]
}

/// Returns viewports in equal columns of `size_px`, each as large as fits and centred: x, y, width, height.
fn side_by_side(sizes: impl ExactSizeIterator<Item = [f32; 2]>, size_px: [u32; 2]) -> Vec<[f32; 4]> {
    let [width, height] = size_px.map(|px| px as f32);
    let column = width / sizes.len().max(1) as f32;
    let viewport = |(index, [w, h]): (usize, [f32; 2])| {
        let scale = (column / w).min(height / h);
        let (w, h) = ((w * scale).min(column).max(1.0), (h * scale).min(height).max(1.0));
        let x = (index as f32 * column + (column - w) / 2.0).min(width - w);
        [x.max(0.0), ((height - h) / 2.0).max(0.0), w, h]
    };
    sizes.enumerate().map(viewport).collect()
}

fn layout(device: &wgpu::Device, ty: wgpu::BindingType) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("show"),
        entries: &[wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }],
    })
}

fn pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    groups: [&wgpu::BindGroupLayout; 2],
    vertex: &str,
    fragment: &str,
    format: Format,
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("show"),
        bind_group_layouts: &groups.map(Some),
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::side_by_side;

    #[test]
    fn viewports_side_by_side_fit_and_do_not_overlap() {
        let viewports = side_by_side([[4096.0, 4096.0], [100.0, 400.0]].into_iter(), [320, 180]);
        assert_eq!(viewports[0], [0.0, 10.0, 160.0, 160.0]);
        let [x, y, width, height] = viewports[1];
        assert!(x >= 160.0 && x + width <= 320.0 && y >= 0.0 && height <= 180.0, "{viewports:?}");
    }

    #[test]
    fn a_wide_texture_fills_the_width() {
        assert_eq!(side_by_side([[1000.0, 10.0]].into_iter(), [100, 100]), [[0.0, 49.5, 100.0, 1.0]]);
    }
}
