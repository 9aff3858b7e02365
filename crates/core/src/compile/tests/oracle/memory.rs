//! Memory that a frame must have.

use super::super::frames::{Names, Spec};
use super::{Live, Model};
use crate::{Origin, Plan, ResourceDesc, ResourceId, TextureUsages};

/// Resources of the same class can share a slot: its description, and whether it is for storage or transient.
type Class = (ResourceDesc, bool, bool);

/// Returns for each class the bytes of its slots, and the peak of live bytes in the plan's order.
pub(in super::super) fn lower_bounds(model: &Model<'_>, names: &Names, plan: &Plan) -> Vec<(u64, u64)> {
    let live = Live::new(model, plan);
    let slots: Vec<_> = plan.slots().collect();
    let class = |id: ResourceId| -> Option<Class> {
        let planned = plan.resource(id);
        let usage = |flag| planned.texture_usage.contains(flag);
        let desc = slots[planned.slot?.index()].desc;
        Some((desc, usage(TextureUsages::STORAGE_BINDING), usage(TextureUsages::TRANSIENT_ATTACHMENT)))
    };
    let mut classes: Vec<Class> = Vec::new();
    for class in slots.iter().filter_map(|slot| class(slot.resources[0])) {
        if !classes.contains(&class) {
            classes.push(class);
        }
    }
    let assigned = live.assigned(model);
    let steps = live.steps.last().map_or(0, |last| last + 1);
    let bytes = |own: Class| {
        let spans = assigned.iter().filter(|(resource, _)| class(names.id(*resource)) == Some(own));
        let spans: Vec<(usize, usize)> = spans.map(|(_, span)| *span).collect();
        let at_once =
            |step: usize| spans.iter().filter(|(first, last)| (*first..=*last).contains(&step)).count();
        let most = (0..steps).map(at_once).max().unwrap_or(0);
        let count = slots.iter().filter(|slot| class(slot.resources[0]) == Some(own)).count();
        (count as u64 * own.0.bytes(), most as u64 * own.0.bytes())
    };
    classes.iter().map(|&own| bytes(own)).collect()
}

/// Returns the peak of bytes of live transient resources if passes run one by one in this order.
pub(in super::super) fn peak_of(spec: &Spec, order: &[usize]) -> u64 {
    let touches =
        |pass: usize, resource: usize| spec.passes[pass].accesses.iter().any(|a| a.resource == resource);
    let mut used = vec![0; order.len()];
    for (resource, own) in spec.resources.iter().enumerate() {
        let first = order.iter().position(|&pass| touches(pass, resource));
        let last = order.iter().rposition(|&pass| touches(pass, resource));
        if let (Origin::Transient, Some(first), Some(last)) = (own.origin, first, last) {
            let last = if spec.is_exported(resource) { order.len() - 1 } else { last };
            used[first..=last].iter_mut().for_each(|used| *used += own.desc.bytes());
        }
    }
    used.into_iter().max().unwrap_or(0)
}
