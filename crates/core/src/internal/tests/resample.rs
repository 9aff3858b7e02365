//! Resampling, compared with the same mapping on the CPU.

use super::Gpu;
use super::region_clear::{COLORS, DEPTH_STENCILS};
use crate::Rect;
use crate::desc::{Format, TextureDesc};
use crate::internal::resample::{open_pass, view};
use crate::internal::{RegionClear, RegionClears, ResampleError, Resampler, Targets, can_resample};
use wgpu::TextureAspect::All;

const SIZES: [([u32; 2], [u32; 2]); 5] =
    [([3, 2], [7, 5]), ([4, 4], [8, 8]), ([8, 8], [4, 4]), ([7, 5], [3, 2]), ([5, 3], [5, 3])];

fn extent([width, height]: [u32; 2], layers: u32) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: layers }
}

/// Fills one mip and layer with a different value in every texel.
fn fill(gpu: &Gpu, clears: &mut RegionClears, texture: &wgpu::Texture, mip: u32, layer: u32) {
    let format = texture.format();
    let class = format.sample_type(None, None).unwrap();
    let depth = class == wgpu::TextureSampleType::Depth;
    let targets = Targets {
        colors: if depth { vec![] } else { vec![Some(format)] },
        depth_stencil: depth.then_some(format),
        samples: 1,
    };
    let whole = matches!(class, wgpu::TextureSampleType::Uint | wgpu::TextureSampleType::Sint);
    let size = texture.size().mip_level_size(mip, texture.dimension());
    gpu.submit(|encoder| {
        let mut pass = open_pass(encoder, &view(texture, mip, layer));
        for texel in 0..size.width * size.height {
            let value = f64::from((texel + 64 * (layer + mip)) % 120);
            let value = if whole { value } else { value / 120.0 };
            let (x, y) = (texel % size.width, texel / size.width);
            let clear = RegionClear {
                colors: &[Some([value, value / 2.0, 1.0, 0.0])],
                depth: Some(value as f32),
                stencil: None,
                rect: Rect { x, y, width: 1, height: 1 },
            };
            clears.record(&gpu.device, &mut pass, &targets, &clear);
        }
    });
}

/// Returns a filled source and the resampled target.
fn resample(
    gpu: &Gpu,
    format: Format,
    (from, to): ([u32; 2], [u32; 2]),
    (mips, layers): (u32, u32),
) -> (wgpu::Texture, wgpu::Texture) {
    let source = gpu.texture(format, extent(from, layers), mips, 1);
    let target = gpu.texture(format, extent(to, layers), 2, 1);
    let mut clears = RegionClears::default();
    for (mip, layer) in (0..mips).flat_map(|mip| (0..layers).map(move |layer| (mip, layer))) {
        fill(gpu, &mut clears, &source, mip, layer);
    }
    let mut resampler = Resampler::default();
    let recorded = gpu.submit(|encoder| resampler.record(&gpu.device, encoder, &source, &target));
    assert_eq!(recorded, Ok(()));
    (source, target)
}

/// Compares all mips and layers with the source texel at each centre.
fn check_nearest(gpu: &Gpu, (source, target): (wgpu::Texture, wgpu::Texture)) {
    for (mip, layer) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let from_mip = mip.min(source.mip_level_count() - 1);
        let from = source.size().mip_level_size(from_mip, source.dimension());
        let to = target.size().mip_level_size(mip, target.dimension());
        let texels = gpu.read(&source, All, from_mip, layer);
        let nearest = |index: u32| {
            let x = (2 * (index % to.width) + 1) * from.width / (2 * to.width);
            let y = (2 * (index / to.width) + 1) * from.height / (2 * to.height);
            texels[(y * from.width + x) as usize].clone()
        };
        let expected: Vec<_> = (0..to.width * to.height).map(nearest).collect();
        let read = gpu.read(&target, All, mip, layer);
        assert_eq!(read, expected, "{:?} {from:?} to {to:?}, mip {mip}", source.format());
    }
}

#[test]
fn formats_that_cannot_be_filtered_use_the_texel_at_the_centre() {
    let Some(gpu) = Gpu::real() else { return };
    let formats =
        [Format::R32Uint, Format::Rgba8Sint, Format::R32Float, Format::Depth32Float, Format::Depth16Unorm];
    for format in formats {
        for sizes in SIZES {
            check_nearest(&gpu, resample(&gpu, format, sizes, (1, 2)));
        }
        check_nearest(&gpu, resample(&gpu, format, ([8, 6], [4, 9]), (2, 2)));
    }
}

#[test]
fn color_is_filtered_bilinearly() {
    let Some(gpu) = Gpu::real() else { return };
    for sizes in SIZES {
        let (source, target) = resample(&gpu, Format::Rgba8Unorm, sizes, (1, 2));
        for layer in 0..2 {
            let texels = gpu.read(&source, All, 0, layer);
            let read = gpu.read(&target, All, 0, layer);
            for (index, texel) in read.iter().enumerate() {
                let place = [index as u32 % sizes.1[0], index as u32 / sizes.1[0]];
                let expected = bilinear(&texels, sizes, place);
                let error = |(a, b): (&u8, f64)| (f64::from(*a) - b).abs();
                // Filter weights have 8 bits.
                let worst = texel.iter().zip(expected).map(error).fold(0.0, f64::max);
                assert!(worst < 1.5, "{sizes:?} {place:?}: {texel:?}, not {expected:?}");
            }
        }
    }
}

#[test]
fn the_same_size_is_a_copy() {
    let Some(gpu) = Gpu::real() else { return };
    for format in [Format::Rgba8Unorm, Format::Rgba8UnormSrgb, Format::Rgba16Float] {
        let (source, target) = resample(&gpu, format, ([8, 5], [8, 5]), (2, 1));
        for mip in 0..2 {
            assert_eq!(gpu.read(&source, All, mip, 0), gpu.read(&target, All, mip, 0), "{format:?}");
        }
    }
}

/// Returns the weighted sum of the four source texels around a target texel, with clamped edges.
fn bilinear(texels: &[Vec<u8>], (from, to): ([u32; 2], [u32; 2]), place: [u32; 2]) -> [f64; 4] {
    let at = |axis: usize| {
        let at = (f64::from(place[axis]) + 0.5) * f64::from(from[axis]) / f64::from(to[axis]) - 0.5;
        let clamp = |texel: f64| texel.clamp(0.0, f64::from(from[axis] - 1)) as usize;
        [(clamp(at.floor()), 1.0 - at + at.floor()), (clamp(at.floor() + 1.0), at - at.floor())]
    };
    let mut sum = [0.0; 4];
    for (y, weight_y) in at(1) {
        for (x, weight_x) in at(0) {
            for (sum, value) in sum.iter_mut().zip(&texels[y * from[0] as usize + x]) {
                *sum += weight_x * weight_y * f64::from(*value);
            }
        }
    }
    sum
}

#[test]
fn every_supported_format_validates() {
    let gpu = Gpu::noop();
    let features = gpu.device.features();
    let formats = COLORS.iter().map(|(format, _)| *format).chain(DEPTH_STENCILS);
    let fits = |format: &Format| can_resample(&TextureDesc::d2(4, 4, *format), features).is_ok();
    let fitting: Vec<_> = formats.filter(fits).collect();
    assert_eq!(fitting.len(), 28);
    for format in fitting {
        resample(&gpu, format, ([8, 8], [4, 4]), (1, 2));
    }
}

#[test]
fn unsupported_shapes_are_errors_with_the_reason() {
    let features = wgpu::Features::empty();
    let d2 = |format| TextureDesc::d2(4, 4, format);
    let plain = d2(Format::Rgba8Unorm);
    assert_eq!(can_resample(&plain, features), Ok(()));
    for format in [Format::Stencil8, Format::Depth24PlusStencil8, Format::R8Snorm, Format::Bc1RgbaUnorm] {
        assert_eq!(can_resample(&d2(format), features), Err(ResampleError::Format), "{format:?}");
    }
    assert_eq!(can_resample(&TextureDesc { samples: 4, ..plain }, features), Err(ResampleError::Samples));
    let volume = TextureDesc { dimension: wgpu::TextureDimension::D3, ..plain };
    assert_eq!(can_resample(&volume, features), Err(ResampleError::Dimension));
}

#[test]
fn textures_that_do_not_match_record_nothing() {
    let gpu = Gpu::noop();
    let texture = |format, layers| gpu.texture(format, extent([4, 4], layers), 1, 1);
    let sampled = texture(Format::Rgba8Unorm, 1);
    let not_sampled = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent([4, 4], 1),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Format::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let pairs = [
        (&sampled, &texture(Format::R8Unorm, 1), ResampleError::Different),
        (&sampled, &texture(Format::Rgba8Unorm, 2), ResampleError::Different),
        (&not_sampled, &sampled, ResampleError::Usage),
        (&sampled, &texture(Format::Depth24PlusStencil8, 1), ResampleError::Format),
    ];
    for (source, target, why) in pairs {
        let recorded =
            gpu.submit(|encoder| Resampler::default().record(&gpu.device, encoder, source, target));
        assert_eq!(recorded, Err(why));
    }
}
