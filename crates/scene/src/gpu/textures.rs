//! Textures and samplers of materials; each is created once.

use std::collections::BTreeMap;
use std::sync::{Arc, Weak};

#[cfg(feature = "gltf")]
use super::block_texture::{self, BlockTexture};
use super::limits;
use super::mips::{Encoding, Level, for_each_level, level_count};
use crate::error::Error;
use crate::keys::ImageKey;
use crate::material::{Filter, Image, Sampler, Wrap};
use crate::scene::Scene;

/// Bytes that are written to the queue between submissions, so that they do not accumulate in memory.
const BYTES_IN_FLIGHT: usize = 64 << 20;
/// The anisotropy of smooth filters.
const ANISOTROPY: u16 = 4;

/// Interpretation of an image. An image that is read in two ways becomes two textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Reading {
    pub(super) encoding: Encoding,
    /// The smallest alpha (1 to 255) that is drawn, if the texture is alpha-tested.
    pub(super) cutoff: Option<u8>,
}

/// Textures and samplers of a scene, created on first use. A texture is freed with its last user.
pub(super) struct Textures {
    device: wgpu::Device,
    queue: wgpu::Queue,
    limits: wgpu::Limits,
    textures: BTreeMap<(ImageKey, Reading), Weak<wgpu::TextureView>>,
    samplers: BTreeMap<Sampler, wgpu::Sampler>,
    bytes_in_flight: usize,
}

impl Textures {
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            device: device.clone(),
            queue: queue.clone(),
            limits: device.limits(),
            textures: BTreeMap::new(),
            samplers: BTreeMap::new(),
            bytes_in_flight: 0,
        }
    }

    /// Returns the texture of an image.
    ///
    /// # Errors
    /// The image is larger than the device allows, or does not exist.
    pub(super) fn image(
        &mut self,
        scene: &Scene,
        key: ImageKey,
        reading: Reading,
    ) -> Result<Arc<wgpu::TextureView>, Error> {
        if let Some(view) = self.textures.get(&(key, reading)).and_then(Weak::upgrade) {
            return Ok(view);
        }
        let image = scene.image(key).ok_or_else(|| Error::missing("image"))?;
        limits::image(&self.limits, image)?;
        let view = Arc::new(self.upload(image, reading));
        self.textures.insert((key, reading), Arc::downgrade(&view));
        Ok(view)
    }

    /// Removes the textures of an image that was replaced or removed, for those who ask from now on.
    pub(super) fn remove(&mut self, image: ImageKey) {
        self.textures.retain(|(key, _), view| *key != image && view.strong_count() > 0);
    }

    /// Returns the number of textures in use.
    #[cfg(test)]
    pub(super) fn count(&self) -> usize {
        self.textures.values().filter(|view| view.strong_count() > 0).count()
    }

    /// Creates a texture of one colour, for materials without an image. It has mip levels, as most images have: software drivers
    /// compile shaders again for textures without.
    pub(super) fn plain(&mut self, name: &str, rgba: [u8; 4], encoding: Encoding) -> Arc<wgpu::TextureView> {
        let image = Image::new(name, 2, 2, rgba.repeat(4));
        Arc::new(self.upload(&image, Reading { encoding, cutoff: None }))
    }

    /// Returns the sampler with these properties.
    pub(super) fn sampler(&mut self, sampler: Sampler) -> wgpu::Sampler {
        let device = &self.device;
        let create = || {
            let anisotropy = anisotropy(device.adapter_info().device_type);
            device.create_sampler(&sampler_descriptor(&sampler, anisotropy))
        };
        self.samplers.entry(sampler).or_insert_with(create).clone()
    }

    fn upload(&mut self, image: &Image, reading: Reading) -> wgpu::TextureView {
        // The levels of alpha-tested textures are computed, so that they keep their coverage.
        #[cfg(feature = "gltf")]
        if reading.cutoff.is_none()
            && reading.encoding != Encoding::Alpha
            && let Some(blocks) = BlockTexture::transcode(self.device.features(), image, reading.encoding)
        {
            return self.upload_blocks(image, &blocks);
        }
        let format = match reading.encoding {
            Encoding::Linear => wgpu::TextureFormat::Rgba8Unorm,
            Encoding::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
            Encoding::Alpha => wgpu::TextureFormat::R8Unorm,
        };
        let texture = self.create(image, format);
        for_each_level(image, reading.encoding, reading.cutoff, |Level { number, width, height, rgba8 }| {
            if reading.encoding == Encoding::Alpha {
                let alphas: Vec<u8> = rgba8.chunks_exact(4).map(|pixel| pixel[3]).collect();
                self.write(&texture, number, &alphas, width, extent(width, height));
            } else {
                self.write(&texture, number, rgba8, width * 4, extent(width, height));
            }
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    #[cfg(feature = "gltf")]
    fn upload_blocks(&mut self, image: &Image, blocks: &BlockTexture) -> wgpu::TextureView {
        let texture = self.create(image, blocks.format);
        for (number, bytes) in (0..).zip(&blocks.levels) {
            let [width, height] = [image.width, image.height].map(|size| (size >> number).max(1));
            let size = extent(block_texture::physical_size(width), block_texture::physical_size(height));
            self.write(&texture, number, bytes, block_texture::bytes_per_row(width), size);
        }
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Creates the texture of an image with all mip levels.
    fn create(&self, image: &Image, format: wgpu::TextureFormat) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(&image.name),
            size: extent(image.width, image.height),
            mip_level_count: level_count(image.width, image.height),
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    }

    fn write(
        &mut self,
        texture: &wgpu::Texture,
        mip_level: u32,
        bytes: &[u8],
        bytes_per_row: u32,
        size: wgpu::Extent3d,
    ) {
        let (origin, aspect) = (wgpu::Origin3d::ZERO, wgpu::TextureAspect::All);
        let target = wgpu::TexelCopyTextureInfo { texture, mip_level, origin, aspect };
        let rows = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes_per_row),
            rows_per_image: None,
        };
        self.queue.write_texture(target, bytes, rows, size);
        self.bytes_in_flight += bytes.len();
        if self.bytes_in_flight > BYTES_IN_FLIGHT {
            self.queue.submit([]);
            self.bytes_in_flight = 0;
        }
    }
}

fn extent(width: u32, height: u32) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// Returns the anisotropy of smooth filters on a type of device. Mesa's software driver visits every texel under a pixel, so
/// that a frame with a floor that extends to the horizon at a grazing angle would take it minutes or more.
fn anisotropy(device: wgpu::DeviceType) -> u16 {
    if device == wgpu::DeviceType::Cpu { 1 } else { ANISOTROPY }
}

fn sampler_descriptor(sampler: &Sampler, anisotropy: u16) -> wgpu::SamplerDescriptor<'static> {
    let wrap = |wrap: Wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirrorRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    };
    let filter = |filter: Filter| match filter {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    let smooth = [Some(sampler.mag), Some(sampler.min), sampler.mip] == [Some(Filter::Linear); 3];
    wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wrap(sampler.wrap_u),
        address_mode_v: wrap(sampler.wrap_v),
        mag_filter: filter(sampler.mag),
        min_filter: filter(sampler.min),
        mipmap_filter: match sampler.mip {
            Some(Filter::Linear) => wgpu::MipmapFilterMode::Linear,
            _ => wgpu::MipmapFilterMode::Nearest,
        },
        // Below a level of detail of one half the nearest level is the largest.
        lod_max_clamp: if sampler.mip.is_some() { 32.0 } else { 0.25 },
        anisotropy_clamp: if smooth { anisotropy } else { 1 },
        ..wgpu::SamplerDescriptor::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samplers_without_mips_use_the_largest_level_and_smooth_ones_are_anisotropic() {
        let flat = Sampler { mip: None, ..Sampler::default() };
        assert!(sampler_descriptor(&flat, ANISOTROPY).lod_max_clamp < 0.5);
        assert_eq!(sampler_descriptor(&flat, ANISOTROPY).anisotropy_clamp, 1);
        assert_eq!(sampler_descriptor(&Sampler::default(), ANISOTROPY).anisotropy_clamp, ANISOTROPY);
    }

    #[test]
    fn a_software_driver_has_no_anisotropic_filtering() {
        assert_eq!(anisotropy(wgpu::DeviceType::Cpu), 1);
        assert_eq!(anisotropy(wgpu::DeviceType::IntegratedGpu), ANISOTROPY);
    }
}
