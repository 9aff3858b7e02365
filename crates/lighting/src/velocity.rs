//! Motion vectors.

use std::sync::OnceLock;

use bytemuck::{NoUninit, Pod, Zeroable, bytes_of};
use glam::{Mat4, Vec2, Vec3};
use shadowgraph_core::{Bind, Contents, Format, Frame, FullscreenShader, Texture, TextureDesc};
use shadowgraph_scene::gpu::{
    AlphaKey, Draw, DrawPipeline, MaterialLayouts, MaterialUse, PipelineKey, previous_vertex_layout,
    vertex_layout,
};
use shadowgraph_shadows::VertexBuffers;

use crate::error::Error;
use crate::geometry::Geometry;
use crate::prepass::DEPTH_FORMAT;
use crate::shader::{fullscreen, module};
use crate::uniforms::ViewBuffers;

/// The passes that compute motion vectors: for each pixel, the motion of its surface from its position in this frame back to
/// that in the previous frame, in pixels, y down, without jitter. So a surface at pixel `p` was at `p + velocity`.
///
/// The motion includes those of the camera, of instances, and of skins and morph targets. Where nothing is drawn, it is that of a
/// background infinitely far away. Blended geometry has none: its pixels have the motion of what is behind it. A surface that was
/// behind the camera has the motion (32768, 32768).
pub struct Velocity {
    camera: FullscreenShader,
    view_layout: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    shader: wgpu::ShaderModule,
    device: wgpu::Device,
    /// The pipelines by [`PipelineKey::index`] of opaque keys.
    pipelines: Vec<OnceLock<wgpu::RenderPipeline>>,
}

/// `ViewMotion` of `velocity.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct GpuViewMotion {
    clip_from_relative: Mat4,
    previous_clip_from_relative: Mat4,
    eye: Vec3,
    padding: f32,
    px_from_ndc: Vec2,
    end_padding: Vec2,
}

/// `Settings` of `velocity_camera.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct CameraUniforms {
    previous_from_current: Mat4,
    background_previous_from_current: Mat4,
    jitter_px: Vec2,
    px_from_ndc: Vec2,
}

impl Velocity {
    /// The format. Half floats have steps of 0.125 pixels from 128 pixels on, so they would be wrong by up to 0.0625 pixels there
    /// and by 0.25 pixels from 512 on.
    pub const FORMAT: Format = Format::Rg32Float;

    /// Creates the state that its pipelines share; each pipeline is created on first use.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device, layouts: &MaterialLayouts) -> Result<Self, Error> {
        let view_layout = view_layout(device);
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("velocity"),
            bind_group_layouts: &[Some(&view_layout), None, None, Some(&layouts.draw)],
            immediate_size: 0,
        });
        Ok(Self {
            camera: fullscreen(device, "velocity_camera.wgsl", "fs_velocity_camera")?,
            view_layout,
            layout,
            shader: module(device, "velocity.wgsl", &[])?,
            device: device.clone(),
            pipelines: PipelineKey::all().map(|_| OnceLock::new()).collect(),
        })
    }

    /// Adds the passes and returns the motion vectors. `depth` is the depth that was drawn with the same view and geometry, with one
    /// sample per pixel.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        depth: &Texture,
        geometry: &Geometry<'f>,
    ) -> Texture {
        let [width, height] = geometry.size_px;
        let mut velocity = frame.create_texture("velocity", TextureDesc::d2(width, height, Self::FORMAT));
        self.add_camera(frame, view, depth, geometry.size_px, &mut velocity);
        if !geometry.has_moving() {
            return velocity;
        }
        let motion = frame.upload_buffer("motion", bytes_of(&GpuViewMotion::new(view, geometry)).to_vec());
        let vertices = VertexBuffers::published_in(frame);
        let mut pass = frame.render_pass("velocity");
        vertices.read_in(&mut pass);
        let (view, motion) = (pass.storage_buffer(&view.view), pass.storage_buffer(&motion));
        let moving = geometry.moving_in(&mut pass);
        pass.depth_read(depth);
        pass.color(&mut velocity, Contents::Preserve);
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(motion)])?;
            ctx.pass.set_bind_group(0, &group, &[]);
            moving.record(ctx, &|draw: &Draw| Some(self.pipeline_for(draw.key)))
        });
        velocity
    }

    /// Adds the pass that computes what the camera's motion alone gives.
    fn add_camera(
        &self,
        frame: &mut Frame<'_>,
        view: &ViewBuffers,
        depth: &Texture,
        size_px: [u32; 2],
        velocity: &mut Texture,
    ) {
        let uniforms = CameraUniforms {
            previous_from_current: view.motion.previous_from_current().as_mat4(),
            background_previous_from_current: view.motion.background_previous_from_current().as_mat4(),
            jitter_px: view.jitter_px,
            px_from_ndc: px_from_ndc(size_px),
        };
        let pass = frame.fullscreen("camera velocity", &self.camera);
        pass.sample(depth).uniform(bytes_of(&uniforms)).draw(velocity);
    }

    /// Returns the pipeline for draws with a key. It draws only where the depth is that of the draw, so holes need no material.
    fn pipeline_for(&self, key: PipelineKey) -> DrawPipeline<'_> {
        let key = PipelineKey { alpha: AlphaKey::Opaque, ..key };
        let pipeline = self.pipelines[key.index()].get_or_init(|| self.pipeline(key));
        DrawPipeline { pipeline, material: MaterialUse::None }
    }

    fn pipeline(&self, key: PipelineKey) -> wgpu::RenderPipeline {
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("velocity"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some("vs_velocity"),
                compilation_options: Default::default(),
                buffers: &[Some(vertex_layout()), Some(previous_vertex_layout())],
            },
            primitive: key.primitive_state(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(false),
                depth_compare: Some(wgpu::CompareFunction::Equal),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some("fs_velocity"),
                compilation_options: Default::default(),
                targets: &[Some(Self::FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

impl GpuViewMotion {
    /// Returns the matrices relative to the camera: near it, positions relative to the origin are too large for f32 products.
    fn new(view: &ViewBuffers, geometry: &Geometry<'_>) -> Self {
        let origin_world = geometry.scene.origin_world();
        let eye = (view.motion.position_world() - origin_world).as_vec3();
        let matrices = view.motion.clip_from_relative(origin_world + eye.as_dvec3());
        let [clip_from_relative, previous_clip_from_relative] = matrices.map(|matrix| matrix.as_mat4());
        let px_from_ndc = px_from_ndc(geometry.size_px);
        Self { clip_from_relative, previous_clip_from_relative, eye, px_from_ndc, ..Self::zeroed() }
    }
}

/// Returns the factor from differences in normalized device coordinates to pixels, y down.
fn px_from_ndc([width, height]: [u32; 2]) -> Vec2 {
    Vec2::new(0.5 * width as f32, -0.5 * height as f32)
}

fn view_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, visibility| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("velocity"),
        entries: &[entry(0, wgpu::ShaderStages::VERTEX), entry(1, wgpu::ShaderStages::VERTEX_FRAGMENT)],
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use shadowgraph_shaders::{check_layout, compose};

    use super::*;

    #[test]
    fn uniforms_have_the_layout_of_the_wgsl_structs() {
        let module = compose("velocity.wgsl", &[]).unwrap();
        check_layout!(&module, "ViewMotion", GpuViewMotion:
            clip_from_relative, previous_clip_from_relative, eye, px_from_ndc,
        )
        .unwrap();
        let module = compose("velocity_camera.wgsl", &[]).unwrap();
        check_layout!(&module, "Settings", CameraUniforms:
            previous_from_current, background_previous_from_current, jitter_px, px_from_ndc,
        )
        .unwrap();
    }
}
