//! Draws the maps of frames that follow each other, and reads them back.

use crate::boxes::Boxes;
use glam::DVec3;
use shadowgraph::core::{Graph, Plan};
use shadowgraph::scene::{Camera, Light, LightKind, Projection};
use shadowgraph::shadows::{Requirements, ShadowInputs, ShadowMaps, ShadowSettings, TileRect};
use shadowgraph::wgpu;
use std::sync::Arc;

/// A view of a world, with its lights and settings.
pub(crate) struct View {
    pub(crate) camera: Camera,
    pub(crate) lights: Vec<Light>,
    pub(crate) settings: ShadowSettings,
}

/// The maps of frames that follow each other.
pub(crate) struct Frames {
    device: wgpu::Device,
    queue: wgpu::Queue,
    maps: ShadowMaps,
    graph: Graph,
}

/// The maps of one frame.
pub(crate) struct Drawn {
    /// The bytes of the map of cascades and of the atlas; empty without one.
    pub(crate) bytes: [Vec<u8>; 2],
    /// The tiles of both, and the bytes and texels in a row of each.
    pub(crate) tiles: [Vec<TileRect>; 2],
    row_bytes: [usize; 2],
    widths: [usize; 2],
    pub(crate) plan: Arc<Plan>,
}

impl Drawn {
    /// Returns the tiles of map 0 or 1 that differ, with the number of bytes that do.
    pub(crate) fn different_tiles(&self, other: &Self, map: usize) -> Vec<(TileRect, usize)> {
        assert_eq!(self.tiles[map], other.tiles[map]);
        let different = |rect: &TileRect| {
            let [ours, theirs] = [self, other].map(|drawn| drawn.tile_bytes(map, rect));
            (*rect, ours.zip(theirs).filter(|(a, b)| a != b).count())
        };
        self.tiles[map].iter().map(different).filter(|(_, count)| *count > 0).collect()
    }

    fn tile_bytes(&self, map: usize, rect: &TileRect) -> impl Iterator<Item = u8> {
        let row_bytes = self.row_bytes[map];
        let texel = row_bytes / self.widths[map];
        let columns = rect.x as usize * texel..(rect.x + rect.width) as usize * texel;
        let rows = self.bytes[map].chunks_exact(row_bytes).skip(rect.y as usize).take(rect.height as usize);
        rows.flat_map(move |row| row[columns.clone()].iter().copied())
    }
}

impl Frames {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let (maps, graph) = (ShadowMaps::new(device), Graph::new());
        Self { device: device.clone(), queue: queue.clone(), maps, graph }
    }

    /// Draws the maps and reads them back where `reads` says so.
    pub(crate) fn draw(&mut self, boxes: &Boxes, view: &View, reads: bool) -> Drawn {
        let origin_world = shadowgraph::scene::origin_near(view.camera.position_world());
        boxes.upload(&self.queue, origin_world);
        let inputs = ShadowInputs {
            view: 0,
            camera: &view.camera,
            aspect: 16.0 / 9.0,
            lights: &view.lights,
            casters: boxes,
            origin_world,
            settings: &view.settings,
        };
        let mut frame = self.graph.frame();
        let drawn = self.maps.add_to(&mut frame, &inputs, &Requirements::NONE).unwrap();
        let mut read_backs = Vec::new();
        let (mut row_bytes, mut widths) = ([0; 2], [0; 2]);
        for (index, map) in [&drawn.cascades, &drawn.atlas].into_iter().enumerate() {
            if map.tiles.is_empty() || !reads {
                read_backs.push(None);
                continue;
            }
            let desc = frame.texture_desc(&map.texture).unwrap();
            let texel = if desc.format == wgpu::TextureFormat::Depth16Unorm { 2 } else { 4 };
            let row = desc.size.width * texel;
            assert_eq!(row % 256, 0, "rows without padding");
            (row_bytes[index], widths[index]) = (row as usize, desc.size.width as usize);
            let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: u64::from(row * desc.size.height),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let mut target = frame.import_buffer("read back", &buffer, false);
            frame.copy_pass("read back").texture_to_buffer(&map.texture, &mut target);
            read_backs.push(Some(buffer));
        }
        let tiles =
            [&drawn.cascades, &drawn.atlas].map(|map| map.tiles.iter().map(|(rect, _)| *rect).collect());
        let compiled = self.graph.compile(frame).unwrap();
        let plan = compiled.shared_plan();
        let mut encoder = self.device.create_command_encoder(&Default::default());
        compiled.execute(&mut self.graph, &self.device, &mut encoder).unwrap();
        self.queue.submit([encoder.finish()]);
        let read = |buffer: &Option<wgpu::Buffer>| {
            let Some(buffer) = buffer else { return Vec::new() };
            buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
            self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
            buffer.get_mapped_range(..).unwrap().to_vec()
        };
        let bytes = [read(&read_backs[0]), read(&read_backs[1])];
        Drawn { bytes, tiles, row_bytes, widths, plan }
    }
}

/// Returns a camera with a vertical field of view of 60 degrees.
pub(crate) fn camera(eye: DVec3, target: DVec3) -> Camera {
    let projection = Projection::Perspective { fov_y: 1.05, near: 0.1, far: None };
    Camera::look_at(eye, target, DVec3::Y, projection)
}

pub(crate) fn light(kind: LightKind, intensity: f32) -> Light {
    Light { name: None, kind, color: glam::Vec3::ONE, intensity, casts_shadow: true }
}

pub(crate) fn sun(direction: DVec3) -> Light {
    light(LightKind::Directional { direction: direction.normalize() }, 100_000.0)
}

/// Returns what the plan says about each tile of the map `name`.
pub(crate) fn notes(plan: &Plan, name: &str) -> Vec<String> {
    let map = plan.resources().find(|(_, resource)| resource.name == name);
    map.map_or_else(Vec::new, |(id, _)| plan.resource_notes(id).map(str::to_owned).collect())
}
