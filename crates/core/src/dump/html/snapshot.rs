//! Pictures and drawings of a page.

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

/// What a part of a texture held at one moment of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSnapshot {
    /// The texture.
    pub resource: ResourceId,
    /// Its version.
    pub version: u32,
    /// The first version that is in the picture: `version`, or an earlier one where passes drew beside each other.
    pub since: u32,
    /// The pass that made the version; `None` for the end of the frame.
    pub pass: Option<PassId>,
    /// The part that is shown: one layer of one mip.
    pub subresource: Subresource,
    /// Width and height of the part, texels.
    pub full_px: [u32; 2],
    /// The texels, or why there are none.
    pub texels: Result<Texels, String>,
    /// Parts with names.
    pub tiles: Vec<SnapshotTile>,
}

/// Texels of a picture, every so many of the texture's: rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// Width and height, each at least 1.
    pub size_px: [u32; 2],
    /// 1 to 4: red, green, blue, alpha.
    pub channels: u32,
    /// Greys that are stretched over the range that is used, 0 left black.
    pub is_depth: bool,
    /// The values, `width * height * channels` of them.
    pub values: TexelValues,
}

/// Values of texels.
#[derive(Clone, Debug, PartialEq)]
pub enum TexelValues {
    /// As they are to be shown, 0 to 255.
    Bytes(Vec<u8>),
    /// Of any range.
    Floats(Vec<f32>),
}

/// A part of a picture with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct SnapshotTile {
    /// Where it lies, texels of the texture.
    pub rect: Rect,
    /// What it is called.
    pub name: String,
}

/// Named outlines on a plane, such as volumes from above.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drawing {
    /// What it shows.
    pub title: String,
    /// What there is to know of it.
    pub caption: String,
    /// The outlines.
    pub outlines: Vec<Outline>,
}

/// A polygon with a name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outline {
    /// What it is.
    pub name: String,
    /// Its corners in turn, x to the right and y down; at least one.
    pub points: Vec<[f32; 2]>,
}

/// What the script reads: see `pictures.js`.
#[derive(Serialize)]
pub(super) struct SnapshotData<'p> {
    resource: ResourceId,
    version: u32,
    pass: Option<PassId>,
    subresource: String,
    full: [u32; 2],
    /// Where the part begins in its layer.
    origin: [u32; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    missing: Option<&'p str>,
    width: u32,
    height: u32,
    channels: u32,
    depth: bool,
    floats: bool,
    /// Whole numbers.
    integers: bool,
    /// The versions from this one on are shown together, as their passes draw beside each other.
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
        let words = if several || rect.is_some() { snapshot.subresource.to_string() } else { String::new() };
        Self {
            resource: snapshot.resource,
            version: snapshot.version,
            pass: snapshot.pass,
            subresource: words,
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
            data: texels.map(Texels::packed).unwrap_or_default(),
            tiles: snapshot.tiles.iter().map(|tile| TileData { rect: tile.rect, name: &tile.name }).collect(),
        }
    }
}

impl Texels {
    fn packed(&self) -> String {
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::default());
        // Writing into memory does not fail.
        let _written = match &self.values {
            TexelValues::Bytes(bytes) => packer.write_all(bytes),
            TexelValues::Floats(floats) => {
                let bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
                packer.write_all(&bytes)
            }
        };
        BASE64_STANDARD.encode(packer.finish().unwrap_or_default())
    }
}
