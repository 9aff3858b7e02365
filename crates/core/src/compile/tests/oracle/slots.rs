//! Slots: who lives in them when, and whether they fit.

use super::super::frames::Names;
use super::{Live, Oracle, Rule};
use crate::{Plan, ResourceDesc};

impl Oracle<'_> {
    pub(super) fn slots(&mut self, names: &Names, plan: &Plan, live: &Live) {
        let assigned = live.assigned(&self.model);
        for resource in 0..self.model.spec.resources.len() {
            let planned = plan.resource(names.id(resource));
            let span = live.spans[resource].map(|(first, last)| (first as u32, last as u32));
            self.expect(planned.steps == span, Rule::Slots, || {
                format!("r{resource} is said to live in {:?}, not {span:?}", planned.steps)
            });
            let lives = assigned.iter().any(|&(other, _)| other == resource);
            self.expect(planned.slot.is_some() == lives, Rule::Slots, || {
                format!("r{resource} is in {:?}", planned.slot)
            });
        }
        for (index, slot) in plan.slots().enumerate() {
            let mut resources: Vec<usize> = slot.resources.iter().map(|&id| names.resource(id)).collect();
            let listed = assigned.iter().filter(|(resource, _)| {
                plan.resource(names.id(*resource)).slot.is_some_and(|slot| slot.index() == index)
            });
            let mut expected: Vec<usize> = listed.map(|(resource, _)| *resource).collect();
            let spans: Vec<_> = resources.iter().filter_map(|&resource| live.spans[resource]).collect();
            let apart = spans.windows(2).all(|pair| pair[0].1 < pair[1].0);
            self.expect(apart, Rule::Slots, || {
                format!("the resources {resources:?} of slot {index} live in {spans:?}")
            });
            resources.iter().for_each(|&resource| self.fits(resource, index, &slot.desc));
            resources.sort_unstable();
            expected.sort_unstable();
            self.expect(resources == expected && !resources.is_empty(), Rule::Slots, || {
                format!("slot {index} lists {resources:?}, and {expected:?} are in it")
            });
        }
    }

    fn fits(&mut self, resource: usize, slot: usize, desc: &ResourceDesc) {
        let own = self.model.spec.desc(resource);
        let exact = self.model.spec.is_exported(resource);
        let fits = match (own, desc) {
            (ResourceDesc::Texture(own), ResourceDesc::Texture(desc)) => own == desc,
            (ResourceDesc::Buffer(own), ResourceDesc::Buffer(desc)) => {
                own.bytes == desc.bytes || !exact && own.bytes < desc.bytes
            }
            _ => false,
        };
        self.expect(fits, Rule::Slots, || format!("r{resource} does not fit slot {slot}, which is {desc:?}"));
    }
}
