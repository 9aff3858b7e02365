//! Comparing bind group entries with those that a pass bound before.

use super::Resources;
use crate::declaration::Origin;
use crate::handle::{Bind, Token};
use crate::pool::EntryKey;

/// Returns the key of an entry; `None` for what may be another object in the next frame, or belongs to the caller, who may
/// drop it.
pub(super) fn entry_key(resources: &Resources<'_>, entry: &Bind<'_>) -> Option<EntryKey> {
    let transient = |token: Token| {
        let decl = &resources.recording.plan.decl;
        let access = decl.accesses.get(token.access as usize)?;
        (decl.resource(access.resource).origin == Origin::Transient).then_some(token.access)
    };
    match entry {
        Bind::Texture(token) | Bind::TextureArray(token) => transient(token.0).map(EntryKey::Access),
        Bind::Buffer(token) => transient(token.0).map(EntryKey::Access),
        Bind::BufferRange(token, range) => Some(EntryKey::AccessRange(transient(token.0)?, range.clone())),
        Bind::Uniform(uniform) => {
            let buffer = resources.recording.uniforms?.clone();
            Some(EntryKey::Uniform(buffer, uniform.start..uniform.start + uniform.size))
        }
        Bind::Sampler(sampler) => Some(EntryKey::Sampler((*sampler).clone())),
        Bind::ExternalView(_) | Bind::ExternalBuffer(_) => None,
    }
}

/// Returns whether an entry binds what the key identifies. A token of another frame or pass never does.
pub(super) fn matches(key: &EntryKey, resources: &Resources<'_>, entry: &Bind<'_>) -> bool {
    let recording = resources.recording;
    let same = |token: &Token, access: u32| token.is_of(recording.frame) && token.access == access;
    match (key, entry) {
        // The layout distinguishes the two kinds of texture entries.
        (&EntryKey::Access(access), Bind::Texture(token) | Bind::TextureArray(token)) => {
            same(&token.0, access)
        }
        (&EntryKey::Access(access), Bind::Buffer(token)) => same(&token.0, access),
        (EntryKey::AccessRange(access, kept), Bind::BufferRange(token, range)) => {
            same(&token.0, *access) && kept == range
        }
        (EntryKey::Uniform(buffer, kept), Bind::Uniform(uniform)) => {
            uniform.frame == recording.frame
                && recording.uniforms == Some(buffer)
                && *kept == (uniform.start..uniform.start + uniform.size)
        }
        (EntryKey::Sampler(kept), Bind::Sampler(sampler)) => kept == *sampler,
        _ => false,
    }
}
