//! The scene under construction, and what its surfaces are made of.

use glam::{DAffine3, DVec3, Vec3, Vec4};

use super::pictures;
use crate::solids::shape::Shape;
use shadowgraph_scene::{AlphaMode, Image, Instance, Material, Scene, TextureRef};

/// A scene to which parts are added, and its materials by name.
pub(super) struct Stage {
    pub(super) scene: Scene,
    pub(super) paint: Palette,
}

/// Indices of the materials.
pub(super) struct Palette {
    pub(super) paving: usize,
    pub(super) masonry: usize,
    pub(super) stone: usize,
    pub(super) plaster: usize,
    pub(super) earth: usize,
    pub(super) wood: usize,
    pub(super) painted: usize,
    pub(super) cloth: usize,
    pub(super) fence: usize,
    pub(super) iron: usize,
    pub(super) bronze: usize,
    pub(super) rope: usize,
    pub(super) lamp: usize,
}

impl Stage {
    /// An empty scene with all materials.
    pub(super) fn new() -> Self {
        let mut scene = Scene::default();
        let paint = Palette::new(&mut scene);
        Self { scene, paint }
    }

    /// Adds a mesh and answers its index.
    pub(super) fn mesh(&mut self, name: &str, shape: Shape) -> usize {
        self.scene.meshes.push(shape.finish(name));
        self.scene.meshes.len() - 1
    }

    /// Adds an instance of a mesh.
    pub(super) fn place(&mut self, name: &str, mesh: usize, material: usize, world_from_local: DAffine3) {
        self.scene.instances.push(Instance { name: name.to_owned(), mesh, material, world_from_local });
    }

    /// Adds an instance of a mesh that is only moved.
    pub(super) fn place_at(&mut self, name: &str, mesh: usize, material: usize, position: DVec3) {
        self.place(name, mesh, material, DAffine3::from_translation(position));
    }

    /// Adds a mesh that is used once, made where it stands.
    pub(super) fn add(&mut self, name: &str, shape: Shape, material: usize) {
        let mesh = self.mesh(name, shape);
        self.place(name, mesh, material, DAffine3::IDENTITY);
    }
}

impl Palette {
    fn new(scene: &mut Scene) -> Self {
        let mut image = |image: Image| {
            scene.images.push(image);
            scene.images.len() - 1
        };
        let paving = [image(pictures::paving()), image(pictures::paving_normals())];
        let masonry = [image(pictures::masonry()), image(pictures::masonry_normals())];
        let planks = [image(pictures::planks()), image(pictures::planks_normals())];
        let (stone, earth) = (image(pictures::stone()), image(pictures::earth()));
        let (cloth, fence) = (image(pictures::cloth()), image(pictures::fence()));
        let mut add = |material: Material| {
            scene.materials.push(material);
            scene.materials.len() - 1
        };
        let panel = pictures::FENCE_PANEL.as_vec2();
        Self {
            paving: add(tiled("paving", paving[0], 4.0).normals(paving[1], 4.0).rough(0.62)),
            masonry: add(tiled("masonry", masonry[0], 2.0).normals(masonry[1], 2.0).rough(0.9)),
            stone: add(tiled("stone", stone, 2.0).rough(0.7)),
            plaster: add(Material { base_color: linear(0.86, 0.80, 0.70), ..tiled("plaster", stone, 3.0) }),
            earth: add(tiled("earth", earth, 16.0).rough(1.0)),
            wood: add(tiled("wood", planks[0], 1.0).normals(planks[1], 1.0).rough(0.75)),
            painted: add(Material {
                base_color: linear(0.10, 0.34, 0.38),
                base_color_texture: None,
                ..tiled("painted wood", planks[0], 1.0)
            }
            .normals(planks[1], 1.0)
            .rough(0.4)),
            cloth: add(Material { double_sided: true, ..tiled("cloth", cloth, 1.0).rough(0.95) }),
            fence: add(Material {
                alpha: AlphaMode::Mask { cutoff: 0.5 },
                double_sided: true,
                base_color_texture: Some(scaled(fence, 1.0 / panel.x, 1.0 / panel.y)),
                ..tiled("wrought iron", fence, 1.0).rough(0.5)
            }),
            iron: add(plain("iron", linear(0.05, 0.055, 0.06), 1.0, 0.5)),
            bronze: add(plain("bronze", linear(0.83, 0.58, 0.30), 1.0, 0.32)),
            rope: add(plain("rope", linear(0.62, 0.52, 0.36), 0.0, 0.95)),
            lamp: add(Material {
                emissive: Vec3::splat(14_000.0),
                ..plain("lamp", linear(0.9, 0.9, 0.9), 0.0, 0.5)
            }),
        }
    }
}

/// A linear colour.
fn linear(red: f32, green: f32, blue: f32) -> Vec4 {
    Vec4::new(red, green, blue, 1.0)
}

/// A material of one colour.
fn plain(name: &str, base_color: Vec4, metallic: f32, roughness: f32) -> Material {
    Material { name: name.to_owned(), base_color, metallic, roughness, ..Material::default() }
}

/// An image whose texture coordinates are scaled.
fn scaled(image: usize, u: f32, v: f32) -> TextureRef {
    TextureRef { uv_transform: [[u, 0.0, 0.0], [0.0, v, 0.0]], ..TextureRef::new(image) }
}

/// A rough material whose picture shows `metres` of it.
fn tiled(name: &str, image: usize, metres: f32) -> Material {
    Material {
        base_color_texture: Some(scaled(image, 1.0 / metres, 1.0 / metres)),
        ..plain(name, Vec4::ONE, 0.0, 0.85)
    }
}

/// Further steps of making a material.
trait With {
    /// Adds a normal picture that shows `metres`.
    fn normals(self, image: usize, metres: f32) -> Self;
    /// Sets the roughness.
    fn rough(self, roughness: f32) -> Self;
}

impl With for Material {
    fn normals(self, image: usize, metres: f32) -> Self {
        Self { normal_texture: Some(scaled(image, 1.0 / metres, 1.0 / metres)), ..self }
    }

    fn rough(self, roughness: f32) -> Self {
        Self { roughness, ..self }
    }
}
