//! The builder of the demo scene, and its materials.

use glam::{DAffine3, DVec3, Vec3, Vec4};

use super::textures;
use crate::insert::{insert_image, insert_instance, insert_material};
use crate::mesh_builder::MeshBuilder;
use shadowgraph_scene::{
    AlphaMode, Image, ImageKey, InstanceKey, Material, MaterialKey, MeshKey, Scene, TextureRef,
};

/// A scene under construction, and its materials by name.
pub(super) struct SceneBuilder {
    pub(super) scene: Scene,
    pub(super) materials: Materials,
}

/// Keys of the materials.
pub(super) struct Materials {
    pub(super) paving: MaterialKey,
    pub(super) masonry: MaterialKey,
    pub(super) stone: MaterialKey,
    pub(super) plaster: MaterialKey,
    pub(super) earth: MaterialKey,
    pub(super) wood: MaterialKey,
    pub(super) painted: MaterialKey,
    pub(super) cloth: MaterialKey,
    pub(super) fence: MaterialKey,
    pub(super) iron: MaterialKey,
    pub(super) bronze: MaterialKey,
    pub(super) gold: MaterialKey,
    pub(super) rope: MaterialKey,
    pub(super) lantern: MaterialKey,
}

impl SceneBuilder {
    /// Creates an empty scene with all materials.
    pub(super) fn new() -> Self {
        let mut scene = Scene::default();
        let materials = Materials::new(&mut scene);
        Self { scene, materials }
    }

    /// Adds a mesh and returns its key.
    pub(super) fn add_mesh(&mut self, name: &str, shape: MeshBuilder) -> MeshKey {
        self.scene.insert_mesh(shape.finish(name))
    }

    /// Adds an instance of a mesh.
    pub(super) fn add_instance(
        &mut self,
        name: &str,
        mesh: MeshKey,
        material: MaterialKey,
        world_from_local: DAffine3,
    ) -> InstanceKey {
        insert_instance(&mut self.scene, name, mesh, material, world_from_local)
    }

    /// Adds a translated instance of a mesh.
    pub(super) fn add_instance_at(
        &mut self,
        name: &str,
        mesh: MeshKey,
        material: MaterialKey,
        position: DVec3,
    ) -> InstanceKey {
        self.add_instance(name, mesh, material, DAffine3::from_translation(position))
    }

    /// Adds a mesh and its only instance, without a transform.
    pub(super) fn add_single(&mut self, name: &str, shape: MeshBuilder, material: MaterialKey) {
        let mesh = self.add_mesh(name, shape);
        self.add_instance(name, mesh, material, DAffine3::IDENTITY);
    }
}

impl Materials {
    fn new(scene: &mut Scene) -> Self {
        let mut image = |image: Image| insert_image(scene, image);
        let paving = [image(textures::paving()), image(textures::paving_normals())];
        let masonry = [image(textures::masonry()), image(textures::masonry_normals())];
        let planks = [image(textures::planks()), image(textures::planks_normals())];
        let (stone, earth) = (image(textures::stone()), image(textures::earth()));
        let (cloth, fence) = (image(textures::cloth()), image(textures::fence()));
        let mut add = |material: Material| insert_material(scene, material);
        let panel = textures::FENCE_PANEL.as_vec2();
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
            gold: add(plain("gold", linear(1.0, 0.72, 0.42), 1.0, 0.12)),
            rope: add(plain("rope", linear(0.62, 0.52, 0.36), 0.0, 0.95)),
            lantern: add(Material {
                emissive: Vec3::splat(14_000.0),
                ..plain("lantern", linear(0.9, 0.9, 0.9), 0.0, 0.5)
            }),
        }
    }
}

/// Returns an opaque linear colour.
fn linear(red: f32, green: f32, blue: f32) -> Vec4 {
    Vec4::new(red, green, blue, 1.0)
}

/// Returns a material of one colour.
fn plain(name: &str, base_color: Vec4, metallic: f32, roughness: f32) -> Material {
    Material { name: name.to_owned(), base_color, metallic, roughness, ..Material::default() }
}

/// Returns a reference to an image with scaled texture coordinates.
fn scaled(image: ImageKey, u: f32, v: f32) -> TextureRef {
    TextureRef { uv_transform: [[u, 0.0, 0.0], [0.0, v, 0.0]], ..TextureRef::new(image) }
}

/// Returns a rough material whose texture covers `metres`.
fn tiled(name: &str, image: ImageKey, metres: f32) -> Material {
    Material {
        base_color_texture: Some(scaled(image, 1.0 / metres, 1.0 / metres)),
        ..plain(name, Vec4::ONE, 0.0, 0.85)
    }
}

/// Builder methods for materials.
trait MaterialExt {
    /// Adds a normal map that covers `metres`.
    fn normals(self, image: ImageKey, metres: f32) -> Self;
    /// Sets the roughness.
    fn rough(self, roughness: f32) -> Self;
}

impl MaterialExt for Material {
    fn normals(self, image: ImageKey, metres: f32) -> Self {
        Self { normal_texture: Some(scaled(image, 1.0 / metres, 1.0 / metres)), ..self }
    }

    fn rough(self, roughness: f32) -> Self {
        Self { roughness, ..self }
    }
}
