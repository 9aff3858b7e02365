//! Usages, and attachments with memory of their own kind.

use super::super::frames::Names;
use super::{Live, Oracle, Rule};
use crate::{
    Access, BufferUsages, LoadAction, Origin, PassKind, Plan, ResourceDesc, StoreAction, TextureUsages,
};
use wgpu_types::TextureDimension;

fn texture_usage(access: Access) -> TextureUsages {
    match access {
        Access::Color(_) | Access::Resolve(_) | Access::Depth | Access::DepthRead => {
            TextureUsages::RENDER_ATTACHMENT
        }
        Access::Sampled => TextureUsages::TEXTURE_BINDING,
        Access::StorageRead | Access::StorageWrite => TextureUsages::STORAGE_BINDING,
        Access::CopySource => TextureUsages::COPY_SRC,
        Access::CopyTarget => TextureUsages::COPY_DST,
        _ => TextureUsages::empty(),
    }
}

fn buffer_usage(access: Access) -> BufferUsages {
    match access {
        Access::StorageRead | Access::StorageWrite => BufferUsages::STORAGE,
        Access::Uniform => BufferUsages::UNIFORM,
        Access::Vertex => BufferUsages::VERTEX,
        Access::Index => BufferUsages::INDEX,
        Access::Indirect => BufferUsages::INDIRECT,
        Access::CopySource => BufferUsages::COPY_SRC,
        Access::CopyTarget => BufferUsages::COPY_DST,
        _ => BufferUsages::empty(),
    }
}

impl Oracle<'_> {
    pub(super) fn usages(&mut self, names: &Names, plan: &Plan, live: &Live) {
        for resource in 0..self.model.spec.resources.len() {
            let (mut texture, mut buffer) = (TextureUsages::empty(), BufferUsages::empty());
            for &pass in &live.order {
                for (_, access, _) in self.model.accesses(pass).filter(|(_, a, _)| a.resource == resource) {
                    texture |= texture_usage(access.access);
                    buffer |= buffer_usage(access.access);
                }
            }
            let origin = self.model.spec.resources[resource].origin;
            let is_texture = matches!(self.model.spec.desc(resource), ResourceDesc::Texture(_));
            if self.model.spec.is_exported(resource) && origin == Origin::Transient {
                texture |= if is_texture { TextureUsages::COPY_SRC } else { TextureUsages::empty() };
                buffer |= if is_texture { BufferUsages::empty() } else { BufferUsages::COPY_SRC };
            }
            let buffer = if is_texture { BufferUsages::empty() } else { buffer };
            let texture = if is_texture { texture } else { TextureUsages::empty() };
            let planned = plan.resource(names.id(resource));
            let own = planned.texture_usage - TextureUsages::TRANSIENT_ATTACHMENT;
            let same = match origin {
                // Imports also have the usages of their owner.
                Origin::Imported { .. } => own.contains(texture) && planned.buffer_usage.contains(buffer),
                _ => (own, planned.buffer_usage) == (texture, buffer),
            };
            self.expect(same, Rule::Usages, || {
                format!("r{resource} needs {texture:?} {buffer:?}, not {own:?} {:?}", planned.buffer_usage)
            });
            let transient = self.may_be_transient(plan, live, resource);
            let is_transient = planned.texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT);
            self.expect(transient == is_transient, Rule::TransientAttachment, || {
                format!("r{resource} may {}be a transient attachment", if transient { "" } else { "not " })
            });
        }
        self.slot_usages(names, plan);
    }

    fn slot_usages(&mut self, names: &Names, plan: &Plan) {
        for (index, slot) in plan.slots().enumerate() {
            let own = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TRANSIENT_ATTACHMENT;
            let alone = !slot.texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT)
                || slot.texture_usage == own;
            self.expect(alone, Rule::TransientAttachment, || {
                format!("slot {index} is {:?}", slot.texture_usage)
            });
            let (mut texture, mut buffer) = (TextureUsages::empty(), BufferUsages::empty());
            for &resource in slot.resources {
                let resource = plan.resource(names.id(names.resource(resource)));
                texture |= resource.texture_usage;
                buffer |= resource.buffer_usage;
            }
            let same = (texture, buffer) == (slot.texture_usage, slot.buffer_usage);
            self.expect(same, Rule::Usages, || format!("slot {index} is not for {texture:?} {buffer:?}"));
        }
    }

    /// Returns whether nothing of the texture is ever in memory: wgpu's rules for transient attachments.
    fn may_be_transient(&self, plan: &Plan, live: &Live, resource: usize) -> bool {
        let spec = self.model.spec;
        let ResourceDesc::Texture(desc) = spec.desc(resource) else { return false };
        let flat = desc.dimension == TextureDimension::D2
            && desc.mip_levels == 1
            && desc.size.depth_or_array_layers == 1;
        let one_step = live.spans[resource].is_some_and(|(first, last)| first == last);
        let transient = spec.resources[resource].origin == Origin::Transient && !spec.is_exported(resource);
        let mut drawn = live.order.iter().all(|&pass| {
            self.model.accesses(pass).filter(|(_, a, _)| a.resource == resource).all(|(_, access, _)| {
                // An unused aspect would be read-only, which is not allowed.
                let all_aspects = self.model.attachment(access) == self.model.whole(resource);
                spec.passes[pass].kind == PassKind::Render && access.drawn() && all_aspects
            })
        });
        for id in plan.order() {
            for access in plan.accesses(*id).zip(&spec.passes[id.index()].accesses) {
                if access.1.resource == resource {
                    drawn &= access
                        .0
                        .ops
                        .is_some_and(|ops| ops.load != LoadAction::Load && ops.store != StoreAction::Store);
                }
            }
        }
        plan.options().transient_attachments && flat && one_step && transient && drawn
    }
}
