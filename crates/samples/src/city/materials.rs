//! The materials of the city.

use glam::{Vec3, Vec4};

use crate::demo::noise::{cell, texture};
use crate::insert::{insert_image, insert_material};
use shadowgraph_scene::{AlphaMode, Image, Material, MaterialKey, Scene, TextureRef};

/// Keys of the materials.
pub(super) struct Materials {
    pub(super) asphalt: MaterialKey,
    pub(super) pavement: MaterialKey,
    pub(super) lawn: MaterialKey,
    pub(super) bark: MaterialKey,
    pub(super) leaves: MaterialKey,
    pub(super) steel: MaterialKey,
    pub(super) tyre: MaterialKey,
    pub(super) lens: MaterialKey,
    pub(super) walls: [MaterialKey; 8],
    pub(super) trims: [MaterialKey; 3],
    pub(super) windows: [MaterialKey; 3],
    pub(super) paints: [MaterialKey; 6],
}

impl Materials {
    pub(super) fn new(scene: &mut Scene) -> Self {
        let leaves = insert_image(scene, leaves());
        let mut plain = |name: &str, color: [f32; 3], metallic, roughness| {
            let base_color = Vec3::from(color).extend(1.0);
            let material =
                Material { name: name.to_owned(), base_color, metallic, roughness, ..Material::default() };
            insert_material(scene, material)
        };
        let walls = [
            [0.46, 0.20, 0.14],
            [0.62, 0.52, 0.40],
            [0.70, 0.66, 0.58],
            [0.50, 0.42, 0.33],
            [0.33, 0.17, 0.13],
            [0.58, 0.56, 0.54],
            [0.66, 0.50, 0.30],
            [0.40, 0.40, 0.42],
        ];
        let paints = [
            [0.55, 0.04, 0.04],
            [0.05, 0.12, 0.35],
            [0.75, 0.75, 0.74],
            [0.03, 0.03, 0.035],
            [0.35, 0.36, 0.38],
            [0.70, 0.45, 0.05],
        ];
        Self {
            asphalt: plain("asphalt", [0.085, 0.085, 0.09], 0.0, 0.9),
            pavement: plain("pavement", [0.36, 0.35, 0.33], 0.0, 0.85),
            lawn: plain("lawn", [0.10, 0.17, 0.05], 0.0, 1.0),
            bark: plain("bark", [0.16, 0.11, 0.07], 0.0, 0.95),
            steel: plain("steel", [0.08, 0.085, 0.09], 0.4, 0.5),
            tyre: plain("tyre", [0.02, 0.02, 0.02], 0.0, 0.9),
            walls: walls.map(|color| plain("wall", color, 0.0, 0.9)),
            trims: [[0.72, 0.70, 0.66], [0.25, 0.23, 0.21], [0.52, 0.48, 0.42]]
                .map(|color| plain("trim", color, 0.0, 0.8)),
            windows: [[0.05, 0.07, 0.09], [0.08, 0.09, 0.10], [0.04, 0.05, 0.05]]
                .map(|color| plain("window", color, 0.0, 0.1)),
            paints: paints.map(|color| plain("paint", color, 0.0, 0.25)),
            lens: insert_material(
                scene,
                Material { name: "lens".to_owned(), emissive: Vec3::splat(6_000.0), ..Material::default() },
            ),
            leaves: insert_material(
                scene,
                Material {
                    name: "leaves".to_owned(),
                    base_color: Vec4::ONE,
                    base_color_texture: Some(TextureRef::new(leaves)),
                    alpha: AlphaMode::Mask { cutoff: 0.5 },
                    double_sided: true,
                    metallic: 0.0,
                    roughness: 0.9,
                    ..Material::default()
                },
            ),
        }
    }
}

/// Returns a spray of leaves: ellipses of random places and angles, in alpha. They cover more than half, so that crowns far away, of
/// which a card is less than a texel wide, stay dense.
fn leaves() -> Image {
    texture("leaves", |u, v| {
        let mut color = [0.16, 0.27, 0.08, 0.0];
        for leaf in 0..64 {
            let random = |what: u64| cell(leaf, 7, what);
            let (sin, cos) = (random(1) * std::f64::consts::TAU).sin_cos();
            // Leaves are closer to the middle than to the corners of the card.
            let (spread, way) = (0.43 * random(2).sqrt(), random(3) * std::f64::consts::TAU);
            let (x, y) = (u - 0.5 - spread * way.cos(), v - 0.5 - spread * way.sin());
            let (along, across) = ((x * cos + y * sin) / 0.1, (y * cos - x * sin) / 0.05);
            if along * along + across * across < 1.0 {
                let tone = 0.75 + 0.5 * random(4);
                color = [0.22 * tone, 0.38 * tone, 0.10 * tone, 1.0];
            }
        }
        color
    })
}
