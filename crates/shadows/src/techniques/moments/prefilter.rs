//! The passes that turn depth maps into maps of moments.

use shadowgraph_core::{Bind, Buffer, Contents, Format, Frame, Subresource, Texture, TextureDesc, Uniform};
use shadowgraph_shaders::{ModuleSource, PREFILTER, compose_source};

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
        Ok(Self { map_layout, encodings, no_moments })
    }

    /// Adds the passes that compute the moments of a depth map, and returns the moments with their mips.
    pub(super) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        name: &'static str,
        map: &DrawnMap,
        views: &Buffer,
        (encoding, sizes, block): (u32, MomentMap, Uniform),
    ) -> Texture {
        let (Some(encoding), Some(desc)) =
            (self.encodings.get(encoding as usize), frame.texture_desc(&map.texture))
        else {
            return frame.import_texture("no moments", &self.no_moments, true);
        };
        if map.tiles.is_empty() {
            return frame.import_texture("no moments", &self.no_moments, true);
        }
        let [width, height] = [desc.size.width, desc.size.height].map(|side| side / sizes.downscale);
        frame.node(name, |frame| {
            let tiles: Vec<u32> = map.tiles.iter().map(|(_, view)| *view).collect();
            let tiles = frame.upload_buffer("tiles", bytemuck::cast_slice(&tiles).to_vec());
            let shared = (views, &tiles, block);
            let unpacked = TextureDesc::d2(width, height, UNPACKED);
            let mut resolved = frame.create_texture("resolved", unpacked);
            self.step(frame, ("resolve", &encoding.resolve), shared, (&map.texture, 0), (&mut resolved, 0));
            let mut across = frame.create_texture("blurred across", unpacked);
            self.step(frame, ("across", &encoding.across), shared, (&resolved, 0), (&mut across, 0));
            let moments =
                TextureDesc { mip_levels: sizes.mips, ..TextureDesc::d2(width, height, encoding.format) };
            let mut moments = frame.create_texture("moments", moments);
            self.step(frame, ("down", &encoding.down), shared, (&across, 0), (&mut moments, 0));
            for mip in 1..sizes.mips {
                let finer = moments.clone();
                self.step(frame, ("halve", &encoding.halve), shared, (&finer, mip - 1), (&mut moments, mip));
            }
            moments
        })
    }

    /// Adds a pass that computes a mip of one texture from a mip of another.
    fn step<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (name, step): (&'static str, &'f Step),
        (views, tiles, block): (&Buffer, &Buffer, Uniform),
        (from, from_mip): (&Texture, u32),
        (to, to_mip): (&mut Texture, u32),
    ) {
        let size = frame.texture_desc(to).map_or([0; 2], |desc| [desc.size.width, desc.size.height]);
        let [x, y] = size.map(|side| (side >> to_mip).div_ceil(WORKGROUP));
        let mut pass = frame.compute_pass(name);
        let (views, tiles) = (pass.storage_buffer(views), pass.storage_buffer(tiles));
        let from = pass.subresource(Subresource::FULL.mip(from_mip)).sample(from);
        let to = pass.subresource(Subresource::FULL.mip(to_mip)).storage_texture_mut(to, Contents::Overwrite);
        pass.body(move |ctx| {
            let map = [Bind::Buffer(views), Bind::Buffer(tiles), Bind::Uniform(block)];
            let groups = [
                ctx.bind_group(&self.map_layout, &map)?,
                ctx.bind_group(&step.layout, &[Bind::Texture(from), Bind::Texture(to)])?,
            ];
            dispatch(&mut ctx.pass, &step.pipeline, &groups, [x, y, 1]);
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
        let source = PREFILTER.source.replace("FORMAT, write", &format!("{format_name}, write"));
        let module = compose_source(&ModuleSource::new(PREFILTER.file, source), &S::modules(encoding))?;
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
