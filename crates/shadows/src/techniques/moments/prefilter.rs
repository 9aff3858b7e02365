//! The passes that turn depth maps into maps of moments.

use std::sync::Arc;

use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, Subresource, Texture, TextureDesc, Uniform};
use shadowgraph_shaders::{PREFILTER, compose_source};

use super::kept::{AllMoments, KeptMoments, TileRevisions};
use super::{MomentMap, Moments};
use crate::error::Error;
use crate::maps::DrawnMap;
use crate::technique::binding::{DEPTH_MAP, FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::layout;
use crate::techniques::compute::{dispatch, pipeline, shader};

/// The binding of a map of moments: integers that the shader unpacks.
pub(super) const MOMENT_MAP: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Uint,
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};

/// The format of moments before they are packed.
const UNPACKED: Format = Format::Rgba32Float;

/// The side of a workgroup, texels.
const WORKGROUP: u32 = 8;

/// The passes, for each encoding of moments.
pub(super) struct Prefilter {
    map_layout: wgpu::BindGroupLayout,
    encodings: Vec<Encoding>,
    device: wgpu::Device,
    kept: AllMoments,
    /// A placeholder for a missing map.
    no_moments: wgpu::Texture,
}

struct Encoding {
    format: Format,
    resolve: Step,
    across: Step,
    down: Step,
    halve: Step,
}

/// The settings of a technique.
pub(super) struct Settings<'s> {
    pub(super) encoding: u32,
    pub(super) sizes: MomentMap,
    pub(super) bytes: &'s [u8],
    /// A uniform block of the bytes.
    pub(super) block: Uniform,
}

/// The tiles whose moments are computed.
struct Tiles {
    /// The widest side, texels of moments.
    side: u32,
    views: Vec<u32>,
    /// Their rectangles in the depth map, and the revisions of their contents.
    computed: TileRevisions,
}

/// The layout of a pass's bindings, and its pipeline.
struct Step {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl Prefilter {
    pub(super) fn new<S: Moments>(device: &wgpu::Device) -> Result<Self, Error> {
        let map_layout = layout(device, "moments of a map", &[STORAGE, STORAGE, UNIFORM]);
        let encodings = (0..S::LAYOUTS)
            .map(|encoding| Encoding::new::<S>(device, &map_layout, encoding))
            .collect::<Result<_, _>>()?;
        let no_moments = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("no moments"),
            size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Format::R32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Ok(Self { map_layout, encodings, device: device.clone(), kept: AllMoments::default(), no_moments })
    }

    /// Adds the passes that compute the moments of a depth map, and returns the moments with their mips. The moments of a kept map are
    /// kept too: those of tiles that were not drawn since they were computed stay.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (view, name): (u32, &'static str),
        map: &DrawnMap,
        views: &Buffer,
        own: &Settings<'_>,
    ) -> Texture {
        if map.revisions.is_empty() {
            self.kept.evict((view, name));
        }
        let (Some(encoding), Some(desc)) =
            (self.encodings.get(own.encoding as usize), frame.texture_desc(&map.texture))
        else {
            return frame.import_texture("no moments", &self.no_moments, true);
        };
        if map.tiles.is_empty() {
            return frame.import_texture("no moments", &self.no_moments, true);
        }
        let [width, height] = [desc.size.width, desc.size.height].map(|side| side / own.sizes.downscale);
        let desc =
            TextureDesc { mip_levels: own.sizes.mips, ..TextureDesc::d2(width, height, encoding.format) };
        let kept =
            (!map.revisions.is_empty()).then(|| self.kept.get(&self.device, (view, name), &desc, own.bytes));
        let mut tiles = Tiles { side: 0, views: Vec::new(), computed: Vec::new() };
        for (index, &(rect, view)) in map.tiles.iter().enumerate() {
            let revision = map.revisions.get(index).copied().unwrap_or_default();
            if kept.as_ref().is_none_or(|kept| !kept.has(rect, revision)) {
                tiles.side = tiles.side.max(rect.width.max(rect.height) / own.sizes.downscale);
                tiles.views.push(view);
                tiles.computed.push((rect, revision));
            }
        }
        frame.node(name, |frame| {
            let mut moments = match &kept {
                Some(kept) => frame.import_texture("moments", &kept.texture, true),
                None => frame.create_texture("moments", desc),
            };
            if !tiles.views.is_empty() {
                self.compute(frame, encoding, (map, views, own), tiles, &mut moments, kept);
            }
            moments
        })
    }

    /// Adds the passes that compute the moments of some tiles.
    fn compute<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        encoding: &'f Encoding,
        (map, views, own): (&DrawnMap, &Buffer, &Settings<'_>),
        tiles: Tiles,
        moments: &mut Texture,
        kept: Option<Arc<KeptMoments>>,
    ) {
        let Settings { sizes, block, .. } = *own;
        let Some(desc) = frame.texture_desc(moments) else { return };
        let (width, height) = (desc.size.width, desc.size.height);
        let count = tiles.views.len() as u32;
        let list = frame.upload_buffer("tiles", bytemuck::cast_slice(&tiles.views).to_vec());
        let shared = (views, &list, block);
        // What the passes do not write is read by none of them, and by no lookup.
        let groups = [tiles.side.div_ceil(WORKGROUP), tiles.side.div_ceil(WORKGROUP), count];
        let unpacked = TextureDesc::d2(width, height, UNPACKED);
        let mut resolved = frame.create_texture("resolved", unpacked);
        let (from, to) = ((&map.texture, 0), (&mut resolved, 0, Contents::Overwrite));
        self.step(frame, ("resolve", &encoding.resolve, groups), shared, from, to, None);
        let mut across = frame.create_texture("blurred across", unpacked);
        let to = (&mut across, 0, Contents::Overwrite);
        self.step(frame, ("across", &encoding.across, groups), shared, (&resolved, 0), to, None);
        let contents = if kept.is_some() { Contents::Preserve } else { Contents::Overwrite };
        let to = (&mut *moments, 0, contents);
        let done = kept.map(|kept| (kept, tiles.computed));
        self.step(frame, ("down", &encoding.down, groups), shared, (&across, 0), to, done);
        for mip in 1..sizes.mips {
            let finer = moments.clone();
            let [x, y] = [width, height].map(|side| (side >> mip).div_ceil(WORKGROUP));
            let (from, to) = ((&finer, mip - 1), (&mut *moments, mip, Contents::Overwrite));
            self.step(frame, ("halve", &encoding.halve, [x, y, 1]), shared, from, to, None);
        }
    }

    /// Adds a pass that computes a mip of one texture from a mip of another, and then notes the tiles of a kept map.
    fn step<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (name, step, groups): (&'static str, &'f Step, [u32; 3]),
        (views, tiles, block): (&Buffer, &Buffer, Uniform),
        (from, from_mip): (&Texture, u32),
        (to, to_mip, contents): (&mut Texture, u32, Contents),
        done: Option<(Arc<KeptMoments>, TileRevisions)>,
    ) {
        let mut pass = frame.compute_pass(name);
        let (views, tiles) = (pass.storage_buffer(views), pass.storage_buffer(tiles));
        let from = pass.subresource(Subresource::FULL.mip(from_mip)).sample(from);
        let to = pass.subresource(Subresource::FULL.mip(to_mip)).storage_texture_mut(to, contents);
        pass.body(move |ctx| {
            let map = [Bind::Buffer(views), Bind::Buffer(tiles), Bind::Uniform(block)];
            let bound = [
                ctx.bind_group(&self.map_layout, &map)?,
                ctx.bind_group(&step.layout, &[Bind::Texture(from), Bind::Texture(to)])?,
            ];
            dispatch(&mut ctx.pass, &step.pipeline, &bound, groups);
            if let Some((kept, computed)) = done {
                kept.set(&computed);
            }
            Ok(())
        });
    }
}

impl Encoding {
    fn new<S: Moments>(
        device: &wgpu::Device,
        map_layout: &wgpu::BindGroupLayout,
        encoding: u32,
    ) -> Result<Self, Error> {
        let format = S::format(encoding);
        let format_name = match format {
            Format::R32Uint => "r32uint",
            Format::Rg32Uint => "rg32uint",
            _ => "rgba32uint",
        };
        let source = PREFILTER.with_value("FORMAT, write", &format!("{format_name}, write"));
        let module = compose_source(&source, &S::modules(encoding))?;
        let shader = shader(device, "prefilter.wgsl", module);
        let step = |entry, from, to| Step::new(device, &shader, entry, map_layout, [from, written(to)]);
        Ok(Self {
            format,
            resolve: step("cs_resolve", DEPTH_MAP, UNPACKED),
            across: step("cs_across", FLOAT_MAP, UNPACKED),
            down: step("cs_down", FLOAT_MAP, format),
            halve: step("cs_halve", MOMENT_MAP, format),
        })
    }
}

impl Step {
    fn new(
        device: &wgpu::Device,
        shader: &wgpu::ShaderModule,
        entry: &str,
        map_layout: &wgpu::BindGroupLayout,
        types: [wgpu::BindingType; 2],
    ) -> Self {
        let layout = layout(device, entry, &types);
        let pipeline = pipeline(device, shader, entry, &[map_layout, &layout]);
        Self { layout, pipeline }
    }
}

fn written(format: Format) -> wgpu::BindingType {
    wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2,
    }
}
