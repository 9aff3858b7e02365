//! The bind groups of materials: group 2.

use std::collections::BTreeMap;
use std::num::NonZeroU64;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use super::draw_list::MaterialUse;
use super::instances::instance_layout;
use super::material_features::MaterialFeatures;
use super::mips::Encoding;
use super::numbers::Numbers;
use super::textures::{Reading, Textures};
use super::write_batch::WriteBatch;
use crate::error::Error;
use crate::keys::{ImageKey, MaterialKey};
use crate::material::{AlphaMode, Material, Sampler, TextureRef};
use crate::scene::Scene;

/// Stride of materials in their buffer, bytes: the alignment that every device supports.
const STRIDE: u64 = 256;
/// Number of uniforms in a buffer.
const BLOCK: usize = 64;
const TEXTURES: usize = 5;

const MASK: u32 = 1;
const BLEND: u32 = 2;
const UNLIT: u32 = 4;
const DOUBLE_SIDED: u32 = 8;
const NORMAL_MAP: u32 = 16;
const UNSHADOWED: u32 = 32;
const TRANSMIT: u32 = 64;

/// `Material` of `material.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct MaterialUniform {
    base_color: Vec4,
    emissive: Vec3,
    metallic: f32,
    roughness: f32,
    normal_scale: f32,
    occlusion_strength: f32,
    alpha_cutoff: f32,
    uv_sets: u32,
    flags_index: u32,
    caster_cutoff: f32,
    pad: u32,
    uv_transforms: [[f32; 4]; 2 * TEXTURES],
    flags: [[u32; 4]; 2],
}

/// The layouts of the bind groups that draws need.
#[derive(Clone, Debug)]
pub struct MaterialLayouts {
    /// Group 2, a material: a uniform buffer, visible to both stages, five textures and five samplers, visible to the fragment stage.
    pub material: wgpu::BindGroupLayout,
    /// Group 3, the transforms of all instances: a storage buffer; visible to the vertex stage.
    pub draw: wgpu::BindGroupLayout,
}

impl MaterialLayouts {
    /// Creates the layouts. Those of one device are compatible, so pipelines and scenes may each create their own.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let entry = |binding: u32, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: if binding == 0 {
                wgpu::ShaderStages::VERTEX_FRAGMENT
            } else {
                wgpu::ShaderStages::FRAGMENT
            },
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let count = TEXTURES as u32;
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: uniform_size(),
        };
        let uniform = [entry(0, uniform)];
        let textures = (1..=count).map(|binding| entry(binding, texture));
        let samplers = (1..=count).map(|binding| entry(count + binding, sampler));
        let entries: Vec<_> = uniform.into_iter().chain(textures).chain(samplers).collect();
        Self {
            material: device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("material"),
                entries: &entries,
            }),
            draw: instance_layout(device),
        }
    }
}

fn uniform_size() -> Option<NonZeroU64> {
    NonZeroU64::new(size_of::<MaterialUniform>() as u64)
}

/// Bind groups of materials, and the images that they use.
pub(super) struct Materials {
    layout: wgpu::BindGroupLayout,
    textures: Textures,
    /// For values, and for colours.
    white: Arc<wgpu::TextureView>,
    white_color: Arc<wgpu::TextureView>,
    flat: Arc<wgpu::TextureView>,
    /// Buffers of [`BLOCK`] uniforms each.
    uniforms: Vec<wgpu::Buffer>,
    writes: WriteBatch,
    /// Numbers of materials that receive shadows, and of those of instances that do not.
    numbers: [Numbers<MaterialKey>; 2],
    /// By number times two, plus one for those that do not receive shadows.
    groups: Vec<Option<MaterialGroup>>,
    /// Whether some pixel of an image is translucent.
    translucent: BTreeMap<ImageKey, bool>,
    /// What the materials use, and those that were uploaded before.
    pub(super) features: MaterialFeatures,
}

/// The bind groups of a material.
pub(super) struct MaterialGroup {
    key: MaterialKey,
    all: wgpu::BindGroup,
    alpha: wgpu::BindGroup,
    /// Changes with the material.
    version: u64,
    /// The images, which live as long as a material uses them.
    images: Vec<(ImageKey, Arc<wgpu::TextureView>)>,
}

impl MaterialGroup {
    /// Returns the bind group of a pipeline that reads so much.
    pub(super) fn get(&self, material: MaterialUse) -> &wgpu::BindGroup {
        if material == MaterialUse::Alpha { &self.alpha } else { &self.all }
    }
}

impl Materials {
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue, layouts: &MaterialLayouts) -> Self {
        let mut textures = Textures::new(device, queue);
        Self {
            layout: layouts.material.clone(),
            white: textures.plain("white", [255; 4], Encoding::Linear),
            white_color: textures.plain("white", [255; 4], Encoding::Srgb),
            flat: textures.plain("flat normal", [128, 128, 255, 255], Encoding::Linear),
            textures,
            uniforms: Vec::new(),
            writes: WriteBatch::default(),
            numbers: Default::default(),
            groups: Vec::new(),
            translucent: BTreeMap::new(),
            features: MaterialFeatures::default(),
        }
    }

    /// Returns the bind groups of a material.
    pub(super) fn group(&self, number: u32) -> Option<&MaterialGroup> {
        self.groups.get(number as usize)?.as_ref()
    }

    /// Returns a number that changes with the material.
    pub(super) fn version(&self, number: u32) -> u64 {
        self.groups.get(number as usize).and_then(Option::as_ref).map_or(0, |entry| entry.version)
    }

    /// Returns the number of a material for instances that receive shadows or do not; uploads it on first use.
    ///
    /// # Errors
    /// An image is larger than the device allows, or the material does not exist.
    pub(super) fn number(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        (key, receives): (MaterialKey, bool),
        version: u64,
    ) -> Result<u32, Error> {
        let kind = usize::from(!receives);
        let number = self.numbers[kind].insert(key) * 2 + kind as u32;
        if self.group(number).is_none() {
            self.upload((device, queue), scene, key, number, version)?;
        }
        Ok(number)
    }

    /// Uploads a replaced material again, or frees a removed one.
    ///
    /// # Errors
    /// An image is larger than the device allows.
    pub(super) fn update(
        &mut self,
        gpu: (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        key: MaterialKey,
        version: u64,
    ) -> Result<(), Error> {
        for kind in [0, 1] {
            let Some(number) = self.numbers[kind as usize].get(key) else { continue };
            if scene.material(key).is_some() {
                self.upload(gpu, scene, key, number * 2 + kind, version)?;
            } else {
                self.numbers[kind as usize].remove(key);
                self.groups[(number * 2 + kind) as usize] = None;
            }
        }
        Ok(())
    }

    /// Removes the textures of a replaced or removed image, and returns the materials that use them.
    pub(super) fn remove_image(&mut self, image: ImageKey) -> Vec<MaterialKey> {
        self.textures.remove(image);
        self.translucent.remove(&image);
        let uses = |entry: &&MaterialGroup| entry.images.iter().any(|(key, _)| *key == image);
        self.groups.iter().flatten().filter(uses).map(|entry| entry.key).collect()
    }

    /// Returns the number of textures of images.
    #[cfg(test)]
    pub(super) fn texture_count(&self) -> usize {
        self.textures.count()
    }

    /// Sends pending writes to the queue.
    pub(super) fn flush(&mut self, queue: &wgpu::Queue) {
        self.writes.flush(queue);
    }

    /// Returns the alpha of the base colour's texture, for casters.
    fn alpha(
        &mut self,
        scene: &Scene,
        material: &Material,
        images: &mut Vec<(ImageKey, Arc<wgpu::TextureView>)>,
    ) -> Result<Arc<wgpu::TextureView>, Error> {
        let Some(TextureRef { image, .. }) = material.base_color_texture else {
            return Ok(self.white.clone());
        };
        let is_translucent = || scene.image(image).is_some_and(|image| !image.is_opaque());
        if !*self.translucent.entry(image).or_insert_with(is_translucent) {
            return Ok(self.white.clone());
        }
        let reading = Reading { encoding: Encoding::Alpha, cutoff: texture_cutoff(material) };
        let view = self.textures.image(scene, image, reading)?;
        images.push((image, view.clone()));
        Ok(view)
    }

    fn upload(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        scene: &Scene,
        key: MaterialKey,
        number: u32,
        version: u64,
    ) -> Result<(), Error> {
        let material = scene.material(key).ok_or_else(|| Error::missing("material"))?;
        self.features = self.features.union(MaterialFeatures::new(material));
        let (mut views, mut samplers) = (Vec::with_capacity(TEXTURES), Vec::with_capacity(TEXTURES));
        let mut images = Vec::new();
        let slots = slots(material);
        let sampler = slots
            .iter()
            .find_map(|(reference, _)| *reference)
            .map_or_else(Sampler::default, |used| used.sampler);
        for (slot, (reference, reading)) in slots.into_iter().enumerate() {
            views.push(match reference {
                Some(TextureRef { image, .. }) => {
                    let view = self.textures.image(scene, image, reading)?;
                    images.push((image, view.clone()));
                    view
                }
                None if slot == 2 => self.flat.clone(),
                None if reading.encoding == Encoding::Srgb => self.white_color.clone(),
                None => self.white.clone(),
            });
            samplers.push(self.textures.sampler(reference.map_or(sampler, |used| used.sampler)));
        }
        let alpha = self.alpha(scene, material, &mut images)?;
        let (block, offset) = (number as usize / BLOCK, (number as usize % BLOCK) as u64 * STRIDE);
        while self.uniforms.len() <= block {
            self.uniforms.push(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("materials"),
                size: BLOCK as u64 * STRIDE,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        let buffer = &self.uniforms[block];
        let mut bytes = [0; STRIDE as usize];
        let uniform = uniform(material, number.is_multiple_of(2));
        bytes[..size_of::<MaterialUniform>()].copy_from_slice(bytemuck::bytes_of(&uniform));
        self.writes.write(queue, buffer, offset, &bytes);
        let uniform =
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset, size: uniform_size() });
        let group = |views: &[&wgpu::TextureView]| {
            let views = views.iter().map(|view| wgpu::BindingResource::TextureView(view));
            let samplers = samplers.iter().map(wgpu::BindingResource::Sampler);
            let resources = [uniform.clone()].into_iter().chain(views).chain(samplers);
            let entries =
                resources.zip(0..).map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource });
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&material.name),
                layout: &self.layout,
                entries: &entries.collect::<Vec<_>>(),
            })
        };
        let all = group(&views.iter().map(|view| &**view).collect::<Vec<_>>());
        let alpha = group(&[&alpha, &self.white, &self.white, &self.white, &self.white]);
        let index = number as usize;
        if index >= self.groups.len() {
            self.groups.resize_with(index + 1, || None);
        }
        self.groups[index] = Some(MaterialGroup { key, all, alpha, version, images });
        Ok(())
    }
}

/// Returns the textures of a material in the order of their bindings, and how each is read.
fn slots(material: &Material) -> [(Option<TextureRef>, Reading); TEXTURES] {
    let colors = Reading { encoding: Encoding::Srgb, cutoff: None };
    let values = Reading { encoding: Encoding::Linear, cutoff: None };
    let base_color = Reading { cutoff: texture_cutoff(material), ..colors };
    let [a, b, c, d, e] = material.textures();
    [(a, base_color), (b, values), (c, values), (d, values), (e, colors)]
}

/// Returns the texture's alpha at which a masked material begins to be drawn, ignoring vertex colours; `None` if it is
/// not between 1 and 255.
fn texture_cutoff(material: &Material) -> Option<u8> {
    let AlphaMode::Mask { cutoff } = material.alpha else { return None };
    let bytes = (cutoff / material.base_color.w * 255.0).ceil();
    (1.0..=255.0).contains(&bytes).then_some(bytes as u8)
}

fn uniform(material: &Material, receives: bool) -> MaterialUniform {
    let (alpha_flag, alpha_cutoff) = match material.alpha {
        AlphaMode::Opaque => (0, 0.0),
        AlphaMode::Mask { cutoff } => (MASK, cutoff),
        AlphaMode::Blend => (BLEND, 0.5),
        AlphaMode::Transmit => (BLEND | TRANSMIT, 0.5),
    };
    let flag = |set: bool, bit: u32| if set { bit } else { 0 };
    let mut uv_sets = 0;
    let mut uv_transforms = [[0.0; 4]; 2 * TEXTURES];
    for (slot, (reference, _)) in slots(material).into_iter().enumerate() {
        let rows = reference.map_or(TextureRef::UV_IDENTITY, |used| used.uv_transform);
        for (target, [x, y, z]) in uv_transforms[slot * 2..].iter_mut().zip(rows) {
            *target = [x, y, z, 0.0];
        }
        uv_sets |= flag(reference.is_some_and(|used| used.uv_set == 1), 1 << slot);
    }
    let flags = alpha_flag
        | flag(material.unlit, UNLIT)
        | flag(material.double_sided, DOUBLE_SIDED)
        | flag(material.normal_texture.is_some(), NORMAL_MAP)
        | flag(!(receives && material.receives_shadows), UNSHADOWED);
    MaterialUniform {
        base_color: material.base_color,
        emissive: material.emissive,
        metallic: material.metallic,
        roughness: material.roughness,
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        alpha_cutoff,
        uv_sets,
        flags_index: 0,
        caster_cutoff: material.caster_cutoff(),
        pad: 0,
        uv_transforms,
        flags: [[flags, 0, 0, 0]; 2],
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;

    #[test]
    fn the_uniform_has_the_layout_of_the_wgsl_struct() {
        let module = shadowgraph_shaders::compose("depth.wgsl", &[]).unwrap();
        shadowgraph_shaders::check_layout!(&module, "Material", MaterialUniform:
            base_color, emissive, metallic, roughness, normal_scale, occlusion_strength, alpha_cutoff,
            uv_sets, flags_index, caster_cutoff, uv_transforms, flags,
        )
        .unwrap();
        assert!(size_of::<MaterialUniform>() as u64 <= STRIDE);
    }

    #[test]
    fn flags_are_equal_to_those_of_the_wgsl() {
        let source = shadowgraph_shaders::builtin("material.wgsl").unwrap().source;
        for (name, value) in [
            ("MASK", MASK),
            ("BLEND", BLEND),
            ("UNLIT", UNLIT),
            ("DOUBLE_SIDED", DOUBLE_SIDED),
            ("NORMAL_MAP", NORMAL_MAP),
            ("UNSHADOWED", UNSHADOWED),
        ] {
            let line = format!("const MATERIAL_{name}: u32 = {value}u;");
            assert!(source.contains(&line), "{line}");
        }
    }

    #[test]
    fn the_uniform_has_the_flags_transforms_and_uv_sets_of_the_material() {
        let moved = TextureRef {
            uv_transform: [[2.0, 0.0, 0.5], [0.0, 3.0, 0.25]],
            ..TextureRef::new(ImageKey::default())
        };
        let material = Material {
            alpha: AlphaMode::Mask { cutoff: 0.3 },
            double_sided: true,
            normal_texture: Some(TextureRef { uv_set: 1, ..moved }),
            ..Material::default()
        };
        let uniform = uniform(&material, true);
        assert_eq!(uniform.flags[0][0], MASK | DOUBLE_SIDED | NORMAL_MAP);
        assert_eq!(super::uniform(&material, false).flags[0][0], uniform.flags[0][0] | UNSHADOWED);
        assert_eq!((uniform.alpha_cutoff, uniform.caster_cutoff), (0.3, 0.3));
        let material = Material { shadow_cutoff: Some(0.7), ..material };
        let uniform = super::uniform(&material, true);
        assert_eq!((uniform.alpha_cutoff, uniform.caster_cutoff), (0.3, 0.7));
        assert_eq!(uniform.uv_sets, 0b00100);
        assert_eq!(uniform.uv_transforms[4..6], [[2.0, 0.0, 0.5, 0.0], [0.0, 3.0, 0.25, 0.0]]);
        assert_eq!(uniform.uv_transforms[0..2], [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]);
    }

    #[test]
    fn a_lower_alpha_factor_raises_the_cutoff_of_the_texture() {
        let mask = |cutoff: f32, alpha: f32| Material {
            alpha: AlphaMode::Mask { cutoff },
            base_color: Vec4::new(1.0, 1.0, 1.0, alpha),
            ..Material::default()
        };
        assert_eq!(texture_cutoff(&mask(0.5, 1.0)), Some(128));
        assert_eq!(texture_cutoff(&mask(0.25, 0.5)), Some(128));
        assert_eq!(texture_cutoff(&mask(0.0, 1.0)), None);
        assert_eq!(texture_cutoff(&mask(0.5, 0.0)), None);
        assert_eq!(texture_cutoff(&Material::default()), None);
    }
}
