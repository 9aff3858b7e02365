//! The data of the page's script: indices, and each sentence once.

use super::snapshot::SnapshotData;
use super::{Drawing, HtmlPage, LivePage, PageTable};
use crate::explain::{describe_origin, usages};
use flate2::Compression;
use serde::Serialize;
use shadowgraph_core::describe::{Positions, shape, verb};
use shadowgraph_core::{
    AccessPlan, Dependency, DependencyKind, NodeId, NodePlan, PassId, PassTime, Plan, ResourceDesc,
    ResourceId, SlotId, SlotPlan, Subresource, TextureUsages,
};

/// Width of the notes of accesses, in columns.
const NOTE: usize = 70;

#[derive(Serialize)]
pub(super) struct FrameData<'p> {
    summary: String,
    notes: &'p [String],
    nodes: Vec<NodePlan<'p>>,
    passes: Vec<PassData<'p>>,
    resources: Vec<ResourceData<'p>>,
    slots: Vec<SlotData<'p>>,
    edges: Vec<EdgeData>,
    tables: &'p [PageTable],
    drawings: &'p [Drawing],
    snapshots: Vec<SnapshotData<'p>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    live: Option<LivePage>,
}

#[derive(Serialize)]
struct PassData<'p> {
    name: &'p str,
    node: Option<NodeId>,
    kind: &'static str,
    keep: bool,
    /// Reason why the pass does not run.
    culled: Option<String>,
    /// Reason why the pass runs.
    live: Option<String>,
    /// What the declaration says about it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<&'p str>,
    place: Option<PlaceData>,
    waits: Vec<String>,
    accesses: Vec<AccessData>,
    time: Option<&'p PassTime>,
}

#[derive(Serialize)]
struct PlaceData {
    order: usize,
    step: usize,
    /// Index among the passes of the step.
    within: usize,
    /// Number of passes of the step.
    of: usize,
    why: String,
    merged: String,
}

#[derive(Serialize)]
struct AccessData {
    resource: ResourceId,
    /// The verb before the resource's name, and the role after it.
    does: &'static str,
    r#as: String,
    #[serde(rename = "part", skip_serializing_if = "Option::is_none")]
    subresource: Option<String>,
    version: u32,
    writes: bool,
    /// Whether the earlier contents are needed.
    keeps: bool,
    covers: bool,
    #[serde(skip_serializing_if = "String::is_empty")]
    note: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    load: Option<(String, String)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    clear: Option<(String, String)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    store: Option<(&'static str, String)>,
}

#[derive(Serialize)]
struct ResourceData<'p> {
    name: &'p str,
    node: Option<NodeId>,
    buffer: bool,
    shape: String,
    bytes: u64,
    origin: &'static str,
    usages: Vec<String>,
    steps: Option<(u32, u32)>,
    slot: Option<SlotId>,
    /// Reason why the resource is in its slot, or in none.
    why: String,
    /// What the declaration says about it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<&'p str>,
}

#[derive(Serialize)]
struct SlotData<'p> {
    shape: String,
    bytes: u64,
    transient: bool,
    resources: &'p [ResourceId],
}

#[derive(Serialize)]
struct EdgeData {
    before: PassId,
    after: PassId,
    resource: Option<ResourceId>,
    kind: DependencyKind,
    /// The dependency as a sentence.
    why: String,
}

impl<'p> FrameData<'p> {
    pub(super) fn new(page: &'p HtmlPage<'p>) -> Self {
        let plan = page.plan;
        let positions = Positions::new(plan);
        let time = |id| page.times.get(positions.get(id)?.order);
        let slot = |slot: SlotPlan<'p>| SlotData {
            shape: shape(&slot.desc),
            bytes: slot.desc.bytes(),
            transient: slot.texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT),
            resources: slot.resources,
        };
        let edge = |d: &Dependency| EdgeData {
            before: d.before,
            after: d.after,
            resource: d.resource,
            kind: d.kind,
            why: plan.explain_dependency(d),
        };
        Self {
            summary: plan.summary(),
            notes: &page.notes,
            nodes: plan.nodes().collect(),
            passes: plan.passes().map(|(id, _)| pass_data(plan, &positions, id, time(id))).collect(),
            resources: plan.resources().map(|(id, _)| resource_data(plan, id)).collect(),
            slots: plan.slots().map(slot).collect(),
            edges: plan.dependencies().iter().map(edge).collect(),
            tables: &page.tables,
            drawings: &page.drawings,
            snapshots: page
                .snapshots
                .iter()
                .map(|snapshot| SnapshotData::new(plan, snapshot, Compression::default()))
                .collect(),
            live: page.live,
        }
    }
}

fn pass_data<'p>(
    plan: &'p Plan,
    positions: &Positions,
    id: PassId,
    time: Option<&'p PassTime>,
) -> PassData<'p> {
    let pass = plan.pass(id);
    let position = positions.get(id);
    // The notes of accesses name the writers.
    let waits = plan.waits_for(id).iter().filter(|d| d.kind != DependencyKind::ReadAfterWrite);
    PassData {
        name: pass.name,
        node: pass.node,
        kind: pass.kind.as_str(),
        keep: pass.keep,
        culled: pass.culled.map(|reason| plan.describe_cull(reason)),
        live: position.map(|_| plan.explain_live(id)),
        notes: plan.pass_notes(id).collect(),
        place: position.map(|position| PlaceData {
            order: position.order,
            step: position.step,
            within: position.within,
            of: position.passes,
            why: plan.order_reason(id).map(|reason| plan.describe_order(reason)).unwrap_or_default(),
            merged: plan.explain_merge(position.order),
        }),
        waits: waits.map(|dependency| plan.explain_dependency(dependency)).collect(),
        accesses: plan.accesses(id).map(|access| access_data(plan, id, &access)).collect(),
        time,
    }
}

fn access_data(plan: &Plan, pass: PassId, access: &AccessPlan) -> AccessData {
    let (does, r#as) = verb(access.access);
    let runs = plan.pass(pass).culled.is_none();
    let ops = access.ops.as_ref();
    AccessData {
        resource: access.resource,
        does,
        r#as,
        subresource: (access.subresource != Subresource::FULL).then(|| access.subresource.to_string()),
        version: access.version,
        writes: access.access.writes(),
        keeps: access.contents.is_none_or(|contents| contents.preserves()),
        covers: access.contents.is_some_and(|contents| !contents.preserves()),
        note: if runs { plan.access_note(pass, access, NOTE) } else { String::new() },
        load: ops.map(|ops| plan.explain_load(access, ops)),
        clear: ops.and_then(|ops| plan.explain_drawn_clear(access, ops)),
        store: ops.map(|ops| plan.explain_store(pass, access, ops)),
    }
}

fn resource_data(plan: &Plan, id: ResourceId) -> ResourceData<'_> {
    let resource = plan.resource(id);
    ResourceData {
        name: resource.name,
        node: resource.node,
        buffer: matches!(resource.desc, ResourceDesc::Buffer(_)),
        shape: shape(&resource.desc),
        bytes: resource.desc.bytes(),
        origin: describe_origin(plan, id),
        usages: usages(plan, id),
        steps: resource.steps,
        slot: resource.slot,
        why: plan.explain_slot(id),
        notes: plan.resource_notes(id).collect(),
    }
}
