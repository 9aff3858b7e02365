//! The engine: its scene, its pipelines, and its shadow casters.

use crate::pipelines::{layout, pipeline};
use glam::Vec4;
use shadowgraph::core::{Format, wgpu};
use shadowgraph::scene::{Aabb, CullVolume};
use shadowgraph::shaders::{ModuleSource, compose_source};
use shadowgraph::shadows::{
    CasterPass, CasterTarget, CasterView, ShadowCasters, ShadowTechnique, caster_view_layout, shadow_layout,
};
use shadowgraph_examples::Failure;
use std::borrow::Cow;

const WGSL: &str = include_str!("engine.wgsl");

/// Returns the engine's scene: boxes by centre and half extents.
fn tower() -> Vec<[Vec4; 2]> {
    let ground = [Vec4::new(0.0, -0.5, 0.0, 0.0), Vec4::new(12.0, 0.5, 12.0, 0.0)];
    let step = |i: u32| {
        let (sin, cos) = (i as f32 * 0.5).sin_cos();
        [Vec4::new(2.0 * cos, 0.15 + 0.22 * i as f32, 2.0 * sin, 0.0), Vec4::new(0.45, 0.08, 0.45, 0.0)]
    };
    let pillar = [Vec4::new(0.0, 1.9, 0.0, 0.0), Vec4::new(0.5, 1.9, 0.5, 0.0)];
    [ground, pillar].into_iter().chain((0..16).map(step)).collect()
}

pub(crate) struct Engine {
    pub(crate) boxes: Vec<[Vec4; 2]>,
    pub(crate) buffer: wgpu::Buffer,
    pub(crate) view_layout: wgpu::BindGroupLayout,
    pub(crate) shadow_layout: wgpu::BindGroupLayout,
    pub(crate) lit: wgpu::RenderPipeline,
    caster_boxes: wgpu::BindGroup,
    caster: wgpu::RenderPipeline,
}

impl Engine {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        technique: &dyn ShadowTechnique,
    ) -> Result<Self, Failure> {
        let boxes = tower();
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("boxes"),
            size: size_of_val(&boxes[..]) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&boxes));
        // The engine's shader imports the function of any technique.
        let source = ModuleSource::new("custom_engine.wgsl", WGSL);
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Naga(Cow::Owned(compose_source(&source, &technique.modules(0))?)),
        });
        let (uniform, storage) =
            (wgpu::BufferBindingType::Uniform, wgpu::BufferBindingType::Storage { read_only: true });
        let (view_layout, boxes_layout) = (layout(device, &[uniform, storage]), layout(device, &[storage]));
        let shadow_layout = shadow_layout(device, technique);
        let lit = pipeline(device, &shader, "vs_lit", Some("fs_lit"), [&view_layout, &shadow_layout]);
        let caster =
            pipeline(device, &shader, "vs_caster", None, [&caster_view_layout(device), &boxes_layout]);
        let caster_boxes = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &boxes_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Ok(Self { boxes, buffer, view_layout, shadow_layout, lit, caster_boxes, caster })
    }
}

/// The interface to shadow passes.
impl ShadowCasters for Engine {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        casters.extend((0..self.boxes.len() as u32).filter(|&i| volume.intersects(&self.caster_bounds(i))));
    }

    fn bounds(&self) -> Aabb {
        (0..self.boxes.len() as u32).fold(Aabb::EMPTY, |all, i| all.union(&self.caster_bounds(i)))
    }

    fn caster_bounds(&self, caster: u32) -> Aabb {
        let [center, half] = self.boxes[caster as usize].map(|at| at.truncate().as_dvec3());
        Aabb { min: center - half, max: center + half }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32 {
        // This engine has only a sun, so there is one format and one kind of view.
        debug_assert!(matches!(
            view.target,
            CasterTarget { pass: CasterPass::Depth, format: Format::Depth32Float, perspective: false, .. }
        ));
        pass.set_pipeline(&self.caster);
        pass.set_bind_group(1, &self.caster_boxes, &[]);
        casters.iter().for_each(|&caster| pass.draw(0..36, caster..caster + 1));
        casters.len() as u32
    }
}
