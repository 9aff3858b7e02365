//! Captured textures and plots of a page.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use shadowgraph_core::{PassId, Plan, Rect, ResourceDesc, ResourceId, TexelValues, Texels, TextureSnapshot};
use std::io::Write as _;
use wgpu_types::TextureSampleType;

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
    pub(super) fn new(plan: &Plan, snapshot: &'p TextureSnapshot, compression: Compression) -> Self {
        let rect = snapshot.subresource.bounds();
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
            data: texels.map(|texels| to_base64(texels, compression)).unwrap_or_default(),
            tiles: snapshot.tiles.iter().map(|tile| TileData { rect: tile.rect, name: &tile.name }).collect(),
        }
    }
}

/// Returns the values, compressed by zlib, in base64.
fn to_base64(texels: &Texels, compression: Compression) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), compression);
    // Writing into memory does not fail.
    let _written = match &texels.values {
        TexelValues::Bytes(bytes) => encoder.write_all(bytes),
        TexelValues::Floats(floats) => {
            let bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
            encoder.write_all(&bytes)
        }
    };
    BASE64_STANDARD.encode(encoder.finish().unwrap_or_default())
}
