//! Copies that the graph records itself: uploads and copy passes.

use crate::compile::copy_extent;
use crate::compiled::Compiled;
use crate::context::{Recording, Uploads};
use crate::declaration::{AccessDecl, CopyOp};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::handle::{PassId, ResourceId};
use crate::pool::{Pool, aligned_range};
use crate::subresource::Aspect;

/// Writes uniform blocks and uploads of passes that run into one staging chunk, and copies the uniforms from it. The
/// chunk is free again when `last` has completed, or if there is only one encoder, `encoder`.
pub(super) fn stage_uploads(
    compiled: &Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    last: Option<&wgpu::CommandEncoder>,
) -> Result<(Option<wgpu::Buffer>, Uploads), Error> {
    let (plan, work) = (&compiled.plan, &compiled.frame.work);
    let is_live = |target: ResourceId| plan.placements[target.index()].steps.is_some();
    let staged = plan.decl.copies.iter().filter_map(|copy| match *copy {
        CopyOp::Upload { target, upload } if is_live(target) => Some(upload as usize),
        _ => None,
    });
    let uniforms = aligned_range(0, work.uniforms.len() as u64, 4).end;
    // An empty upload still creates a buffer of the smallest size.
    let upload_bytes =
        |upload: usize| if work.uploads[upload].is_empty() { &[0; 4][..] } else { &work.uploads[upload] };
    let bytes = staged
        .clone()
        .fold(uniforms, |end, upload| aligned_range(end, upload_bytes(upload).len() as u64, 4).end);
    if bytes == 0 {
        return Ok((None, Uploads::default()));
    }
    let mut chunk = pool.staging.begin(device, bytes)?;
    let blocks = match work.uniforms.is_empty() {
        true => None,
        false => Some(pool.uniforms.upload(device, encoder, &mut chunk, &work.uniforms)?),
    };
    let mut offsets = vec![0; work.uploads.len()];
    for upload in staged {
        offsets[upload] = chunk.write(upload_bytes(upload), 4);
    }
    let buffer = Some(chunk.finish(last.unwrap_or(encoder)));
    Ok((blocks, Uploads { buffer, offsets }))
}

/// Records the transfers of a copy pass.
pub(super) fn record_copies(
    recording: &Recording<'_>,
    pass: PassId,
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), Error> {
    let decl = &recording.plan.decl;
    // Uploads declare one access, other copies two: source and target.
    let mut accesses = decl.accesses(pass).iter();
    for copy in decl.copies(pass) {
        let Some(first) = accesses.next() else { break };
        if let CopyOp::Upload { target, upload } = *copy {
            let Some(source) = &recording.uploads.buffer else { continue };
            let (offset, bytes) =
                (recording.uploads.offsets[upload as usize], decl.resource(target).desc.bytes());
            encoder.copy_buffer_to_buffer(source, offset, recording.buffer(target)?, 0, bytes);
            continue;
        }
        let Some(second) = accesses.next() else { break };
        transfer(recording, *copy, (first, second), encoder)?;
    }
    Ok(())
}

fn transfer(
    recording: &Recording<'_>,
    copy: CopyOp,
    (from, to): (&AccessDecl, &AccessDecl),
    encoder: &mut wgpu::CommandEncoder,
) -> Result<(), Error> {
    let decl = &recording.plan.decl;
    match copy {
        CopyOp::Upload { .. } => {}
        CopyOp::BufferToBuffer { source, target } => {
            let all = decl.resource(source).desc.bytes();
            let (start, end) = decl.subresource(from).bytes.unwrap_or((0, all));
            let (to, _) = decl.subresource(to).bytes.unwrap_or((0, all));
            let (source, target) = (recording.buffer(source)?, recording.buffer(target)?);
            encoder.copy_buffer_to_buffer(source, start, target, to, end - start);
        }
        CopyOp::TextureToTexture { source, target } => {
            let (Some(size), Some(_)) = (extent(recording, from), extent(recording, to)) else {
                return Ok(());
            };
            let (source, target) = (recording.texture(source)?, recording.texture(target)?);
            encoder.copy_texture_to_texture(
                copy_location(recording, from, source),
                copy_location(recording, to, target),
                size,
            );
        }
        CopyOp::TextureToBuffer { source, target } => {
            let Some(size) = extent(recording, from) else { return Ok(()) };
            let (source, buffer) = (recording.texture(source)?, recording.buffer(target)?);
            let texel = source.format().block_copy_size(None).unwrap_or(4);
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(
                    (size.width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT),
                ),
                rows_per_image: None,
            };
            let target = wgpu::TexelCopyBufferInfo { buffer, layout };
            encoder.copy_texture_to_buffer(copy_location(recording, from, source), target, size);
        }
    }
    Ok(())
}

fn extent(recording: &Recording<'_>, access: &AccessDecl) -> Option<wgpu::Extent3d> {
    let desc: TextureDesc = match recording.plan.decl.resource(access.resource).desc {
        ResourceDesc::Texture(desc) => desc,
        ResourceDesc::Buffer(_) => return None,
    };
    copy_extent(&recording.plan.decl.subresource(access), &desc)
}

fn copy_location<'t>(
    recording: &Recording<'_>,
    access: &AccessDecl,
    texture: &'t wgpu::Texture,
) -> wgpu::TexelCopyTextureInfo<'t> {
    let part = recording.plan.decl.subresource(access);
    wgpu::TexelCopyTextureInfo {
        texture,
        mip_level: part.mips.map_or(0, |(first, _)| first),
        origin: wgpu::Origin3d {
            x: part.rect.map_or(0, |rect| rect.x),
            y: part.rect.map_or(0, |rect| rect.y),
            z: part.layers.map_or(0, |(first, _)| first),
        },
        aspect: match part.aspect {
            Aspect::All => wgpu::TextureAspect::All,
            Aspect::Depth => wgpu::TextureAspect::DepthOnly,
            Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
        },
    }
}
