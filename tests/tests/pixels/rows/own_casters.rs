//! Custom casters.

use crate::maps::{Map, draw_map};
use crate::stage::{camera, gpu, sun};
use glam::DVec3;
use image::imageops::{FilterType, resize};
use image::{GrayImage, Luma};
use shadowgraph::scene::{Aabb, CullVolume};
use shadowgraph::shadows::{
    CasterView, CullSettings, Pcf, ShadowCasters, ShadowSettings, TileKind, caster_view_layout,
};
use shadowgraph::wgpu;
use std::sync::Mutex;

/// Reeds that sway: 100 instances of a strip of quads without a vertex buffer, moved in the vertex stage.
const REEDS: &str = "
struct View { clip_from_world: mat4x4f }
@group(0) @binding(0) var<storage, read> view: View;
override SWAY: f32 = 0.0;
override SEGMENTS: u32 = 8u;
@vertex
fn vs_reed(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4f {
    let corner = array(vec2u(0, 0), vec2u(1, 0), vec2u(1, 1), vec2u(0, 0), vec2u(1, 1), vec2u(0, 1))[vertex % 6u];
    let height = f32(vertex / 6u + corner.y) / f32(SEGMENTS);
    let foot = vec2f(f32(instance % 10u), f32(instance / 10u)) * 0.4 - 1.8;
    let position = vec3f(foot.x + 0.1 * f32(corner.x) + SWAY * height * height, 1.5 * height, foot.y);
    return view.clip_from_world * vec4f(position, 1.0);
}";

struct Reeds {
    /// Pipelines by level of detail: 8 segments and 2.
    pipelines: [wgpu::RenderPipeline; 2],
    /// The level of detail with which each tile was rendered.
    drawn: Mutex<Vec<(TileKind, usize)>>,
}

const SEGMENTS: [u32; 2] = [8, 2];

impl Reeds {
    fn new(device: &wgpu::Device, sway: f64) -> Self {
        let source = wgpu::ShaderSource::Wgsl(REEDS.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&caster_view_layout(device))],
            immediate_size: 0,
        });
        let pipelines = SEGMENTS.map(|segments| {
            let constants = [("SWAY", sway), ("SEGMENTS", f64::from(segments))];
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("reeds"),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("vs_reed"),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..Default::default()
                    },
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: wgpu::TextureFormat::Depth32Float,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: None,
                multiview_mask: None,
                cache: None,
            })
        });
        Self { pipelines, drawn: Mutex::default() }
    }
}

impl ShadowCasters for Reeds {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        casters.extend(volume.intersects(&self.bounds()).then_some(0));
    }

    fn bounds(&self) -> Aabb {
        // Including the sway.
        Aabb { min: DVec3::new(-3.0, 0.0, -2.0), max: DVec3::new(3.0, 1.5, 2.0) }
    }

    fn receivers(&self) -> Aabb {
        Aabb { min: DVec3::new(-80.0, 0.0, -80.0), max: DVec3::new(80.0, 1.5, 80.0) }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, _casters: &[u32]) -> u32 {
        // Where a texel is as wide as a reed, its bend is not visible.
        let level = usize::from(view.texel_world > 0.02);
        self.drawn.lock().unwrap().push((view.kind, level));
        pass.set_pipeline(&self.pipelines[level]);
        pass.draw(0..SEGMENTS[level] * 6, 0..100);
        1
    }
}

fn map(reeds: &Reeds) -> Option<Map> {
    let gpu = gpu()?;
    let settings =
        ShadowSettings { distance_m: 100.0, cull: CullSettings::NONE, ..ShadowSettings::default() };
    let camera = camera(DVec3::new(0.0, 1.0, 6.0), DVec3::ZERO);
    let lights = [sun(DVec3::new(0.0, -1.0, -0.4).normalize())];
    Some(draw_map(gpu, &Pcf::new(&gpu.device), reeds, &lights, &camera, &settings, "cascades"))
}

/// Returns which texels are covered.
fn covered(map: &Map) -> Vec<bool> {
    map.depth.iter().map(|depth| *depth > 0.0).collect()
}

/// Returns the covered texels of the first tile, white, as an image for the documents.
fn first_tile(map: &Map) -> GrayImage {
    let rect = map.plan.cascades.as_ref().unwrap().tiles[0].rect;
    let white = |x: u32, y: u32| Luma([255 * u8::from(map.depth_at(rect.x + x, rect.y + y) > 0.0)]);
    resize(&GrayImage::from_fn(rect.width, rect.height, white), 400, 400, FilterType::Triangle)
}

#[test]
fn row_39_custom_casters_animate_vertices_and_draw_instances() {
    let Some(gpu) = gpu() else { return };
    let (still, swayed) = (Reeds::new(&gpu.device, 0.0), Reeds::new(&gpu.device, 0.8));
    let (still, swayed) = (map(&still).unwrap(), map(&swayed).unwrap());
    if let Some(dir) = shadowgraph_tests::images() {
        first_tile(&still).save(dir.join("reeds-straight.png")).unwrap();
        first_tile(&swayed).save(dir.join("reeds-bent.png")).unwrap();
    }
    let (still, swayed) = (covered(&still), covered(&swayed));
    let count = |covered: &[bool]| covered.iter().filter(|covered| **covered).count();
    assert!(count(&still) > 10_000 && count(&swayed) > 10_000);
    let moved = still.iter().zip(&swayed).filter(|(a, b)| a != b).count();
    assert!(moved > count(&still) / 2, "{moved} of {}", count(&still));
}

#[test]
fn row_39_custom_casters_choose_a_level_of_detail_for_each_tile() {
    let Some(gpu) = gpu() else { return };
    let reeds = Reeds::new(&gpu.device, 0.4);
    map(&reeds);
    let drawn = reeds.drawn.into_inner().unwrap();
    let level =
        |cascade| drawn.iter().find(|(kind, _)| *kind == TileKind::Cascade(cascade)).map(|(_, level)| *level);
    assert_eq!((level(0), level(3)), (Some(0), Some(1)), "{drawn:?}");
}
