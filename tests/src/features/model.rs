//! The vase, its texture, and the file around it.

use std::f32::consts::TAU;

use image::{ImageFormat, RgbaImage};
use serde_json::{Value, json};

use crate::gltf_file::File;

/// Points around the vase and along its profile.
const SIDES: usize = 48;
const RINGS: usize = 33;
const HEIGHT_M: f32 = 1.2;
/// Width and height of the texture, pixels.
pub(super) const TEXTURE_PX: u32 = 128;

/// The vertices and triangles of the vase.
pub(super) struct Vase {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) indices: Vec<u16>,
}

/// The radius of the vase at a fraction of its height.
fn radius_m(height: f32) -> f32 {
    0.22 + 0.18 * (height * 4.6 + 0.4).sin()
}

impl Vase {
    pub(super) fn new() -> Self {
        let mut vase =
            Self { positions: Vec::new(), normals: Vec::new(), uvs: Vec::new(), indices: Vec::new() };
        for ring in 0..RINGS {
            for side in 0..=SIDES {
                let (v, u) = (ring as f32 / (RINGS - 1) as f32, side as f32 / SIDES as f32);
                let (sin, cos) = (u * TAU).sin_cos();
                let radius = radius_m(v);
                let slope = (radius_m(v + 1e-3) - radius_m(v - 1e-3)) / (2e-3 * HEIGHT_M);
                let length = slope.hypot(1.0);
                vase.positions.push([sin * radius, v * HEIGHT_M, cos * radius]);
                vase.normals.push([sin / length, -slope / length, cos / length]);
                vase.uvs.push([u, 1.0 - v]);
            }
        }
        let corner = |ring: usize, side: usize| (ring * (SIDES + 1) + side) as u16;
        for ring in 0..RINGS - 1 {
            for side in 0..SIDES {
                let [a, b] = [corner(ring, side), corner(ring, side + 1)];
                let [c, d] = [corner(ring + 1, side), corner(ring + 1, side + 1)];
                vase.indices.extend([a, b, c, c, b, d]);
            }
        }
        vase
    }

    /// Adds its attributes and indices as they are, and returns the primitive.
    pub(super) fn primitive(&self, file: &mut File) -> Value {
        let positions = file.floats("VEC3", 3, self.positions.as_flattened());
        let normals = file.floats("VEC3", 3, self.normals.as_flattened());
        let uvs = file.floats("VEC2", 2, self.uvs.as_flattened());
        let indices: Vec<u8> = self.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = file.accessor(&indices, 5123, "SCALAR", self.indices.len());
        json!({
            "attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs},
            "indices": indices, "material": 1,
        })
    }
}

/// Creates the file without features.
pub(super) fn plain() -> File {
    with_primitive(|file, vase| vase.primitive(file))
}

/// Creates the file with the geometry of the vase as another primitive.
pub(super) fn with_primitive(primitive: impl FnOnce(&mut File, &Vase) -> Value) -> File {
    let mut file = File::new(
        json!([
            {"mesh": 0},
            {"mesh": 1, "name": "vase"},
            {"rotation": [-0.282, -0.4728, -0.1628, 0.8188], "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"translation": [0.75, 1.25, 1.85], "rotation": [-0.17, 0.14, 0.025, 0.975], "camera": 0},
        ]),
        4,
    );
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] =
        json!({"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 20000}]}});
    file.json["cameras"] =
        json!([{"type": "perspective", "perspective": {"yfov": 0.75, "znear": 0.1, "zfar": 100}}]);
    file.json["materials"] = json!([
        {"pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.24, 0.22, 1], "metallicFactor": 0}},
        {"doubleSided": true, "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.4}},
    ]);
    let floor = [[-6.0, 0.0, 6.0], [6.0, 0.0, 6.0], [-6.0, 0.0, -6.0], [6.0, 0.0, -6.0]];
    let floor = file.floats("VEC3", 3, floor.as_flattened());
    let indices = file.accessor(&[0, 1, 2, 2, 1, 3], 5121, "SCALAR", 6);
    file.add_mesh(
        json!({"primitives": [{"attributes": {"POSITION": floor}, "indices": indices, "material": 0}]}),
    );
    let primitive = primitive(&mut file, &Vase::new());
    file.add_mesh(json!({"primitives": [primitive]}));
    let image = file.view(&png(&texture()));
    file.json["images"] = json!([{"bufferView": image, "mimeType": "image/png"}]);
    file.json["textures"] = json!([{"source": 0}]);
    file
}

/// Returns the texture of the vase: clay with bands of ornament.
pub(super) fn texture() -> RgbaImage {
    RgbaImage::from_fn(TEXTURE_PX, TEXTURE_PX, |x, y| {
        let band = y / 16 % 4 == 1;
        let wave = (f64::from(x) * std::f64::consts::TAU / 32.0).sin() * 5.0 + 8.0;
        match (band, f64::from(y % 16) < wave) {
            (false, _) => image::Rgba([196, 104, 62, 255]),
            (true, true) => image::Rgba([36, 48, 96, 255]),
            (true, false) => image::Rgba([232, 212, 168, 255]),
        }
    })
}

/// Returns an image whose bands are `inside`, and the rest `outside`.
pub(super) fn rings(inside: [u8; 4], outside: [u8; 4]) -> RgbaImage {
    RgbaImage::from_fn(TEXTURE_PX, TEXTURE_PX, |_, y| {
        image::Rgba(if y / 16 % 4 == 1 { inside } else { outside })
    })
}

/// Encodes an image as PNG.
pub(super) fn png(image: &RgbaImage) -> Vec<u8> {
    encoded(image, ImageFormat::Png)
}

/// Encodes an image.
pub(super) fn encoded(image: &RgbaImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}
