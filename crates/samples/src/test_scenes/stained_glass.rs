//! A window of stained glass, for coloured shadows.

use glam::{DAffine3, DVec3, Vec3, Vec4};

use super::{ground, sun};
use crate::insert::{insert_image, insert_instance, insert_material};
use crate::mesh_builder::{MeshBuilder, box_on_ground, cuboid};
use crate::round::sphere;
use shadowgraph_scene::{
    AlphaMode, Camera, Image, Light, LightKind, Material, MaterialKey, Mesh, Projection, Scene, TextureRef,
};

/// The side of a pane, metres.
const PANE: f64 = 1.2;

/// Half the width of the window and of the lead between its panes, metres.
const HALF_WINDOW: f64 = 1.5 * PANE;
const HALF_LEAD: f64 = 0.03;

/// The height of the window's lower edge, metres.
const SILL: f64 = 0.7;

/// Creates a wall with a window of six panes, one of them textured and one with coloured corners; in the light behind it a
/// seventh pane, a glass ball and a box; a sun outside, a point light inside that shines through the seventh pane, and a
/// camera.
#[must_use]
pub fn stained_glass() -> Scene {
    let stone = Vec4::new(0.75, 0.75, 0.75, 1.0);
    let mut scene = Scene::default();
    let stone = Material { name: "stone".into(), base_color: stone, metallic: 0.0, ..Material::default() };
    let stone = insert_material(&mut scene, stone);
    let (name, floor) = ground(10.0);
    add(&mut scene, floor.finish(name), stone);
    add(&mut scene, wall().finish("wall"), stone);
    let mut block = MeshBuilder::default();
    block.append(&box_on_ground(0.6, 0.7, 0.6), DAffine3::from_translation(DVec3::new(-1.5, 0.0, 2.4)));
    add(&mut scene, block.finish("box"), stone);
    add_panes(&mut scene);
    let mut ball = MeshBuilder::default();
    ball.append_translated(&sphere(0.5, 64), DVec3::new(1.7, 0.5, 2.6));
    let glass = insert_material(&mut scene, glass(Vec4::new(0.2, 0.8, 0.9, 0.3)));
    add(&mut scene, ball.finish("ball"), glass);
    scene.insert_light(sun(42.0, -75.0));
    scene.insert_light(point_light());
    let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: Some(100.0) };
    let camera = Camera::look_at(DVec3::new(0.6, 3.6, 8.2), DVec3::new(0.3, 0.7, 1.2), DVec3::Y, projection);
    scene.cameras.push(camera);
    scene
}

fn point_light() -> Light {
    let kind = LightKind::Point { position_world: DVec3::new(-3.4, 2.4, 4.4), range: Some(20.0) };
    Light { name: Some("lamp".into()), kind, color: Vec3::ONE, intensity: 9_000.0, casts_shadow: true }
}

fn wall() -> MeshBuilder {
    let (half, top) = (4.0, 4.2);
    let mut wall = MeshBuilder::default();
    let mut stones = |min: [f64; 2], max: [f64; 2], depth: f64| {
        let (min, max) = (DVec3::new(min[0], min[1], -depth), DVec3::new(max[0], max[1], depth));
        wall.append_translated(&cuboid(min, max), DVec3::ZERO);
    };
    let head = SILL + 2.0 * PANE;
    stones([-half, 0.0], [half, SILL], 0.1);
    stones([-half, head], [half, top], 0.1);
    stones([-half, SILL], [-HALF_WINDOW, head], 0.1);
    stones([HALF_WINDOW, SILL], [half, head], 0.1);
    for x in [-0.5 * PANE, 0.5 * PANE] {
        stones([x - HALF_LEAD, SILL], [x + HALF_LEAD, head], HALF_LEAD);
    }
    let middle = SILL + PANE;
    stones([-HALF_WINDOW, middle - HALF_LEAD], [HALF_WINDOW, middle + HALF_LEAD], HALF_LEAD);
    wall
}

fn add_panes(scene: &mut Scene) {
    let colors = [
        Vec4::new(1.0, 0.03, 0.02, 0.7),
        Vec4::new(1.0, 0.5, 0.0, 0.7),
        Vec4::ONE,
        Vec4::new(0.0, 0.8, 0.1, 0.7),
        Vec4::new(0.02, 0.1, 1.0, 0.7),
        Vec4::new(1.0, 1.0, 1.0, 0.7),
    ];
    for (index, color) in colors.into_iter().enumerate() {
        let corner =
            DVec3::new(-HALF_WINDOW + PANE * (index % 3) as f64, SILL + PANE * (index / 3) as f64, 0.0);
        let mut material = glass(color);
        let mut mesh = pane(corner, "pane");
        match index {
            2 => {
                let scale = 1.0 / PANE as f32;
                let uv_transform = [[scale, 0.0, 0.0], [0.0, scale, 0.0]];
                let rings = insert_image(scene, rings_texture());
                material.base_color_texture = Some(TextureRef { uv_transform, ..TextureRef::new(rings) });
            }
            5 => {
                let corners =
                    [[255, 20, 20, 255], [20, 255, 20, 255], [20, 20, 255, 255], [255, 255, 255, 80]];
                for (vertex, color) in mesh.vertices.iter_mut().zip(corners) {
                    vertex.color = color.map(|channel: u16| channel * 257);
                }
            }
            _ => {}
        }
        let material = insert_material(scene, material);
        add(scene, mesh, material);
    }
    let violet = insert_material(scene, glass(Vec4::new(0.5, 0.1, 0.8, 0.5)));
    add(scene, pane(DVec3::new(0.1, 0.0, 1.3), "screen"), violet);
}

fn pane(corner: DVec3, name: &str) -> Mesh {
    let mut pane = MeshBuilder::default();
    pane.parallelogram(corner, DVec3::X * PANE, DVec3::Y * PANE);
    pane.finish(name)
}

fn glass(base_color: Vec4) -> Material {
    Material {
        name: "glass".into(),
        base_color,
        metallic: 0.0,
        roughness: 0.3,
        alpha: AlphaMode::Blend,
        double_sided: true,
        ..Material::default()
    }
}

fn add(scene: &mut Scene, mesh: Mesh, material: MaterialKey) {
    let name = mesh.name.clone();
    let mesh = scene.insert_mesh(mesh);
    insert_instance(scene, &name, mesh, material, DAffine3::IDENTITY);
}

/// Returns concentric colour gradients, more transparent towards the centre.
fn rings_texture() -> Image {
    const SIDE: u32 = 64;
    let texel = |index: u32| {
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE) * 2.0 - 1.0;
        let radius = at(index % SIDE).hypot(at(index / SIDE));
        let channel =
            |phase: f64| (127.5 + 127.5 * ((radius * 0.8 + phase) * std::f64::consts::TAU).cos()) as u8;
        [channel(0.0), channel(0.33), channel(0.67), (150.0 + 60.0 * radius.min(1.0)) as u8]
    };
    Image::new("rings", SIDE, SIDE, (0..SIDE * SIDE).flat_map(texel).collect())
}
