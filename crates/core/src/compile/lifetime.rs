//! How long each resource lives, and what it must be usable for.

use crate::declaration::Declaration;
use crate::handle::PassId;
use crate::plan::Step;
use wgpu_types::{BufferUsages, TextureUsages};

/// First and last step that touches a resource.
pub(super) type Lifetime = Option<(u32, u32)>;

/// Returns each resource's lifetime in steps. An exported resource that is touched lives to the last step.
pub(super) fn lifetimes(decl: &Declaration, steps: &[Step]) -> Vec<Lifetime> {
    let mut lifetimes: Vec<Lifetime> = vec![None; decl.resources.len()];
    for (index, step) in steps.iter().enumerate() {
        let index = index as u32;
        for access in step.passes.iter().flat_map(|&pass| &decl.pass(pass).accesses) {
            let lifetime = &mut lifetimes[access.resource.index()];
            *lifetime = Some((lifetime.map_or(index, |(first, _)| first), index));
        }
    }
    let end = steps.len().saturating_sub(1) as u32;
    for (lifetime, resource) in lifetimes.iter_mut().zip(&decl.resources) {
        if let (true, Some((_, last))) = (resource.exported.is_some(), lifetime) {
            *last = end;
        }
    }
    lifetimes
}

/// Returns each resource's usages: what the passes that run need, and what was asked for from outside.
pub(super) fn usages(decl: &Declaration, order: &[PassId]) -> Vec<(TextureUsages, BufferUsages)> {
    let mut usages: Vec<_> = decl.resources.iter().map(|r| (r.texture_usage, r.buffer_usage)).collect();
    for access in order.iter().flat_map(|&pass| &decl.pass(pass).accesses) {
        let (texture, buffer) = &mut usages[access.resource.index()];
        *texture |= access.access.texture_usage();
        *buffer |= access.access.buffer_usage();
    }
    usages
}
