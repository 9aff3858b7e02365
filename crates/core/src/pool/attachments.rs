//! The attachments of each step of a plan, with their operations as wgpu takes them.

use super::poison::poison_value;
use crate::access::{Access, ClearValue};
use crate::declaration::{Origin, PassKind};
use crate::desc::ResourceDesc;
use crate::handle::PassId;
use crate::plan::{AttachmentOps, LoadAction, LoadReason, Plan, StoreAction};
use crate::subresource::Aspect;

/// The attachments of all steps. Views belong to accesses, as some change from frame to frame.
pub(crate) struct Attachments {
    colors: Vec<Option<ColorAttachment>>,
    steps: Vec<Step>,
}

struct Step {
    colors: (u32, u32),
    depth: Option<DepthAttachment>,
}

#[derive(Clone)]
pub(crate) struct ColorAttachment {
    /// Index of the access that attaches it.
    pub(crate) access: usize,
    /// Index of the access that it is resolved into.
    pub(crate) resolve: Option<usize>,
    pub(crate) depth_slice: Option<u32>,
    pub(crate) ops: wgpu::Operations<wgpu::Color>,
}

pub(crate) struct DepthAttachment {
    /// Index of the access that attaches it.
    pub(crate) access: usize,
    pub(crate) depth_ops: Option<wgpu::Operations<f32>>,
    pub(crate) stencil_ops: Option<wgpu::Operations<u32>>,
}

impl Attachments {
    pub(super) fn new(plan: &Plan, poison: bool) -> Self {
        let count = plan.steps.len();
        let (mut colors, mut steps) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for &(start, end) in &plan.steps {
            let passes = &plan.order[start as usize..end as usize];
            let ends = (passes[0], passes[passes.len() - 1]);
            let first = colors.len();
            let mut depth = None;
            if plan.decl.pass(ends.0).kind == PassKind::Render {
                add_colors(plan, ends, poison, &mut colors);
                depth = find_depth(plan, ends, poison);
            }
            steps.push(Step { colors: (first as u32, colors.len() as u32), depth });
        }
        Self { colors, steps }
    }

    /// Returns the colour attachments of a step, by number.
    pub(crate) fn colors(&self, step: usize) -> &[Option<ColorAttachment>] {
        let (first, end) = self.steps[step].colors;
        &self.colors[first as usize..end as usize]
    }

    pub(crate) fn depth(&self, step: usize) -> Option<&DepthAttachment> {
        self.steps[step].depth.as_ref()
    }
}

/// Adds the colour attachments of the passes from `first` to `last`, which share a render pass: the first pass loads, the
/// last one stores and resolves.
fn add_colors(
    plan: &Plan,
    (first, last): (PassId, PassId),
    poison: bool,
    colors: &mut Vec<Option<ColorAttachment>>,
) {
    let decl = &plan.decl;
    let start = colors.len();
    let mut ends = decl.access_range(last);
    for index in decl.access_range(first) {
        let access = &decl.accesses[index];
        let (Access::Color(color), Some(begin)) = (access.access, first_ops(plan, index, poison)) else {
            continue;
        };
        let same = |&index: &usize| decl.accesses[index].access == access.access;
        let end = if first == last { None } else { ends.find(same) };
        let end = end.and_then(|index| plan.ops[index]).unwrap_or(begin);
        let is_volume = match decl.resource(access.resource).desc {
            ResourceDesc::Texture(desc) => desc.dimension == wgpu::TextureDimension::D3,
            ResourceDesc::Buffer(_) => false,
        };
        let slice = decl.subresource(access).layers.map_or(0, |(first, _)| first);
        let at = start + color as usize;
        if colors.len() <= at {
            colors.resize(at + 1, None);
        }
        colors[at] = Some(ColorAttachment {
            access: index,
            resolve: None,
            depth_slice: is_volume.then_some(slice),
            ops: operations(&begin, &end, |value| match value {
                ClearValue::Color([r, g, b, a]) => wgpu::Color { r, g, b, a },
                ClearValue::Depth(_) | ClearValue::DepthStencil(..) => wgpu::Color::TRANSPARENT,
            }),
        });
    }
    for index in decl.access_range(last) {
        if let Access::Resolve(color) = decl.accesses[index].access
            && let Some(Some(attachment)) = colors.get_mut(start + color as usize)
        {
            attachment.resolve = Some(index);
        }
    }
}

/// Finds the depth attachment of the passes from `first` to `last`.
fn find_depth(plan: &Plan, (first, last): (PassId, PassId), poison: bool) -> Option<DepthAttachment> {
    let decl = &plan.decl;
    let is_depth = |&index: &usize| matches!(decl.accesses[index].access, Access::Depth | Access::DepthRead);
    let index = decl.access_range(first).find(is_depth)?;
    let access = &decl.accesses[index];
    let begin = first_ops(plan, index, poison);
    let end = decl.access_range(last).find(is_depth).and_then(|index| plan.ops[index]).or(begin);
    let (has_depth, has_stencil) = match decl.resource(access.resource).desc {
        ResourceDesc::Texture(desc) => (desc.format.has_depth_aspect(), desc.format.has_stencil_aspect()),
        ResourceDesc::Buffer(_) => (false, false),
    };
    let aspect = decl.subresource(access).aspect;
    let ops = begin.zip(end);
    let depth_ops = ops.filter(|_| has_depth && aspect != Aspect::Stencil).map(|(begin, end)| {
        operations(&begin, &end, |value| match value {
            ClearValue::Depth(depth) | ClearValue::DepthStencil(depth, _) => depth,
            ClearValue::Color(_) => 0.0,
        })
    });
    let stencil_ops = ops.filter(|_| has_stencil && aspect != Aspect::Depth).map(|(begin, end)| {
        operations(&begin, &end, |value| match value {
            ClearValue::DepthStencil(_, stencil) => stencil,
            ClearValue::Depth(_) | ClearValue::Color(_) => 0,
        })
    });
    Some(DepthAttachment { access: index, depth_ops, stencil_ops })
}

/// Returns the operations of an attachment of the first pass. In poison mode, a clear replaces a load of contents that
/// nothing may rely on.
fn first_ops(plan: &Plan, access: usize, poison: bool) -> Option<AttachmentOps> {
    let mut ops = plan.ops[access]?;
    let resource = plan.decl.resource(plan.decl.accesses[access].resource);
    if poison
        && resource.origin == Origin::Transient
        && matches!(ops.load_reason, LoadReason::Overwritten | LoadReason::RestUnneeded)
        && let ResourceDesc::Texture(desc) = resource.desc
    {
        ops.load = LoadAction::Clear(poison_value(desc.format));
    }
    Some(ops)
}

fn operations<V>(
    begin: &AttachmentOps,
    end: &AttachmentOps,
    clear: impl Fn(ClearValue) -> V,
) -> wgpu::Operations<V> {
    wgpu::Operations {
        load: match begin.load {
            LoadAction::Clear(value) => wgpu::LoadOp::Clear(clear(value)),
            LoadAction::Load | LoadAction::Continue => wgpu::LoadOp::Load,
        },
        store: match end.store {
            StoreAction::Store | StoreAction::Continue => wgpu::StoreOp::Store,
            StoreAction::Discard => wgpu::StoreOp::Discard,
        },
    }
}
