//! Checks of the values that passes write, after each pass.

use super::Executed;
use super::record::record;
use crate::compile::keeping;
use crate::compiled::Compiled;
use crate::context::Recording;
use crate::declaration::{AccessDecl, Declaration};
use crate::desc::ResourceDesc;
use crate::error::Error;
use crate::handle::{PassId, ResourceId};
use crate::internal::{COUNT_WORDS, ImageKind, ImagePart, TEXEL_WORDS, ValueChecks, ValueStep};
use crate::plan::Plan;
use crate::pool::Pool;
use crate::read_back::ReadBack;
use crate::subresource::Aspect;
use crate::timer::Timer;
use crate::values::{BadValues, Texel, ValueCheck, ValueReport};
use std::ops::{Range, RangeInclusive};
use std::sync::Arc;
use wgpu_types::TextureUsages;

/// The check of a frame that is on its way to the CPU.
#[must_use = "only `wait` returns the report"]
pub struct PendingValues {
    parts: Vec<CheckedPart>,
    unchecked: Vec<(ResourceId, String)>,
    words: Option<ReadBack>,
}

impl PendingValues {
    /// Waits for the submitted frame and returns what was found.
    ///
    /// # Errors
    /// When the device is lost, or the encoder was not submitted.
    pub fn wait(self, device: &wgpu::Device) -> Result<ValueReport, Error> {
        let bytes = self.words.map_or_else(|| Ok(Vec::new()), |words| words.wait(device))?;
        let words: Vec<u32> = bytes.as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect();
        let bad = self.parts.iter().filter_map(|part| part.decode(&words)).collect();
        Ok(ValueReport { bad, unchecked: self.unchecked })
    }
}

/// A mip level of a texture that a pass has written.
struct CheckedPart {
    pass: PassId,
    /// The first of its words.
    first_word: u32,
    range: RangeInclusive<f32>,
    written: Image,
    inputs: Vec<Image>,
}

/// A mip level of a texture, and the part of it that is accessed.
#[derive(Clone)]
struct Image {
    texture: ResourceId,
    version: u32,
    kind: ImageKind,
    mip: u32,
    layers: Range<u32>,
    /// The first texel, and their number along each side.
    rect: [u32; 4],
    size: [u32; 2],
    channels: u32,
}

pub(super) fn record_checked(
    mut compiled: Compiled<'_>,
    (pool, pipelines): (&mut Pool, &mut Option<ValueChecks>),
    check: &ValueCheck,
    (device, encoder): (&wgpu::Device, &mut wgpu::CommandEncoder),
    timer: Option<&mut Timer>,
) -> Result<Executed, Error> {
    if pipelines.as_ref().is_some_and(|pipelines| !pipelines.is_of(device)) {
        *pipelines = None;
    }
    let pipelines = pipelines.get_or_insert_with(|| ValueChecks::new(device));
    let plan = compiled.plan.clone();
    compiled.plan = Arc::new(keeping(&plan, TextureUsages::TEXTURE_BINDING));
    let (parts, words) = parts(&plan, check);
    let words = (words > 0).then(|| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("value check"),
            size: 4 * u64::from(words),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        })
    });
    let mut unchecked: Vec<(ResourceId, String)> = Vec::new();
    let mut hook = |recording: &Recording<'_>, pass: PassId, encoder: &mut wgpu::CommandEncoder| {
        let Some(words) = &words else { return Ok(()) };
        for part in parts.iter().filter(|part| part.pass == pass) {
            if let Err(reason) = part.record(recording, pipelines, words, encoder)
                && !unchecked.iter().any(|(texture, _)| *texture == part.written.texture)
            {
                unchecked.push((part.written.texture, reason));
            }
        }
        Ok(())
    };
    let mut executed = record(compiled, pool, device, encoder, timer, Some(&mut hook))?.with_plan(plan);
    let read =
        |words: &wgpu::Buffer| ReadBack::buffer(device, encoder, "value check", words, 0..words.size());
    let words = words.as_ref().map(read).transpose()?;
    executed.values = Some(PendingValues { parts, unchecked, words });
    Ok(executed)
}

/// Returns what is checked after each pass, in their order, and the number of words that it needs.
fn parts(plan: &Plan, check: &ValueCheck) -> (Vec<CheckedPart>, u32) {
    let decl = &plan.decl;
    let mut next_word = 0;
    let mut parts = Vec::new();
    for &pass in &plan.order {
        let accesses = decl.accesses(pass);
        let inputs: Vec<Image> = accesses
            .iter()
            .filter(|access| !access.contents.writes())
            .filter_map(|access| images(decl, access, access.version).into_iter().next())
            .collect();
        for access in accesses.iter().filter(|access| access.contents.writes()) {
            for written in images(decl, access, access.version + 1) {
                let format = match decl.resource(access.resource).desc {
                    ResourceDesc::Texture(desc) => desc.format,
                    ResourceDesc::Buffer(_) => continue,
                };
                let (name, path) = (decl.resource_name(access.resource), decl.resource_path(access.resource));
                let declared = check.range_of(name, &path);
                let range = declared.clone().unwrap_or(match format.is_depth_stencil_format() {
                    true => 0.0..=1.0,
                    false => f32::MIN..=f32::MAX,
                });
                // Formats without a float never hold NaN.
                let can_be_bad = declared.is_some() || is_float(format);
                if written.kind.has_floats() && can_be_bad {
                    let same_shape = |input: &&Image| input.has_shape_of(&written);
                    let inputs: Vec<Image> = inputs.iter().filter(same_shape).cloned().collect();
                    let first_word = next_word;
                    next_word += COUNT_WORDS + TEXEL_WORDS * (1 + inputs.len() as u32);
                    parts.push(CheckedPart { pass, first_word, range, written, inputs });
                }
            }
        }
    }
    (parts, next_word)
}

/// Returns whether texels of a format can be NaN, infinite, or depth outside of 0 to 1.
fn is_float(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(
        format,
        F::R16Float
            | F::Rg16Float
            | F::Rgba16Float
            | F::R32Float
            | F::Rg32Float
            | F::Rgba32Float
            | F::Rg11b10Ufloat
            | F::Depth32Float
            | F::Depth32FloatStencil8
    )
}

/// Returns each mip level that an access touches; none for buffers, the stencil, and textures that shaders cannot read.
fn images(decl: &Declaration, access: &AccessDecl, version: u32) -> Vec<Image> {
    let ResourceDesc::Texture(desc) = decl.resource(access.resource).desc else { return Vec::new() };
    let part = decl.subresource(access);
    let kind = ImageKind::for_texture(desc.format, desc.dimension, desc.samples);
    let Some(kind) = kind.filter(|_| part.aspect != Aspect::Stencil) else { return Vec::new() };
    let (first, end) = part.mips.unwrap_or((0, desc.mip_levels));
    (first..end)
        .map(|mip| {
            let size = desc.size.mip_level_size(mip, desc.dimension);
            let all = [0, 0, size.width, size.height];
            let rect = part.rect.map_or(all, |rect| [rect.x, rect.y, rect.width, rect.height]);
            let channels =
                if desc.format.has_depth_aspect() { 1 } else { u32::from(desc.format.components()) };
            let layers = part.layer_range(&desc, mip);
            let size = [size.width, size.height];
            Image { texture: access.resource, version, kind, mip, layers, rect, size, channels }
        })
        .collect()
}

impl CheckedPart {
    /// Records the steps of the check. An error is the reason why it cannot be checked.
    fn record(
        &self,
        recording: &Recording<'_>,
        pipelines: &mut ValueChecks,
        words: &wgpu::Buffer,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), String> {
        let view = self.written.view(recording)?;
        let label = Some("value check");
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
        let mut step = |image: &Image, view: &wgpu::TextureView, step, copied| {
            let part = self.part(image, copied);
            pipelines.record(&mut pass, (image.kind, view), words, (step, &part));
        };
        step(&self.written, &view, ValueStep::Count, 0);
        let first_texel = self.first_word + COUNT_WORDS;
        step(&self.written, &view, ValueStep::Copy, first_texel);
        for (input, index) in self.inputs.iter().zip(1..) {
            // A texture without the usage has no value in the report.
            if let Ok(view) = input.view(recording) {
                step(input, &view, ValueStep::Copy, first_texel + TEXEL_WORDS * index);
            }
        }
        Ok(())
    }

    fn part(&self, image: &Image, copied: u32) -> ImagePart {
        ImagePart {
            written: self.written.rect,
            written_size: self.written.size,
            size: image.size,
            layers: image.layers.end - image.layers.start,
            channels: image.channels,
            counts: self.first_word,
            copied,
            range: self.range.clone(),
        }
    }

    /// Returns what was found; `None` if all values are good.
    fn decode(&self, words: &[u32]) -> Option<BadValues> {
        let own = words.get(self.first_word as usize..)?;
        let &[nan, infinite, outside, found] = own.first_chunk::<4>()?;
        if found == 0 {
            return None;
        }
        let mut texels = own[COUNT_WORDS as usize..].chunks_exact(TEXEL_WORDS as usize);
        let first = self.written.texel(texels.next()?);
        let inputs = self.inputs.iter().zip(texels).map(|(input, texel)| input.texel(texel)).collect();
        let range = self.range.clone();
        Some(BadValues { pass: self.pass, nan, infinite, outside, range, first, inputs })
    }
}

impl Image {
    /// Returns whether the sides have the same ratio, but for rounding: pixels correspond.
    fn has_shape_of(&self, other: &Self) -> bool {
        let ([width, height], [other_width, other_height]) = (self.size, other.size);
        let [across, down] =
            [(width, other_height), (height, other_width)].map(|(a, b)| f64::from(a) * f64::from(b));
        (across - down).abs() <= 0.02 * across.max(down)
    }

    fn view(&self, recording: &Recording<'_>) -> Result<wgpu::TextureView, String> {
        let texture = recording.texture(self.texture).map_err(|error| error.to_string())?;
        if !texture.usage().contains(TextureUsages::TEXTURE_BINDING) {
            return Err("it lacks the usage TEXTURE_BINDING".into());
        }
        Ok(self.kind.view(texture, self.mip, &self.layers))
    }

    /// Returns a copied texel.
    fn texel(&self, words: &[u32]) -> Texel {
        let (at, bits) = words.split_at(3);
        let value = bits.iter().take(self.channels as usize).map(|&bits| self.kind.decode(bits)).collect();
        Texel {
            texture: self.texture,
            version: self.version,
            mip: self.mip,
            at: [at[0], at[1], self.layers.start + at[2]],
            value,
        }
    }
}
