//! Frames in which the order of passes makes a difference to memory.

use super::{AccessSpec, PassSpec, ResourceSpec, Source, Spec, SubresourceSpec};
use crate::{Access, Contents, Format, Origin, PassKind, ResourceDesc, TextureDesc};

/// Creates a frame of this many compute passes. Each fills its own texture, of very different sizes, from a
/// few of those before it. What nothing reads is exported.
pub(in super::super) fn chain_from_bytes(bytes: &[u8], passes: usize) -> Spec {
    let mut source = Source::new(bytes);
    let mut spec = Spec::default();
    let (fan_in, back) = (1 + source.below(3), 1 + source.below(7));
    let mut unread = vec![true; passes];
    for index in 0..passes {
        let (width, height) = (1 << source.below(5), 1 << source.below(4));
        let desc = ResourceDesc::Texture(TextureDesc::d2(width, height, Format::Rgba8Unorm));
        spec.resources.push(ResourceSpec { desc, origin: Origin::Transient, uploaded: false });
        let mut pass = PassSpec::new(PassKind::Compute);
        let access = |resource, access, contents| AccessSpec {
            resource,
            access,
            contents,
            subresource: SubresourceSpec::default(),
        };
        let reads = if index == 0 { 0 } else { source.below(fan_in + 1) };
        for _ in 0..reads {
            let read = index - 1 - source.below(back.min(index));
            unread[read] = false;
            pass.accesses.push(access(read, Access::Sampled, None));
        }
        pass.accesses.push(access(index, Access::StorageWrite, Some(Contents::Overwrite)));
        spec.passes.push(pass);
    }
    let kept = source.chance(128);
    for index in (0..passes).filter(|&index| unread[index]) {
        match kept {
            true => spec.passes[index].keep = true,
            false => spec.exports.push(index),
        }
    }
    spec
}
