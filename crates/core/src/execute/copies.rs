//! What the graph copies itself: uploads and copy passes.

use super::context::Frozen;
use crate::declaration::CopyOp;
use crate::error::Error;
use crate::plan::Plan;
use std::borrow::Cow;
use wgpu::util::DeviceExt as _;

/// All uploads of the frame in one buffer, copied from there in the order of the plan. Going through the encoder
/// rather than the queue keeps several recorded frames apart before any is submitted.
pub(super) struct Staging {
    buffer: Option<wgpu::Buffer>,
    offsets: Vec<u64>,
}

impl Staging {
    pub(super) fn new(device: &wgpu::Device, plan: &Plan, uploads: &[Cow<'_, [u8]>]) -> Self {
        let mut bytes =
            Vec::with_capacity(uploads.iter().map(|upload| upload.len().next_multiple_of(4)).sum());
        let mut offsets = vec![0; uploads.len()];
        let copies = plan.live_passes().flat_map(|pass| plan.pass(pass).copies.iter());
        for copy in copies {
            if let CopyOp::Upload { target, upload } = *copy {
                let upload = upload as usize;
                offsets[upload] = bytes.len() as u64;
                bytes.extend_from_slice(&uploads[upload]);
                let end = offsets[upload] + plan.resource(target).desc.bytes();
                bytes.resize(end as usize, 0);
            }
        }
        let buffer = (!bytes.is_empty()).then(|| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("frame uploads"),
                contents: &bytes,
                usage: wgpu::BufferUsages::COPY_SRC,
            })
        });
        Self { buffer, offsets }
    }
}

/// Records one transfer.
pub(super) fn copy(
    frozen: Frozen<'_>,
    staging: &Staging,
    encoder: &mut wgpu::CommandEncoder,
    copy: &CopyOp,
) -> Result<(), Error> {
    match *copy {
        CopyOp::Upload { target, upload } => {
            let (Some(source), target) = (&staging.buffer, frozen.buffer(target)?) else {
                return Ok(());
            };
            let offset = staging.offsets[upload as usize];
            encoder.copy_buffer_to_buffer(source, offset, target, 0, target.size());
        }
        CopyOp::BufferToBuffer { source, target } => {
            let (source, target) = (frozen.buffer(source)?, frozen.buffer(target)?);
            encoder.copy_buffer_to_buffer(source, 0, target, 0, source.size());
        }
        CopyOp::TextureToTexture { source, target } => {
            let (source, target) = (frozen.texture(source)?, frozen.texture(target)?);
            encoder.copy_texture_to_texture(source.as_image_copy(), target.as_image_copy(), source.size());
        }
        CopyOp::TextureToBuffer { source, target } => {
            let (source, buffer) = (frozen.texture(source)?, frozen.buffer(target)?);
            let texel = source.format().block_copy_size(None).unwrap_or(4);
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some((source.width() * texel).next_multiple_of(256)),
                rows_per_image: None,
            };
            let target = wgpu::TexelCopyBufferInfo { buffer, layout };
            encoder.copy_texture_to_buffer(source.as_image_copy(), target, source.size());
        }
    }
    Ok(())
}
