//! Captured textures and plots of a page.

use crate::desc::ResourceDesc;
use crate::handle::{PassId, ResourceId};
use crate::plan::Plan;
use crate::subresource::{Rect, Subresource};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use std::io::Write as _;
use wgpu_types::TextureSampleType;

/// The contents of a subresource of a texture after one pass of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSnapshot {
    /// The captured texture.
    pub resource: ResourceId,
    /// Version of the texture.
    pub version: u32,
    /// First version in the snapshot: `version`, or an earlier one if passes drew into adjacent rectangles.
    pub since: u32,
    /// Pass that wrote the version; `None` at the end of the frame.
    pub pass: Option<PassId>,
    /// Captured subresource: one layer of one mip.
    pub subresource: Subresource,
    /// Width and height of the subresource in texels.
    pub full_px: [u32; 2],
    /// Texels, or the reason why there are none.
    pub texels: Result<Texels, String>,
    /// Named rectangles.
    pub tiles: Vec<SnapshotTile>,
}

/// Texels of a snapshot, possibly subsampled, in rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// Width and height, at least 1 each.
    pub size_px: [u32; 2],
    /// Number of channels, 1 to 4: red, green, blue, alpha.
    pub channels: u32,
    /// Whether the texels are depth: shown as greys over the range in use, with 0 black.
    pub is_depth: bool,
    /// `width * height * channels` values.
    pub values: TexelValues,
}

/// Values of texels.
#[derive(Clone, Debug, PartialEq)]
pub enum TexelValues {
    /// Displayable values, 0 to 255.
    Bytes(Vec<u8>),
    /// Values of any range.
    Floats(Vec<f32>),
}

/// A named rectangle of a snapshot.
#[derive(Clone, Debug, PartialEq)]
pub struct SnapshotTile {
    /// Rectangle in texels of the texture.
    pub rect: Rect,
    /// Name of the rectangle.
    pub name: String,
}

/// A plot of named outlines on a plane, such as frusta seen from above.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drawing {
    /// Title of the plot.
    pub title: String,
    /// Caption below the plot.
    pub caption: String,
    /// Outlines in the plot.
    pub outlines: Vec<Outline>,
}

/// A named polygon.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outline {
    /// Name of the polygon.
    pub name: String,
    /// Corners in order, x to the right and y down; at least one.
    pub points: Vec<[f32; 2]>,
}

/// The data of a snapshot for `textures.js`.
#[derive(Serialize)]
pub(super) struct SnapshotData<'p> {
    resource: ResourceId,
    version: u32,
    pass: Option<PassId>,
    #[serde(rename = "part")]
    subresource: String,
    full: [u32; 2],
    /// Offset of the subresource in its layer.
    origin: [u32; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    missing: Option<&'p str>,
    width: u32,
    height: u32,
    channels: u32,
    depth: bool,
    floats: bool,
    /// Whether the format has integer channels.
    integers: bool,
    /// First version in the snapshot.
    since: u32,
    /// Compressed by zlib, in base64.
    data: String,
    tiles: Vec<TileData<'p>>,
}

#[derive(Serialize)]
struct TileData<'p> {
    #[serde(flatten)]
    rect: Rect,
    name: &'p str,
}

impl<'p> SnapshotData<'p> {
    pub(super) fn new(plan: &Plan, snapshot: &'p TextureSnapshot) -> Self {
        let rect = snapshot.subresource.rect;
        let texels = snapshot.texels.as_ref();
        let [width, height] = texels.map_or([0, 0], |texels| texels.size_px);
        let (several, integers) = match plan.resource(snapshot.resource).desc {
            ResourceDesc::Texture(desc) => (
                desc.mip_levels > 1 || desc.size.depth_or_array_layers > 1,
                matches!(
                    desc.format.sample_type(None, None),
                    Some(TextureSampleType::Uint | TextureSampleType::Sint)
                ),
            ),
            ResourceDesc::Buffer(_) => (false, false),
        };
        let subresource =
            if several || rect.is_some() { snapshot.subresource.to_string() } else { String::new() };
        Self {
            resource: snapshot.resource,
            version: snapshot.version,
            pass: snapshot.pass,
            subresource,
            full: snapshot.full_px,
            origin: rect.map_or([0, 0], |rect| [rect.x, rect.y]),
            missing: texels.err().map(String::as_str),
            width,
            height,
            channels: texels.map_or(0, |texels| texels.channels),
            depth: texels.is_ok_and(|texels| texels.is_depth),
            floats: texels.is_ok_and(|texels| matches!(texels.values, TexelValues::Floats(_))),
            integers,
            since: snapshot.since,
            data: texels.map(Texels::to_base64).unwrap_or_default(),
            tiles: snapshot.tiles.iter().map(|tile| TileData { rect: tile.rect, name: &tile.name }).collect(),
        }
    }
}

impl Texels {
    fn to_base64(&self) -> String {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        // Writing into memory does not fail.
        let _written = match &self.values {
            TexelValues::Bytes(bytes) => encoder.write_all(bytes),
            TexelValues::Floats(floats) => {
                let bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
                encoder.write_all(&bytes)
            }
        };
        BASE64_STANDARD.encode(encoder.finish().unwrap_or_default())
    }
}
