//! Decoding of PNG, JPEG, WebP and KTX2 images, on several threads where there are.

use std::borrow::Cow;
use std::io::Cursor;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::buffers::Buffers;
use super::error::{ImportError, WithLocation, clean_name, describe};
use super::files::Files;
use super::{ktx2, uri};
use crate::material::Image;

/// The largest width and height of an image, pixels.
pub const MAX_IMAGE_SIZE_PX: u32 = 16_384;
/// The maximum number of bytes of decoded images in a scene.
pub const MAX_IMAGE_BYTES: u64 = 1 << 32;
/// The maximum memory for decoding one image, bytes.
const MAX_DECODE_BYTES: u64 = 1 << 30;

/// Decodes the images with these indices in the file, and reports progress, 0 to 1. The location of an error names an image
/// that is missing, corrupt or too large.
pub(super) fn read(
    buffers: &Buffers<'_>,
    files: &Files<'_>,
    wanted: &[usize],
    progress: &mut dyn FnMut(f32),
) -> Vec<Result<Image, ImportError>> {
    let decoder = Decoder { buffers, files, budget_bytes: AtomicU64::new(MAX_IMAGE_BYTES) };
    let threads = thread::available_parallelism().map_or(1, usize::from).min(8).min(wanted.len());
    let mut done = 0;
    let mut report = || {
        done += 1;
        progress(done as f32 / wanted.len() as f32);
    };
    if threads <= 1 {
        let decode = |&index| {
            let result = decoder.image(index);
            report();
            result
        };
        return wanted.iter().map(decode).collect();
    }
    let next = AtomicUsize::new(0);
    let mut results: Vec<Option<Result<Image, ImportError>>> = wanted.iter().map(|_| None).collect();
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..threads {
            let (sender, decoder, next) = (sender.clone(), &decoder, &next);
            scope.spawn(move || {
                loop {
                    let slot = next.fetch_add(1, Ordering::Relaxed);
                    let Some(index) = wanted.get(slot) else { break };
                    if sender.send((slot, decoder.image(*index))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        for (slot, result) in receiver {
            report();
            if let Some(entry) = results.get_mut(slot) {
                *entry = Some(result);
            }
        }
    });
    results.into_iter().flatten().collect()
}

struct Decoder<'a> {
    buffers: &'a Buffers<'a>,
    files: &'a Files<'a>,
    /// The number of bytes of pixels that may still be decoded.
    budget_bytes: AtomicU64,
}

impl Decoder<'_> {
    fn image(&self, index: usize) -> Result<Image, ImportError> {
        let image = self.buffers.document().images.get(index);
        let image =
            image.ok_or_else(|| ImportError::new(describe("image", index, None), "does not exist"))?;
        let location = || match (&image.name, &image.uri) {
            (None, Some(uri)) => format!("image {index} {}", uri::quote(uri)),
            (name, _) => describe("image", index, name.as_deref()),
        };
        let bytes = match (&image.uri, image.buffer_view) {
            (Some(uri), _) => Cow::Owned(self.files.read(uri).with_location(location)?),
            (None, Some(view)) => {
                Cow::Borrowed(self.buffers.view(view.value()).with_location(location)?.bytes)
            }
            (None, None) => return Err(ImportError::new(location(), "has neither a URI nor a bufferView")),
        };
        let file_name = || {
            let path = uri::relative_path(image.uri.as_deref()?).ok()?;
            Some(path.file_name()?.to_string_lossy().into_owned())
        };
        let name = image.name.clone().or_else(file_name);
        self.decode(&clean_name(name.as_deref()), &bytes).with_location(location)
    }

    fn decode(&self, name: &str, bytes: &[u8]) -> Result<Image, String> {
        if ktx2::is_ktx2(bytes) {
            return ktx2::decode(name, bytes, |width, height| self.take_budget(width, height));
        }
        self.raster(name, bytes)
    }

    fn raster(&self, name: &str, bytes: &[u8]) -> Result<Image, String> {
        let decode_error = |error: image::ImageError| format!("cannot be decoded: {error}");
        let mut limits = Limits::default();
        limits.max_alloc = Some(MAX_DECODE_BYTES);
        let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
        let mut reader = reader.map_err(|error| format!("cannot be decoded: {error}"))?;
        if !matches!(reader.format(), Some(ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) {
            return Err("is neither PNG, JPEG, WebP nor KTX2".into());
        }
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(decode_error)?;
        let (width, height) = decoder.dimensions();
        self.take_budget(width, height)?;
        if decoder.total_bytes() > MAX_DECODE_BYTES {
            return Err(format!("needs more than {MAX_DECODE_BYTES} bytes, the limit for one image"));
        }
        let pixels = DynamicImage::from_decoder(decoder).map_err(decode_error)?;
        Ok(Image::new(name, width, height, pixels.into_rgba8().into_raw()))
    }

    /// Checks the size of an image, and counts its pixels against the limit of a scene.
    fn take_budget(&self, width: u32, height: u32) -> Result<(), String> {
        let allowed = 1..=MAX_IMAGE_SIZE_PX;
        if !allowed.contains(&width) || !allowed.contains(&height) {
            return Err(format!("is {width}x{height} pixels large (allowed: 1 to {MAX_IMAGE_SIZE_PX})"));
        }
        let size_bytes = u64::from(width) * u64::from(height) * 4;
        let take = |left: u64| left.checked_sub(size_bytes);
        let taken = self.budget_bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take);
        taken.map(|_| ()).map_err(|_| {
            format!("brings the images of the scene to more than {MAX_IMAGE_BYTES} bytes, the limit")
        })
    }
}
