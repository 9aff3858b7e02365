//! Lines over an image that show what shadow maps cover.

use std::borrow::Cow;

use bytemuck::{Pod, Zeroable, bytes_of};
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};
use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, Texture};
use shadowgraph_lighting::ViewBuffers;
use shadowgraph_scene::{Camera, Projection};
use shadowgraph_shadows::ShadowView;

use crate::error::Error;

/// The width of lines, pixels.
const WIDTH_PX: f32 = 1.5;

/// What lines show of shadow maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ShadowLines {
    /// The slices of the camera's view that cascades are fitted to, in pale colours, and the boxes and pyramids of all tiles.
    Frusta,
    /// The bounding spheres of cascades.
    Spheres,
    /// The tiles in the middle of their boxes, and, in pale colours, the parts inside their borders.
    Tiles,
}

impl ShadowLines {
    /// All kinds, in the order of their names.
    pub const ALL: [Self; 3] = [Self::Frusta, Self::Spheres, Self::Tiles];

    /// The names in options and settings.
    pub const NAMES: [&'static str; 3] = ["frusta", "spheres", "tiles"];

    /// Returns the name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Returns the kind with a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the entry point, and the number of lines of a view.
    fn shader(self) -> (&'static str, u32) {
        match self {
            Self::Frusta => ("vs_frusta", 24),
            Self::Spheres => ("vs_spheres", 3 * 48),
            Self::Tiles => ("vs_tiles", 8),
        }
    }
}

/// `ShadowCamera` of `shadow_lines.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct ShadowCamera {
    eye: Vec3,
    orthographic: u32,
    right: Vec3,
    width_px: f32,
    up: Vec3,
    pad: u32,
    forward: Vec3,
    pad_end: u32,
}

impl ShadowCamera {
    fn new(camera: &Camera, aspect: f64, origin_world: DVec3) -> Self {
        let orthographic = matches!(camera.projection, Projection::Orthographic { .. });
        let [low, high] = [0, 3].map(|corner| camera.slice_corners_view(aspect, 1.0, 2.0)[corner]);
        let half = (high - low).abs() * 0.5;
        let axis = |view: DVec3| camera.world_from_view.transform_vector3(view).as_vec3();
        Self {
            eye: (camera.position_world() - origin_world).as_vec3(),
            orthographic: u32::from(orthographic),
            right: axis(DVec3::X * half.x),
            width_px: WIDTH_PX,
            up: axis(DVec3::Y * half.y),
            pad: 0,
            forward: axis(DVec3::NEG_Z),
            pad_end: 0,
        }
    }
}

/// The pass that draws the lines.
pub struct ShadowLinesPass {
    view_layout: wgpu::BindGroupLayout,
    lines_layout: wgpu::BindGroupLayout,
    /// The pipelines by the formats of images.
    pipelines: [(Format, wgpu::RenderPipeline); 2],
    kind: ShadowLines,
}

impl ShadowLinesPass {
    /// Creates the pipelines of a kind of lines.
    ///
    /// # Errors
    /// None with the built-in WGSL.
    pub fn new(device: &wgpu::Device, kind: ShadowLines) -> Result<Self, Error> {
        let module = shadowgraph_shaders::compose("shadow_lines.wgsl", &[])?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shadow_lines.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let storage = wgpu::BufferBindingType::Storage { read_only: true };
        let view_layout = buffers_layout(device, &[wgpu::BufferBindingType::Uniform]);
        let lines_layout = buffers_layout(device, &[storage, wgpu::BufferBindingType::Uniform]);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadow lines"),
            bind_group_layouts: &[Some(&view_layout), Some(&lines_layout)],
            immediate_size: 0,
        });
        let formats = [Format::Rgba8Unorm, Format::Rgba8UnormSrgb];
        let pipelines = formats.map(|format| (format, pipeline(device, (&shader, &layout), kind, format)));
        Ok(Self { view_layout, lines_layout, pipelines, kind })
    }

    /// Returns the kind of lines.
    pub fn kind(&self) -> ShadowLines {
        self.kind
    }

    /// Adds the pass that draws lines into `target`, whose format is `Rgba8Unorm` or `Rgba8UnormSrgb`; nothing into others. `views` is the
    /// buffer of [`ShadowView`]s, and `camera` the one that they are fitted to.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (view, views): (&ViewBuffers, &Buffer),
        (camera, aspect, origin_world): (&Camera, f64, DVec3),
        (target, contents): (&mut Texture, Contents),
    ) {
        let format = frame.texture_desc(target).map(|desc| desc.format);
        let found = self.pipelines.iter().find(|(known, _)| Some(*known) == format);
        let Some((_, pipeline)) = found else { return };
        let bytes = frame.buffer_desc(views).map_or(0, |desc| desc.bytes);
        let count = (bytes / size_of::<ShadowView>() as u64) as u32;
        let uniform = frame.uniform(bytes_of(&ShadowCamera::new(camera, aspect, origin_world)));
        let mut pass = frame.render_pass("shadow lines");
        let (view, views) = (pass.uniform_buffer(&view.view), pass.storage_buffer(views));
        pass.color(target, contents);
        pass.body(move |ctx| {
            let view = ctx.bind_group(&self.view_layout, &[Bind::Buffer(view)])?;
            let lines = ctx.bind_group(&self.lines_layout, &[Bind::Buffer(views), Bind::Uniform(uniform)])?;
            ctx.pass.set_pipeline(pipeline);
            ctx.pass.set_bind_group(0, &view, &[]);
            ctx.pass.set_bind_group(1, &lines, &[]);
            ctx.pass.draw(0..6 * self.kind.shader().1, 0..count);
            ctx.report_draws(1);
            Ok(())
        });
    }
}

fn pipeline(
    device: &wgpu::Device,
    (shader, layout): (&wgpu::ShaderModule, &wgpu::PipelineLayout),
    kind: ShadowLines,
    format: Format,
) -> wgpu::RenderPipeline {
    let fragment = if format == Format::Rgba8UnormSrgb { "fs_linear" } else { "fs_encoded" };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadow lines"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some(kind.shader().0),
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

fn buffers_layout(device: &wgpu::Device, types: &[wgpu::BufferBindingType]) -> wgpu::BindGroupLayout {
    let entry = |(binding, &ty): (u32, &_)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    let label = Some("shadow lines");
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn the_camera_has_the_layout_of_the_wgsl_struct() {
        let module = shadowgraph_shaders::compose("shadow_lines.wgsl", &[]).unwrap();
        shadowgraph_shaders::check_layout!(&module, "ShadowCamera", ShadowCamera:
            eye, orthographic, right, width_px, up, forward,
        )
        .unwrap();
    }

    #[test]
    fn each_kind_has_its_name() {
        for kind in ShadowLines::ALL {
            assert_eq!(ShadowLines::from_name(kind.name()), Some(kind));
        }
        assert_eq!(ShadowLines::from_name("lines"), None);
    }
}
