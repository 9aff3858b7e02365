//! Lifetimes and usages of resources.

use crate::access::Access;
use crate::declaration::{Declaration, PassKind};
use crate::desc::ResourceDesc;
use crate::handle::PassId;
use crate::subresource::Region;
use wgpu_types::{BufferUsages, TextureUsages};

/// The use of a resource in a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Use {
    /// First and last step that uses it. An export lives until the last step.
    pub(super) steps: Option<(u32, u32)>,
    pub(super) texture_usage: TextureUsages,
    pub(super) buffer_usage: BufferUsages,
    /// Whether render passes draw into it and nothing else uses it. They must draw both aspects if it has two: an unused
    /// aspect would be read-only, which transient attachments cannot be.
    pub(super) only_drawn: bool,
}

/// Returns the use of each resource by passes that run and by exports.
pub(super) fn uses(decl: &Declaration, order: &[PassId], steps: &[(u32, u32)]) -> Vec<Use> {
    let mut uses: Vec<Use> = decl
        .resources
        .iter()
        .map(|resource| Use {
            steps: None,
            texture_usage: resource.texture_usage,
            buffer_usage: resource.buffer_usage,
            only_drawn: true,
        })
        .collect();
    for (index, &(start, end)) in steps.iter().enumerate() {
        for &pass in &order[start as usize..end as usize] {
            let renders = decl.pass(pass).kind == PassKind::Render;
            for access in decl.accesses(pass) {
                let own = &mut uses[access.resource.index()];
                own.steps = Some((own.steps.map_or(index as u32, |(first, _)| first), index as u32));
                match decl.resource(access.resource).desc {
                    ResourceDesc::Texture(_) => own.texture_usage |= access.access.texture_usage(),
                    ResourceDesc::Buffer(_) => own.buffer_usage |= access.access.buffer_usage(),
                }
                let drawn = renders && matches!(access.access, Access::Color(_) | Access::Depth);
                own.only_drawn &=
                    drawn && decl.region(access).is_none_or(|region| region.without_rect() == Region::ALL);
            }
        }
    }
    let end = steps.len().saturating_sub(1) as u32;
    for (own, resource) in uses.iter_mut().zip(&decl.resources) {
        if let (true, Some((_, last))) = (resource.exported.is_some(), &mut own.steps) {
            *last = end;
        }
    }
    uses
}
